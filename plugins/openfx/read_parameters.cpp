// SPDX-License-Identifier: Apache-2.0
#include "openfx/read_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"

namespace contrejour::openfx {
namespace {

using Numbers = std::array<double, 3>;

// Reads the values at one time.
class Reader {
 public:
  Reader(const Instance& instance, Time time) : instance_(instance), suite_(*instance.host().parameters), time_(time) {}

  // A value that the host cannot give is at its default.
  [[nodiscard]] Numbers numbers(std::size_t k) const {
    const ParamSpec& spec = instance_.specs()[k];
    Numbers values{};
    std::ranges::copy(spec.fallback, values.begin());
    const ParamHandle param = instance_.handle(k);
    if (param == nullptr) return values;
    Numbers read = values;
    int whole = 0;
    Status got = status::kFailed;
    switch (spec.type) {
      case ParamType::Real: got = suite_.get_value_at_time(param, time_, &read[0]); break;
      case ParamType::Position: got = suite_.get_value_at_time(param, time_, &read[0], &read[1]); break;
      case ParamType::Colour: got = suite_.get_value_at_time(param, time_, &read[0], &read[1], &read[2]); break;
      case ParamType::Integer:
      case ParamType::Boolean:
      case ParamType::Choice:
        got = suite_.get_value_at_time(param, time_, &whole);
        read[0] = whole;
        break;
      default: break;
    }
    return got == status::kOk && std::ranges::all_of(read, [](double v) { return std::isfinite(v); }) ? read : values;
  }

  [[nodiscard]] std::string text(std::size_t k) const {
    char* value = nullptr;
    const ParamHandle param = instance_.handle(k);
    if (param == nullptr || suite_.get_value_at_time(param, time_, &value) != status::kOk || value == nullptr)
      return instance_.specs()[k].text;
    return value;
  }

  [[nodiscard]] bool is_animated(std::size_t k) const {
    unsigned int keys = 0;
    const ParamHandle param = instance_.handle(k);
    return param != nullptr && suite_.get_num_keys(param, &keys) == status::kOk && keys > 0;
  }

  // The plug-in's own parameters, by name.
  [[nodiscard]] Numbers numbers(std::string_view name) const {
    const auto k = instance_.find(name);
    return k ? numbers(*k) : Numbers{};
  }
  [[nodiscard]] std::string text(std::string_view name) const {
    const auto k = instance_.find(name);
    return k ? text(*k) : std::string();
  }
  // The index of a choice that has `count` entries.
  [[nodiscard]] int index(std::string_view name, int count) const {
    return std::clamp(static_cast<int>(numbers(name)[0]), 0, count - 1);
  }
  [[nodiscard]] bool is_on(std::string_view name) const { return numbers(name)[0] != 0.0; }

 private:
  const Instance& instance_;
  const ParameterSuite& suite_;
  Time time_;
};

// Some hosts keep single precision.
bool is_default(double value, double fallback) { return std::abs(value - fallback) <= 1e-6 * std::abs(fallback); }

// The text of a row's number, or nothing where it stands for the default.
std::optional<std::string> number_text(const ParamSpec& spec, double value, bool is_animated) {
  const params::Parameter& row = *spec.row;
  const double fallback = spec.fallback[0];
  if (row.fallback.empty() ? value <= fallback : !is_animated && is_default(value, fallback)) return std::nullopt;
  value = std::clamp(value, row.minimum, row.maximum);
  return spec.type == ParamType::Integer ? fmt::format("{:.0f}", value) : fmt::format("{}", value);
}

// An index beyond the menu, as of a project of a later release, counts as the default.
std::optional<std::string> choice_text(const ParamSpec& spec, double value, bool is_animated) {
  const std::size_t index = static_cast<std::size_t>(std::max(0.0, value));
  const bool is_fallback = value == spec.fallback[0];
  if (index >= spec.choices.size() || (is_fallback && (spec.first_choice_is_automatic || !is_animated)))
    return std::nullopt;
  return spec.choices[index];
}

std::vector<std::string> texts_of(const Reader& reader, const ParamSpec& spec, std::size_t k) {
  std::optional<std::string> text;
  const bool is_animated = reader.is_animated(k);
  switch (spec.type) {
    case ParamType::Real:
    case ParamType::Integer: text = number_text(spec, reader.numbers(k)[0], is_animated); break;
    case ParamType::Choice: text = choice_text(spec, reader.numbers(k)[0], is_animated); break;
    case ParamType::Boolean: {
      const double value = reader.numbers(k)[0];
      if (value != spec.fallback[0] || is_animated) text = value != 0.0 ? "on" : "off";
      break;
    }
    default: {
      std::string given = reader.text(k);
      if (!given.empty() && (given != spec.text || is_animated)) text = std::move(given);
    }
  }
  std::vector<std::string> texts;
  if (!text) return texts;
  if (!spec.row->repeats) return {std::move(*text)};
  for (std::string_view part : params::split(*text, ';')) {
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    if (!part.empty()) texts.emplace_back(part);
  }
  return texts;
}

// A light as `--light-at` writes it: u and v from the upper left corner.
std::string light_text(const Reader& reader, int light) {
  const Numbers at = reader.numbers(own::light_position(light));
  std::string text = fmt::format("{},{}", at[0], 1.0 - at[1]);
  const double value = reader.numbers(own::light_value(light))[0];
  const Numbers colour = reader.numbers(own::light_colour(light));
  const bool is_white = colour == Numbers{1.0, 1.0, 1.0};
  if (value > 0.0 || !is_white) text += ':';
  if (value > 0.0) text += fmt::format("{}", value);
  if (!is_white)
    text += fmt::format(":{},{},{}", std::max(0.0, colour[0]), std::max(0.0, colour[1]), std::max(0.0, colour[2]));
  return text;
}

void read_own(const Reader& reader, ReadParameters& read) {
  const std::vector<std::string> looks = look_menu(), lenses = lens_menu();
  const auto entry = [&](std::string_view name, const std::vector<std::string>& menu) {
    const int index = reader.index(name, static_cast<int>(menu.size()) + 1);
    return index == 0 ? std::string() : menu[static_cast<std::size_t>(index - 1)];
  };
  read.look = reader.text(own::kLookFile);
  if (read.look.empty()) read.look = entry(own::kLook, looks);
  read.lens = reader.text(own::kLensFile);
  if (read.lens.empty()) read.lens = entry(own::kLens, lenses);
  read.lights_file = reader.text(own::kLightsFile);
  read.output = static_cast<OutputPicture>(reader.index(own::kOutput, 3));
  read.alpha = static_cast<OutputAlpha>(reader.index(own::kAlpha, 3));
  read.transfer = static_cast<TransferCurve>(reader.index(own::kTransfer, static_cast<int>(transfer_menu().size())));
  read.frame = static_cast<SensorFrame>(reader.index(own::kFrame, 2));
  read.drafts_while_interacting = reader.is_on(own::kDraft);
  for (int light = 1; light <= own::kLights; ++light)
    if (reader.is_on(own::light_on(light))) read.lights.emplace_back("light-at", light_text(reader, light));
}

}  // namespace

bool ReadParameters::is_without_lights() const { return lights.empty() && lights_file.empty() && !own.is_on("detect"); }

Result<ReadParameters> read_parameters(const Instance& instance, Time time) {
  const Reader reader(instance, time);
  ReadParameters read;
  read_own(reader, read);
  const std::vector<ParamSpec>& specs = instance.specs();
  for (std::size_t k = 0; k < specs.size(); ++k) {
    const ParamSpec& spec = specs[k];
    if (spec.row == nullptr) continue;
    const bool is_light = spec.row->name == "light" || spec.row->name == "light-at";
    for (std::string& text : texts_of(reader, spec, k)) {
      if (is_light) {
        read.lights.emplace_back(spec.row->name, std::move(text));
      } else if (auto set = read.own.set(spec.row->name, std::move(text)); !set) {
        return invalid_argument(fmt::format("{}: {}", spec.label, set.error().message));
      }
    }
  }
  return read;
}

std::array<double, 3> read_numbers(const Instance& instance, std::string_view name, Time time) {
  return Reader(instance, time).numbers(name);
}

}  // namespace contrejour::openfx
