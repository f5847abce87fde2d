// SPDX-License-Identifier: Apache-2.0
// Rows of the library's table as parameters of a host.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "openfx/parameter_list.h"

namespace contrejour::openfx {
namespace {

using params::Kind;
using params::Parameter;

// Names in scripts are identifiers. The former name of a row that was renamed since stays, so that projects keep their
// values.
std::string script_name(const Parameter& row) {
  std::string script(row.former.empty() ? row.name : row.former);
  std::ranges::replace(script, '-', '_');
  return script;
}

std::string label_of(const Parameter& row) {
  std::string label(row.name);
  std::ranges::replace(label, '-', ' ');
  label.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(label.front())));
  const bool is_number = row.kind == Kind::Real || row.kind == Kind::Integer;
  return is_number && !row.unit.empty() && row.unit != "N" ? fmt::format("{} ({})", label, row.unit) : label;
}

ParamType type_of(const Parameter& row) {
  switch (row.kind) {
    case Kind::Real: return ParamType::Real;
    case Kind::Integer: return ParamType::Integer;
    case Kind::Switch: return ParamType::Boolean;
    case Kind::Choice: return ParamType::Choice;
    case Kind::Text: break;
  }
  return row.unit == "FILE" ? ParamType::File : ParamType::Text;
}

// How far from zero a slider goes where the range itself goes much farther.
double slider_reach(const Parameter& row, double fallback) {
  if (row.unit == "deg") return 180.0;
  if (row.unit == "mm") return 500.0;
  if (row.kind == Kind::Integer) return std::max(100.0, 10.0 * fallback);
  return std::max(row.fallback.empty() ? 32.0 : 10.0, 10.0 * std::abs(fallback));
}

// A number without a default in the table is derived from the lens or the picture; 0 stands for that, or a number
// below the range if 0 is in it.
void set_number(const Parameter& row, ParamSpec& spec) {
  constexpr double kLargest = 1e15;
  spec.minimum = std::max(row.minimum, -kLargest);
  spec.maximum = std::min(row.maximum, row.kind == Kind::Integer ? 2147483647.0 : kLargest);
  double fallback = 0.0;
  if (row.fallback.empty()) {
    fallback = spec.minimum > 0.0 ? 0.0 : spec.minimum - 1.0;
    spec.minimum = fallback;
    spec.hint += fmt::format("; {:g}: that default", fallback);
  } else {
    fallback = *params::parse_real(row.fallback);
  }
  const double reach = slider_reach(row, fallback);
  spec.fallback = {fallback};
  spec.display_minimum = std::max(spec.minimum, -reach);
  spec.display_maximum = std::max(std::min(spec.maximum, reach), fallback);
  if (spec.display_maximum <= spec.display_minimum) spec.display_maximum = spec.maximum;
}

void set_choices(const Parameter& row, ParamSpec& spec) {
  spec.first_choice_is_automatic = row.fallback.empty();
  if (spec.first_choice_is_automatic) spec.choices.emplace_back("automatic");
  spec.choices.insert(spec.choices.end(), row.choices.begin(), row.choices.end());
  const auto found = std::ranges::find(row.choices, row.fallback);
  spec.fallback = {found == row.choices.end() ? 0.0 : static_cast<double>(found - row.choices.begin())};
}

}  // namespace

bool belongs_to_plugin(const Parameter& row) {
  constexpr std::array<std::string_view, 4> kWithoutUse = {"size", "pixel-aspect", "exposure", "wavelength"};
  return std::ranges::find(kWithoutUse, row.name) == kWithoutUse.end();
}

ParamSpec spec_of_row(const Parameter& row) {
  ParamSpec spec;
  spec.name = script_name(row);
  spec.label = label_of(row);
  spec.hint = row.help;
  spec.type = type_of(row);
  spec.row = &row;
  switch (row.kind) {
    case Kind::Real:
    case Kind::Integer: set_number(row, spec); break;
    case Kind::Switch: spec.fallback = {row.fallback == "on" ? 1.0 : 0.0}; break;
    case Kind::Choice: set_choices(row, spec); break;
    case Kind::Text:
      spec.text = row.fallback;
      spec.hint += fmt::format(" ({})", row.unit);
      if (row.repeats) spec.hint += "; several are separated by semicolons";
      break;
  }
  return spec;
}

}  // namespace contrejour::openfx
