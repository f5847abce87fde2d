// SPDX-License-Identifier: Apache-2.0
// The parts of the table of parameters (parameter.h), by what they set. all_parameters() joins them in this order.
// Thread-safety: constant data.
#pragma once

#include <span>
#include <string_view>

#include "contrejour/expert/parameter.h"

namespace contrejour::params {

[[nodiscard]] std::span<const Parameter> lens_parameters();
[[nodiscard]] std::span<const Parameter> dirt_parameters();
[[nodiscard]] std::span<const Parameter> coating_parameters();
[[nodiscard]] std::span<const Parameter> sensor_parameters();
[[nodiscard]] std::span<const Parameter> light_parameters();
[[nodiscard]] std::span<const Parameter> frame_parameters();
[[nodiscard]] std::span<const Parameter> ghost_parameters();
[[nodiscard]] std::span<const Parameter> method_parameters();
[[nodiscard]] std::span<const Parameter> effect_parameters();
[[nodiscard]] std::span<const Parameter> detection_parameters();

inline constexpr double kMaxGain = 1e12;
inline constexpr double kMaxSeed = 1e9;

// Uses a parser as the check of a parameter: discards its value.
template <auto parse>
Result<void> parses(std::string_view text) {
  const auto value = parse(text);
  if (!value) return tl::unexpected(value.error());
  return {};
}

}  // namespace contrejour::params
