// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/forbes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "contrejour/expert/surface_shape.h"

namespace contrejour::inline internal {
namespace {

// Computes Q_m from the P_m, which have a simple recurrence: P_m = f_m Q_m + g_(m-1) Q_(m-1) + h_(m-2) Q_(m-2) (Forbes
// 2010, A.14 to A.16).
double sum_of_bfs(const std::vector<double>& a, double x) {
  double sum = 0.0;
  double p_before = 0.0, p = 2.0;              // P_(m-1), P_m
  double q_before_that = 0.0, q_before = 0.0;  // Q_(m-2), Q_(m-1)
  double f_before_that = 0.0, f_before = 0.0, g_before = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const auto m = static_cast<double>(k);
    double f = 2.0, g = 0.0, h = 0.0;
    if (k == 1) {
      f = std::sqrt(19.0) / 2.0;
      g = -0.5;
    } else if (k > 1) {
      h = -m * (m - 1.0) / (2.0 * f_before_that);
      g = -(1.0 + g_before * h) / f_before;
      f = std::sqrt(m * (m + 1.0) + 3.0 - g * g - h * h);
    }
    const double q = (p - g * q_before - h * q_before_that) / f;
    sum += a[k] * q;
    const double p_next = k == 0 ? 6.0 - 8.0 * x : (2.0 - 4.0 * x) * p - p_before;
    p_before = p;
    p = p_next;
    q_before_that = q_before;
    q_before = q;
    f_before_that = f_before;
    f_before = f;
    g_before = g;
  }
  return sum;
}

// Jacobi's polynomials P_m^(0, 4)(2 x - 1) by their three-term recurrence (Abramowitz and Stegun 22.7.1).
double sum_of_con(const std::vector<double>& a, double x) {
  constexpr double kBeta = 4.0;
  const double y = 2.0 * x - 1.0;
  double before = 0.0, here = 1.0, sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += a[k] * here;
    const auto n = static_cast<double>(k);
    double next = 1.0 + (kBeta + 2.0) * (y - 1.0) / 2.0;
    if (k > 0) {
      const double s = 2.0 * n + kBeta;
      next = ((s + 1.0) * ((s + 2.0) * s * y - kBeta * kBeta) * here - 2.0 * n * (n + kBeta) * (s + 2.0) * before) /
             (2.0 * (n + 1.0) * (n + kBeta + 1.0) * s);
    }
    before = here;
    here = next;
  }
  return sum;
}

}  // namespace

double forbes_sum(const ForbesAsphere& asphere, double x) {
  return asphere.kind == ForbesKind::Bfs ? sum_of_bfs(asphere.coefficients, x) : sum_of_con(asphere.coefficients, x);
}

double forbes_departure(double curvature, double conic, const ForbesAsphere& asphere, double r) {
  const double x = r * r / (asphere.norm_radius * asphere.norm_radius);
  const double sum = forbes_sum(asphere, x);
  if (asphere.kind == ForbesKind::Con) return x * x * sum;
  const double squared = curvature * curvature * r * r;
  const double cos_normal = std::sqrt((1.0 - (1.0 + conic) * squared) / (1.0 - conic * squared));
  return x * (1.0 - x) / cos_normal * sum;
}

// Interpolates the departure over t, with t = (r / reach)^2, by Chebyshev polynomials through their nodes; the factor t
// makes it vanish on the axis. The polynomials are then expanded in powers by T_(j + 1) = 2 (2 t - 1) T_j - T_(j - 1).
std::optional<ForbesPowers> powers_of_forbes(double curvature, double conic, const ForbesAsphere& asphere,
                                             double reach) {
  constexpr std::size_t kTerms = SurfaceShape::kHighestPower / 2, kProbes = 200;
  const auto departure = [&](double t) { return forbes_departure(curvature, conic, asphere, reach * std::sqrt(t)); };
  const auto angle = [](std::size_t k) { return std::numbers::pi * (static_cast<double>(k) + 0.5) / kTerms; };
  using Terms = std::array<double, kTerms>;  // of 1, t, t^2, ...
  std::array<double, kTerms> at_node{};
  for (std::size_t k = 0; k < kTerms; ++k) {
    const double t = 0.5 + 0.5 * std::cos(angle(k));
    at_node[k] = departure(t) / t;
  }
  Terms found{}, before{}, here{1.0};
  for (std::size_t j = 0; j < kTerms; ++j) {
    double coefficient = 0.0;
    for (std::size_t k = 0; k < kTerms; ++k)
      coefficient += at_node[k] * std::cos(static_cast<double>(j) * angle(k)) * (j == 0 ? 1.0 : 2.0) / kTerms;
    Terms next{};
    for (std::size_t p = 0; p < kTerms; ++p) {
      found[p] += coefficient * here[p];
      next[p] = (j == 0 ? -1.0 : -2.0) * here[p] - before[p];
      if (p > 0) next[p] += (j == 0 ? 2.0 : 4.0) * here[p - 1];
    }
    before = here;
    here = next;
  }
  ForbesPowers out;
  for (std::size_t k = 0; k <= kProbes; ++k) {
    const double t = static_cast<double>(k) / kProbes;
    double sum = 0.0;
    for (std::size_t p = kTerms; p-- > 0;) sum = sum * t + found[p];
    const double off = std::abs(sum * t - departure(t));
    if (!std::isfinite(off)) return std::nullopt;
    out.off = std::max(out.off, off);
  }
  for (std::size_t p = 0; p < kTerms; ++p) {
    out.powers.push_back(0.0);
    out.powers.push_back(found[p] * std::pow(reach, -2.0 * static_cast<double>(p + 1)));
  }
  return out;
}

}  // namespace contrejour::inline internal
