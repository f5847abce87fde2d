// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>

#include <doctest/doctest.h>

#include "render/ray_maps/lobatto.h"
#include "support/approx.h"

using namespace contrejour::ray_maps;

namespace {

constexpr int kCounts[] = {2, 5, 9, 17};

std::vector<float> row_times(const std::vector<float>& row, const Matrix& m) {
  std::vector<float> out(static_cast<std::size_t>(m.stride));
  multiply(row.data(), 1, m.rows, m.rows, m, out.data());
  return out;
}

std::vector<double> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  std::vector<double> points(count);
  for (double& p : points) p = coordinate(random);
  return points;
}

std::vector<float> random_values(std::size_t count, unsigned seed) {
  const auto points = random_points(count, seed);
  return {points.begin(), points.end()};
}

}  // namespace

TEST_CASE("Lobatto points rise from -1 to 1, symmetric, closest at the ends") {
  for (const int count : kCounts) {
    const auto points = lobatto_points(count);
    REQUIRE(points.size() == static_cast<std::size_t>(count));
    CHECK(points.front() == -1.0);
    CHECK(points.back() == 1.0);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      CHECK(points[k] < points[k + 1]);
      CHECK(points[k] == test::approx(-points[points.size() - 1 - k]));
      // The extremes of the Chebyshev polynomial of degree count - 1.
      CHECK(std::abs(std::cos((count - 1) * std::acos(points[k]))) == test::approx(1.0));
    }
  }
}

// Powers of x up to the highest degree that the nodes represent, and one beyond, which they must not represent.
TEST_CASE("polynomials of degree nodes - 1, and their derivatives, are met exactly") {
  auto at = random_points(37, 3);
  for (const double node : lobatto_points(9)) at.push_back(node);  // on nodes the formula has a separate case
  for (const int count : kCounts) {
    const auto nodes = lobatto_points(count);
    const Matrix value = interpolation_matrix(count, at);
    const Matrix slope = derivative_matrix(count, at);
    CHECK(value.rows == count);
    CHECK(value.columns == static_cast<int>(at.size()));
    for (int degree = 0; degree <= count; ++degree) {
      std::vector<float> row;
      for (const double node : nodes) row.push_back(static_cast<float>(std::pow(node, degree)));
      const auto values = row_times(row, value);
      const auto slopes = row_times(row, slope);
      double value_off = 0.0;
      double slope_off = 0.0;
      for (std::size_t k = 0; k < at.size(); ++k) {
        value_off = std::max(value_off, std::abs(values[k] - std::pow(at[k], degree)));
        slope_off =
            std::max(slope_off, std::abs(slopes[k] - (degree == 0 ? 0.0 : degree * std::pow(at[k], degree - 1))));
      }
      if (degree < count) {
        CHECK(value_off < 2e-6);
        CHECK(slope_off < 1e-6 * count * count);  // derivatives amplify rounding by the square of the count
      } else {
        CHECK(value_off > 1e-6);
      }
    }
  }
}

TEST_CASE("coefficients are those of Chebyshev polynomials") {
  for (const int count : kCounts) {
    const auto nodes = lobatto_points(count);
    const Matrix to_coefficients = coefficient_matrix(count);
    for (int degree = 0; degree < count; ++degree) {
      std::vector<float> row;
      for (const double x : nodes) row.push_back(static_cast<float>(std::cos(degree * std::acos(x))));
      const auto c = row_times(row, to_coefficients);
      for (int k = 0; k < count; ++k) {
        CHECK(c[static_cast<std::size_t>(k)] == test::approx(k == degree ? 1.0 : 0.0).epsilon(1e-6).scale(1.0));
      }
    }
  }
}

TEST_CASE("products of matrices as by plain loops, padding zero") {
  for (const int inner : kCounts) {
    for (const int columns : {2, 9, 16, 17, 33}) {
      Matrix b(inner, columns);
      const auto numbers = random_values(static_cast<std::size_t>(inner * columns), 11);
      for (int r = 0; r < inner; ++r) {
        for (int c = 0; c < columns; ++c) b.at(r, c) = numbers[static_cast<std::size_t>(r * columns + c)];
      }
      CHECK(b.stride >= columns);

      constexpr int kRows = 5;
      const int a_stride = inner + 3;
      const auto a = random_values(static_cast<std::size_t>(kRows * a_stride), 5);
      std::vector<float> out(static_cast<std::size_t>(kRows * b.stride), 7.0F);
      multiply(a.data(), kRows, a_stride, inner, b, out.data());
      Matrix t(inner, kRows);
      for (int r = 0; r < inner; ++r) {
        for (int c = 0; c < kRows; ++c) t.at(r, c) = a[static_cast<std::size_t>(c * a_stride + r)];
      }
      std::vector<float> transposed(out.size(), 7.0F);
      multiply_transposed(t, b.values.data(), b.stride, transposed.data());
      for (int r = 0; r < kRows; ++r) {
        for (int c = 0; c < b.stride; ++c) {
          double sum = 0.0;
          for (int k = 0; k < inner && c < columns; ++k) sum += static_cast<double>(t.at(k, r)) * b.at(k, c);
          const auto at = static_cast<std::size_t>(r * b.stride + c);
          CHECK(out[at] == test::approx(sum).epsilon(2e-6).scale(1.0));
          CHECK(transposed[at] == test::approx(sum).epsilon(2e-6).scale(1.0));
        }
      }
    }
  }
}
