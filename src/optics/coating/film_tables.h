// SPDX-License-Identifier: Apache-2.0
// Sampled indices of film materials.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace contrejour::inline internal {

inline constexpr double kFilmTableFirst_nm = 360.0;
inline constexpr double kFilmTableStep_nm = 10.0;

struct FilmTable {
  static constexpr std::size_t kSamples = 48;  // to 830 nm
  std::string_view name, source;
  std::array<double, kSamples> n{}, k{};
};

[[nodiscard]] std::span<const FilmTable> film_tables();

}  // namespace contrejour::inline internal
