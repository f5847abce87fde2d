// SPDX-License-Identifier: Apache-2.0
// The light inside a ghost as a function of the place in it: rings and a bright core as caustics make them, and a side
// that is brighter than the other. walch2018 has one level inside instead.
// A point of a ghost has the coordinates x / half axis (of its side) and y / half height: (rho, phi) in polar form.
// Levels are straight between kProfileRings rings of rho from 0 to 1, and on each ring a + b cos(phi) + c cos(2 phi):
// ghosts are symmetric about the axis. At the centre, which has no direction, only a counts.
// Units: as in ghost_outline.h. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstddef>

#include "contrejour/expert/ghost_outline.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"

namespace contrejour {

inline constexpr std::size_t kProfileRings = 9, kProfileHarmonics = 3;
// First all rings of the harmonic 0, from the centre outwards; then those of 1 and of 2, but for the centre.
inline constexpr std::size_t kProfileTerms = kProfileRings + (kProfileHarmonics - 1) * (kProfileRings - 1);

// The harmonic of a term, and its ring.
struct ProfileTerm {
  std::size_t harmonic = 0, ring = 0;
};
[[nodiscard]] constexpr ProfileTerm profile_term(std::size_t k) {
  if (k < kProfileRings) return {0, k};
  return {1 + (k - kProfileRings) / (kProfileRings - 1), 1 + (k - kProfileRings) % (kProfileRings - 1)};
}
[[nodiscard]] constexpr std::size_t profile_index(ProfileTerm term) {
  return term.harmonic == 0 ? term.ring : kProfileRings + (term.harmonic - 1) * (kProfileRings - 1) + term.ring - 1;
}

// A term's mean over the whole ghost: of a ring its share of the area, of cosines 0.
[[nodiscard]] constexpr double profile_mean(std::size_t k) {
  constexpr double spacing = 1.0 / (kProfileRings - 1), half = spacing * spacing / 3.0;
  if (k == 0) return half;
  if (k >= kProfileRings) return 0.0;
  return k + 1 < kProfileRings ? 2.0 * spacing * spacing * static_cast<double>(k) : spacing - half;
}

// The terms that are not 0 at a point, with their values; of the two rings about it, each harmonic.
struct ProfileWeights {
  std::array<std::size_t, 2 * kProfileHarmonics> term{};
  std::array<double, 2 * kProfileHarmonics> value{};  // 0 where a ring has no such term
  // Derivatives of the values with respect to x / half axis and y / half height.
  std::array<Vec2, 2 * kProfileHarmonics> by_place{};
};

// A point in the outline's coordinates. Beyond the last ring, the level is that of the last ring.
[[nodiscard]] CONTREJOUR_API ProfileWeights profile_weights(const GhostOutline& outline, Vec2 point);

}  // namespace contrejour
