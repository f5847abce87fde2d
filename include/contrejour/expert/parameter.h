// SPDX-License-Identifier: Apache-2.0
// The table of all parameters that a user can set: name, unit, range, default, help. The command line and every other
// front end are generated from it, so a parameter means the same everywhere. Values are text, as parameter_text.h reads
// it, in the unit that the table names; parameter_values.h holds the values that a user has set.
// Errors: InvalidArgument, saying what would be valid. Thread-safety: constant data and pure functions.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour::params {

enum class Kind {
  Real,  // a finite number
  Integer,
  Choice,  // one of `choices`
  Switch,  // on or off
  Text,  // anything that `check` accepts
};

struct Parameter {
  std::string_view name{};  // "fnumber": the command line's --fnumber
  std::string_view former{};  // an earlier name, which command lines and presets may still use; empty: none
  char letter = '\0';  // its short form, if any
  std::string_view group{};  // heading in a list of parameters
  Kind kind = Kind::Text;
  std::string_view unit{};  // "mm", "deg", "px", ... or how a text is written: "WxH"
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  std::string_view fallback{};  // default as text; empty: derived from the lens or the picture, as `help` says
  std::string_view help{};
  std::vector<std::string_view> choices{};
  bool repeats = false;  // may be given several times
  bool scene = false;  // describes one picture, as lights and size do; a preset has all other parameters
  Result<void> (*check)(std::string_view text) = nullptr;  // in addition to kind and range
};

[[nodiscard]] CONTREJOUR_API std::span<const Parameter> all_parameters();

// The parameter of this name; it must exist.
[[nodiscard]] CONTREJOUR_API const Parameter& parameter(std::string_view name);

// Checks that a text is a value of the parameter. Errors: InvalidArgument, saying what would be valid.
[[nodiscard]] CONTREJOUR_API Result<void> check_value(const Parameter& parameter, std::string_view text);

}  // namespace contrejour::params
