// SPDX-License-Identifier: Apache-2.0
// The basis of ghosts without axial symmetry: products of Chebyshev polynomials in both coordinates of the pupil point
// and of the light's direction. docs/physics/polynomial.md, "Ghosts without axial symmetry".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "contrejour/expert/polynomial.h"

namespace contrejour::inline internal::polynomial {

inline constexpr int kMaxAsymmetricDegree = 13;  // in all four coordinates together

// The parities of a function in (p_x, s_x) and in (p_y, s_y).
enum class Parity : std::uint8_t { Any, Even, Odd };
struct Parities {
  Parity x = Parity::Any, y = Parity::Any;
  friend bool operator==(const Parities&, const Parities&) = default;
};
// The parities of a zone's outputs: of vectors' x, of their y, and of all scalars.
[[nodiscard]] Parities parities_of_x(const AsymmetricZone& zone);
[[nodiscard]] Parities parities_of_y(const AsymmetricZone& zone);
[[nodiscard]] Parities parities_of_scalar(const AsymmetricZone& zone);

[[nodiscard]] constexpr bool has_parity(Parity parity, int degree) {
  return parity == Parity::Any || (degree % 2 != 0) == (parity == Parity::Odd);
}

// Calls visit(px, py, sx, sy) for the degrees of each term, in the order of the coefficients.
template <class Visit>
constexpr void for_each_asymmetric_term(int degree, const Parities& parities, const Visit& visit) {
  for (int px = 0; px <= degree; ++px)
    for (int py = 0; py <= degree - px; ++py)
      for (int sx = 0; sx <= degree - px - py; ++sx) {
        if (!has_parity(parities.x, px + sx)) continue;
        for (int sy = 0; sy <= degree - px - py - sx; ++sy)
          if (has_parity(parities.y, py + sy)) visit(px, py, sx, sy);
      }
}
[[nodiscard]] int asymmetric_term_count(int degree, const Parities& parities);

// A ray's coordinates in a zone: all in [-1, 1] within it.
struct AsymmetricPoint {
  Vec2 p, s;
};
[[nodiscard]] Vec2 field_point(const AsymmetricZone& zone, Vec2 tangents);
[[nodiscard]] Vec2 tangents_at(const AsymmetricZone& zone, Vec2 s);
// The centre of the pupil coordinates, mm.
[[nodiscard]] Vec2 centre_at(const AsymmetricZone& zone, Vec2 s);
[[nodiscard]] AsymmetricPoint asymmetric_point(const AsymmetricZone& zone, Vec2 tangents, Vec2 entrance_mm);

// All terms at a point, as many as asymmetric_term_count().
void asymmetric_term_values(int degree, const Parities& parities, const AsymmetricPoint& point, std::span<double> out);

[[nodiscard]] double value_of(const ChebyshevSum& sum, const Parities& parities, const AsymmetricPoint& point,
                              double wavelength);

// The centre's terms: T_i(s_x) T_j(s_y) by i, then j, i + j <= 3.
inline constexpr int kCentreDegree = 3;
[[nodiscard]] std::array<double, 10> centre_terms(Vec2 s);

// Bounds at any direction of a zone: those of the directions of its grid around it, about the centre of pupil
// coordinates; without light where none of these has any.
[[nodiscard]] AsymmetricBounds bounds_between(const AsymmetricZone& zone, Vec2 tangents);

}  // namespace contrejour::inline internal::polynomial
