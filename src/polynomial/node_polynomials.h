// SPDX-License-Identifier: Apache-2.0
// Least squares of a zone's outputs: one polynomial for each node, all by the same rows.
#pragma once

#include <cstddef>
#include <functional>
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

// The least squares of a zone's rays for scalars, or for both coordinates of vectors, whose degree grows as it is
// asked for. Unknowns are ordered by degree, those of A before those of B.
class GrowingSystem {
 public:
  // points: of all rays. All must outlive it.
  GrowingSystem(const FitRays& rays, const WeightedRays& weighted, std::span<const ZonePoint> points, bool of_vectors);

  // The coefficients for right-hand sides, in the order of ChebyshevSum; for vectors those of A, then those of B.
  [[nodiscard]] std::vector<std::vector<double>> solve(int degree, GrowingLeastSquares::Right& right);
  // value(ray, coordinate) for each right-hand side.
  using RightValue = std::function<double(std::size_t ray, std::size_t coordinate)>;
  [[nodiscard]] GrowingLeastSquares::Right right(std::span<const RightValue> values) const;
  [[nodiscard]] const FitRays& rays() const { return rays_; }

 private:
  void grow();

  const FitRays& rays_;
  const WeightedRays& weighted_;
  std::span<const ZonePoint> points_;
  std::size_t coordinates_;
  GrowingLeastSquares squares_;
  int degree_ = -1;
};

// The systems of some of a zone's rays.
class Systems {
 public:
  Systems(const FitRays& rays, const WeightedRays& weighted, std::span<const ZonePoint> points)
      : weighted_(weighted), scalars_(rays, weighted, points, false), vectors_(rays, weighted, points, true) {}

  [[nodiscard]] bool has_enough_rays(int degree) const;
  [[nodiscard]] GrowingSystem& scalars() { return scalars_; }
  [[nodiscard]] GrowingSystem& vectors() { return vectors_; }

 private:
  const WeightedRays& weighted_;
  GrowingSystem scalars_, vectors_;
};

// An output of a ray, or one coordinate of it.
using ValueOf = std::function<double(const RayTable& table, std::size_t ray)>;

// A polynomial for each node.
using NodeSums = std::vector<ChebyshevSum>;
using NodeVectors = std::vector<ChebyshevVector>;

// Polynomials of one output, of any degree. A degree that is above those asked for before takes only what is new.
class OutputFit {
 public:
  // step: of the wavelengths. coordinates: one of a scalar, two of a vector. negligible: changes of values by which
  // last wavelength terms are left out.
  OutputFit(GrowingSystem& system, int step, const std::vector<ValueOf>& coordinates, double negligible);

  [[nodiscard]] NodeSums sums(int degree);
  [[nodiscard]] NodeVectors vectors(int degree);

 private:
  template <class Add>
  void for_each_node(int degree, const Add& add);

  GrowingSystem& system_;
  double negligible_;
  GrowingLeastSquares::Right right_;
};

}  // namespace contrejour::inline internal::polynomial
