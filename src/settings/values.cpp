// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/parameter_values.h"

#include <utility>

#include "contrejour/expert/parameter_text.h"

namespace contrejour::params {

Result<void> Values::set(std::string_view name, std::string text) {
  const Parameter& p = parameter(name);
  if (auto checked = check_value(p, text); !checked) return checked;
  auto& texts = texts_[std::string(name)];
  if (!p.repeats) texts.clear();
  texts.push_back(std::move(text));
  return {};
}

Values Values::over(const Values& base) const {
  Values both = *this;
  both.texts_.insert(base.texts_.begin(), base.texts_.end());
  return both;
}

bool Values::given(std::string_view name) const { return texts_.find(name) != texts_.end(); }

std::optional<std::string> Values::text(std::string_view name) const {
  const auto found = texts_.find(name);
  if (found != texts_.end()) return found->second.back();
  const std::string_view fallback = parameter(name).fallback;
  if (fallback.empty()) return std::nullopt;
  return std::string(fallback);
}

std::optional<double> Values::real(std::string_view name) const {
  const auto value = text(name);
  if (!value) return std::nullopt;
  return *parse_real(*value);
}

std::vector<std::string> Values::list(std::string_view name) const {
  const auto found = texts_.find(name);
  return found != texts_.end() ? found->second : std::vector<std::string>{};
}

}  // namespace contrejour::params
