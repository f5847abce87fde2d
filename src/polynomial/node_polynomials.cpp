// SPDX-License-Identifier: Apache-2.0
#include "polynomial/node_polynomials.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal::polynomial {
namespace {

// Chebyshev coefficients of the polynomial through values at Lobatto points.
std::vector<double> coefficients_of(std::span<const double> values) {
  const auto last = static_cast<int>(values.size()) - 1;
  std::vector<double> out(values.size(), 0.0);
  for (int l = 0; l <= last; ++l) {
    double sum = 0.0;
    for (int j = 0; j <= last; ++j) {
      const double end = j == 0 || j == last ? 0.5 : 1.0;
      sum += end * values[static_cast<std::size_t>(j)] * std::cos(std::numbers::pi * l * j / last);
    }
    out[static_cast<std::size_t>(l)] = (l == 0 || l == last ? 1.0 : 2.0) / last * sum;
  }
  return out;
}

}  // namespace

ChebyshevSum assembled(int degree, std::size_t count, std::span<const std::vector<double>> solutions, std::size_t from,
                       double negligible) {
  std::vector<std::vector<double>> by_term;
  std::vector<double> values(solutions.size());
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t l = 0; l < solutions.size(); ++l) values[l] = solutions[l][from + t];
    by_term.push_back(coefficients_of(values));
  }
  std::size_t kept = solutions.size();
  for (double dropped = 0.0; kept > 1; --kept) {
    for (const auto& coefficients : by_term) dropped += std::abs(coefficients[kept - 1]);
    if (dropped > negligible) break;
  }
  ChebyshevSum sum{degree, static_cast<int>(kept), 1.0F, {}};
  double largest = 0.0;
  for (const auto& coefficients : by_term)
    for (const double c : coefficients) largest = std::max(largest, std::abs(c));
  if (!std::isfinite(largest)) return {};
  // The rounding of several hundred coefficients stays far below what is negligible, and float holds all multiples.
  const double step = std::exp2(std::floor(std::log2(std::max(negligible / 64.0, largest * 0x1p-23))));
  sum.step = static_cast<float>(step);
  for (std::size_t l = 0; l < kept; ++l)
    for (const auto& coefficients : by_term)
      sum.coefficients.push_back(static_cast<float>(step * std::round(coefficients[l] / step)));
  return sum;
}

bool Systems::has_enough_rays(int degree) const {
  return static_cast<double>(weighted_.used.size()) >= kSamplesPerUnknown * term_count(degree);
}

const LeastSquares& Systems::made(Made& all, int degree, bool of_vectors) {
  auto& one = all[static_cast<std::size_t>(degree)];
  if (!one) one.emplace(matrix(degree, of_vectors), kRidge);
  return *one;
}

Rows weighted_rows(int degree, bool of_vectors, std::span<const ZonePoint> points, std::span<const double> weights) {
  const auto count = static_cast<std::size_t>(term_count(degree));
  Rows rows;
  rows.columns = of_vectors ? 2 * count : count;
  rows.values.reserve(points.size() * rows.columns * (of_vectors ? 2 : 1));
  std::vector<double> terms(count);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ZonePoint& point = points[k];
    term_values(degree, point, terms);
    const auto add = [&](double factor) {
      for (const double term : terms) rows.values.push_back(weights[k] * factor * term);
    };
    if (!of_vectors) {
      add(1.0);
      continue;
    }
    add(point.h), add(point.p.x);
    add(0.0), add(point.p.y);
  }
  return rows;
}

Rows Systems::matrix(int degree, bool of_vectors) const {
  std::vector<ZonePoint> points;
  for (const std::size_t ray : weighted_.used) points.push_back(rays_.points[ray]);
  return weighted_rows(degree, of_vectors, points, weighted_.weight);
}

NodeSums fitted_sums(Systems& systems, int degree, int step, const ValueOf& value, double negligible) {
  const auto& [used, weight] = systems.weighted();
  const LeastSquares& system = systems.scalars(degree);
  const auto count = static_cast<std::size_t>(term_count(degree));
  NodeSums sums;
  std::vector<double> right(used.size());
  for (const NodeRays& node : systems.rays().nodes) {
    std::vector<std::vector<double>> solutions;
    for (std::size_t l = 0; l < node.tables.size(); l += static_cast<std::size_t>(step)) {
      for (std::size_t k = 0; k < right.size(); ++k) right[k] = weight[k] * value(node.tables[l], used[k]);
      solutions.push_back(system.solve(right));
    }
    sums.push_back(assembled(degree, count, solutions, 0, negligible));
  }
  return sums;
}

NodeVectors fitted_vectors(Systems& systems, int degree, const ValueOf& x, const ValueOf& y, double negligible) {
  const auto& [used, weight] = systems.weighted();
  const LeastSquares& system = systems.vectors(degree);
  const auto count = static_cast<std::size_t>(term_count(degree));
  NodeVectors vectors;
  std::vector<double> right(2 * used.size());
  for (const NodeRays& node : systems.rays().nodes) {
    std::vector<std::vector<double>> solutions;
    for (std::size_t l = 0; l < node.tables.size(); l += kWavelengthStep) {
      for (std::size_t k = 0; k < used.size(); ++k) {
        right[2 * k] = weight[k] * x(node.tables[l], used[k]);
        right[2 * k + 1] = weight[k] * y(node.tables[l], used[k]);
      }
      solutions.push_back(system.solve(right));
    }
    vectors.push_back(
        {assembled(degree, count, solutions, 0, negligible), assembled(degree, count, solutions, count, negligible)});
  }
  return vectors;
}

}  // namespace contrejour::inline internal::polynomial
