// SPDX-License-Identifier: Apache-2.0
// Fractions and multiples of a cell's budget by which cells and meshes are chosen.
#pragma once

namespace contrejour::inline internal::adaptive {

inline constexpr double kStraight = 0.05;  // fraction of a cell's budget below which straight sides are good enough
// A finer mesh is made where cells of 2 x 2 exceed this multiple of their budget: halving a cell reduces the deviation
// of a curve from its chord to a fourth, and the squared error to a sixteenth.
inline constexpr double kGainOfHalving = 16.0;
inline constexpr int kMaxMeshDepth = 7;  // the most times that a patch may be quartered

}  // namespace contrejour::inline internal::adaptive
