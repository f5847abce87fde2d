// SPDX-License-Identifier: Apache-2.0
// The values that a user has set, as text by parameter name, checked against the table (parameter.h); defaults fill the
// rest. Every name must be one of the table's (asserted); settings.h converts the values to the library's types.
// Errors: InvalidArgument from set() alone. Thread-safety: a plain value.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/parameter.h"
#include "contrejour/export.h"

namespace contrejour::params {

class CONTREJOUR_API Values {
 public:
  // Sets a value, or adds one to a parameter that repeats. Errors: those of check_value.
  [[nodiscard]] Result<void> set(std::string_view name, std::string text);

  // These values; `base` fills in missing ones.
  [[nodiscard]] Values over(const Values& base) const;

  [[nodiscard]] bool given(std::string_view name) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view name) const;  // given, or the default
  [[nodiscard]] std::optional<double> real(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> list(std::string_view name) const;
  [[nodiscard]] bool is_on(std::string_view name) const { return text(name) == "on"; }  // for switches

  // For parameters that have a default in the table.
  [[nodiscard]] double number(std::string_view name) const { return real(name).value(); }
  [[nodiscard]] int integer(std::string_view name) const { return static_cast<int>(number(name)); }

 private:
  std::map<std::string, std::vector<std::string>, std::less<>> texts_;
};

}  // namespace contrejour::params
