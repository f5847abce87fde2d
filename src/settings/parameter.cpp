// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/parameter.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/parameter_text.h"
#include "settings/added_parameters.h"
#include "settings/parameter_tables.h"

namespace contrejour::params {
namespace {

std::string range_of(const Parameter& p) {
  const std::string unit = p.unit.empty() ? "" : fmt::format(" {}", p.unit);
  if (std::isinf(p.maximum)) return fmt::format("at least {}{}", p.minimum, unit);
  return fmt::format("from {} to {}{}", p.minimum, p.maximum, unit);
}

Result<void> check_range(const Parameter& p, double value, std::string_view text) {
  if (value >= p.minimum && value <= p.maximum) return {};
  return invalid_argument(fmt::format("{} is out of range; give a number {}", text, range_of(p)));
}

Result<void> check_kind(const Parameter& p, std::string_view text) {
  switch (p.kind) {
    case Kind::Real: {
      const auto value = parse_real(text);
      return value ? check_range(p, *value, text) : tl::unexpected(value.error());
    }
    case Kind::Integer: {
      const auto value = parse_integer(text);
      return value ? check_range(p, *value, text) : tl::unexpected(value.error());
    }
    case Kind::Choice:
      if (std::find(p.choices.begin(), p.choices.end(), text) != p.choices.end()) return {};
      return invalid_argument(fmt::format("\"{}\" is not a choice; give one of {}", text, fmt::join(p.choices, ", ")));
    case Kind::Switch:
      if (text == "on" || text == "off") return {};
      return invalid_argument(fmt::format("\"{}\" is not a state of a switch; give on or off", text));
    case Kind::Text: return {};
  }
  return {};
}

std::vector<Parameter> joined_tables() {
  std::vector<Parameter> all;
  for (const auto& part : {lens_parameters(), dirt_parameters(), coating_parameters(), sensor_parameters(),
                           light_parameters(), frame_parameters(), ghost_parameters(), method_parameters(),
                           effect_parameters(), detection_parameters(), added_parameters()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

std::span<const Parameter> all_parameters() {
  static const std::vector<Parameter> kAll = joined_tables();
  return kAll;
}

const Parameter& parameter(std::string_view name) {
  const auto all = all_parameters();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; });
  assert(found != all.end());
  return *found;
}

Result<void> check_value(const Parameter& p, std::string_view text) {
  if (auto ok = check_kind(p, text); !ok) return ok;
  return p.check != nullptr ? p.check(text) : Result<void>();
}

}  // namespace contrejour::params
