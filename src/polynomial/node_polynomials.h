// SPDX-License-Identifier: Apache-2.0
// Least squares of a zone's outputs: one polynomial for each node, all by the same rows.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "polynomial/fit_rays.h"
#include "polynomial/least_squares.h"

namespace contrejour::inline internal::polynomial {

// Every third wavelength suffices for positions, which vary less than transmittances.
inline constexpr int kWavelengthStep = 3;

inline constexpr double kSamplesPerUnknown = 2.0;
// Rays do not cover the basis' whole cube, |v| <= h |p|, so that at high orders some sums of terms are nearly 0 at all
// of them. Without a ridge their coefficients grow until float cannot hold the differences.
inline constexpr double kRidge = 1e-7;

// Coefficients by wavelength terms from solutions at Lobatto wavelengths, `count` terms of them from one on, without
// the last wavelength terms that together change no value by more than `negligible`.
[[nodiscard]] ChebyshevSum assembled(int degree, std::size_t count, std::span<const std::vector<double>> solutions,
                                     std::size_t from, double negligible);

// Rows of the basis at points, times their weights: one a point for scalars, two for the coordinates of h A + p B.
[[nodiscard]] Rows weighted_rows(int degree, bool of_vectors, std::span<const ZonePoint> points,
                                 std::span<const double> weights);

// The systems of a zone's rays: for scalars, or for both coordinates of vectors.
class Systems {
 public:
  Systems(const FitRays& rays, const WeightedRays& weighted) : rays_(rays), weighted_(weighted) {}

  [[nodiscard]] bool has_enough_rays(int degree) const;
  [[nodiscard]] const LeastSquares& scalars(int degree) { return made(scalars_, degree, false); }
  [[nodiscard]] const LeastSquares& vectors(int degree) { return made(vectors_, degree, true); }
  [[nodiscard]] const FitRays& rays() const { return rays_; }
  [[nodiscard]] const WeightedRays& weighted() const { return weighted_; }

 private:
  using Made = std::array<std::optional<LeastSquares>, kMaxDegree + 1>;

  const LeastSquares& made(Made& all, int degree, bool of_vectors);
  [[nodiscard]] Rows matrix(int degree, bool of_vectors) const;

  const FitRays& rays_;
  const WeightedRays& weighted_;
  Made scalars_, vectors_;
};

using ValueOf = std::function<double(const RayTable& table, std::size_t ray)>;

// A polynomial for each node.
using NodeSums = std::vector<ChebyshevSum>;
using NodeVectors = std::vector<ChebyshevVector>;

// step: of the wavelengths. negligible: changes of values by which last wavelength terms are left out.
[[nodiscard]] NodeSums fitted_sums(Systems& systems, int degree, int step, const ValueOf& value, double negligible);
[[nodiscard]] NodeVectors fitted_vectors(Systems& systems, int degree, const ValueOf& x, const ValueOf& y,
                                         double negligible);

}  // namespace contrejour::inline internal::polynomial
