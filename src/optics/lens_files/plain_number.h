// SPDX-License-Identifier: Apache-2.0
// Numbers in other programs' lens files.
#pragma once

#include <limits>
#include <optional>
#include <string_view>

namespace contrejour::inline internal {

// Upper limit of numbers in lens files; a surface with a larger radius is a plane.
inline constexpr double kLargestNumber = 1e9;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Reads the whole cell as a number of at most kLargestNumber in size; a leading '+' and Fortran's exponents (1.5D-3)
// are allowed, -0 is 0. None for infinities, NaN and other text.
[[nodiscard]] std::optional<double> plain_number(std::string_view cell);

// The same, with infinity for its names (INFINITY, inf, 1e99) and for larger numbers, as files write distances to
// objects.
[[nodiscard]] std::optional<double> number_or_infinity(std::string_view cell);

// 1 / radius; 0 for a radius of 0 (which several formats write for a plane), for infinity and for radii beyond
// kLargestNumber.
[[nodiscard]] double curvature_of_radius(double radius_mm);

// The curvature, or 0 for a surface flatter than that limit.
[[nodiscard]] double tidy_curvature(double curvature_per_mm);

}  // namespace contrejour::inline internal
