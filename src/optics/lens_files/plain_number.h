// Numbers as other programs' lens files write them.
#pragma once

#include <optional>
#include <string_view>

namespace contrejour {

// No lens's number is larger, and no surface flatter: beyond it, one is a plane.
inline constexpr double kLargestNumber = 1e9;

// The whole cell as a number of at most kLargestNumber's size; a leading '+' and Fortran's exponents (1.5D-3) are read,
// -0 is 0. None for infinities, NaN and all else.
[[nodiscard]] std::optional<double> plain_number(std::string_view cell);

// The same; infinity for its names (INFINITY, inf, 1e99) and for all that is larger, as distances to objects are
// written.
[[nodiscard]] std::optional<double> number_or_infinity(std::string_view cell);

// 1 / radius; 0 for a radius of 0 (how several formats write a plane), infinity and all that is flatter than lenses
// are.
[[nodiscard]] double curvature_of_radius(double radius_mm);

// The same number, or 0 for what is flatter than lenses are.
[[nodiscard]] double tidy_curvature(double curvature_per_mm);

}  // namespace contrejour
