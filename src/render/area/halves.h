// Rows of pixels, three floats each, as rows of pixels half as large, by vectors: averages of a polynomial of degree 4
// stay averages of it (Donoho 1993, average interpolation).
#pragma once

#include <array>
#include <cstddef>

namespace contrejour::area {

inline constexpr std::size_t kHalvesStencil = 2;  // pixels beside its own that a pixel's halves are found from

// Of a row and those kHalvesStencil above and below it, from the top down.
using RowsAround = std::array<const float*, 2 * kHalvesStencil + 1>;

// The two rows of half the height that the middle one covers, of `count` floats.
void halve_down(const RowsAround& rows, std::size_t count, float* upper, float* lower);

// A row of `count` floats as one of twice as many pixels of half the width; those of its outermost kHalvesStencil
// pixels mean nothing.
void halve_across(const float* row, std::size_t count, float* fine);

}  // namespace contrejour::area
