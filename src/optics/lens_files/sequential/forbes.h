// SPDX-License-Identifier: Apache-2.0
// Converts Forbes' aspheres to conics with even polynomials, which can be traced.
// Source: Forbes 2007, Shape specification for axially symmetric optical surfaces, Optics Express 15, 5218: Qbfs, whose
// slopes are orthogonal, and Qcon, whose sags are; recurrences of Qbfs as in Forbes 2010, Optics Express 18, 19700.
// Lengths in the file's unit. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace contrejour::inline internal {

enum class ForbesKind : std::uint8_t { Bfs, Con };

struct ForbesAsphere {
  ForbesKind kind = ForbesKind::Bfs;
  double norm_radius = 1.0;
  std::vector<double> coefficients;  // of Q_0, Q_1, ...

  static constexpr std::size_t kMaxTerms = 30;
};

// At x = u^2, u the distance from the axis over the norm radius: the sum of the coefficients times Q_m(x).
[[nodiscard]] double forbes_sum(const ForbesAsphere& asphere, double x);

// The surface's sag beyond its conic. For Qcon it is u^4 times the sum. For Qbfs u^2 (1 - u^2) times the sum is
// measured along the normal of the sphere (Forbes), or of any conic (Zemax' files).
[[nodiscard]] double forbes_departure(double curvature, double conic, const ForbesAsphere& asphere, double r);

// The departure as coefficients of r, r^2, ... r^20 within `reach` of the axis.
struct ForbesPowers {
  std::vector<double> powers;
  double off = 0.0;  // at most
};
// None where the conic ends before.
[[nodiscard]] std::optional<ForbesPowers> powers_of_forbes(double curvature, double conic, const ForbesAsphere& asphere,
                                                           double reach);

}  // namespace contrejour::inline internal
