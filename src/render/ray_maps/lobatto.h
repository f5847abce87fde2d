// SPDX-License-Identifier: Apache-2.0
// Polynomials through values at Chebyshev-Lobatto points, as matrices. Trefethen, Approximation Theory and
// Approximation Practice, ch. 2 to 6. Accuracy: about ten times float's rounding for the sizes used here.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace contrejour::inline internal::ray_maps {

// Row-major; rows start at multiples of `stride`, padded with zeros.
struct Matrix {
  int rows = 0;
  int columns = 0;
  int stride = 0;
  std::vector<float> values;

  Matrix() = default;
  Matrix(int r, int c);
  [[nodiscard]] float& at(int r, int c) {
    return values[static_cast<std::size_t>(r) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(c)];
  }
  [[nodiscard]] float at(int r, int c) const {
    return values[static_cast<std::size_t>(r) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(c)];
  }
  [[nodiscard]] const float* row(int r) const {
    return values.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(stride);
  }
};

// The points, rising from -1 to 1. count: 2 to kMaxLobattoPoints.
constexpr int kMaxLobattoPoints = 64;
[[nodiscard]] const std::vector<double>& lobatto_points(int count);

// Both `points.size()` columns by `count` rows: values at the nodes, as a row vector, times the matrix give the
// polynomial, or its derivative, at the points.
[[nodiscard]] Matrix interpolation_matrix(int count, std::span<const double> points);
[[nodiscard]] Matrix derivative_matrix(int count, std::span<const double> points);

// `count` by `count`: values at the nodes, as a row vector, times the matrix give Chebyshev coefficients.
[[nodiscard]] Matrix coefficient_matrix(int count);

// out = a * b, rows of `out` as long as b's stride. out must not overlap.
void multiply(const float* a, int a_rows, int a_stride, int inner, const Matrix& b, float* out);
// out = transpose(a) * b, for `b` with rows of b_stride floats; out has a.columns rows of b_stride.
void multiply_transposed(const Matrix& a, const float* b, int b_stride, float* out);

// Computes, for a field over a square of nodes, up to kMaxPatchNodes a side, rows by rising y: transpose(along_y) *
// field * along_x, as many rows and columns. out may be the field.
constexpr int kMaxPatchNodes = 17;
void transform(const float* field, int nodes, const Matrix& along_x, const Matrix& along_y, float* out);

// The sum of the absolute values of such a field's Chebyshev coefficients of highest degree in either direction: an
// estimate of the polynomial's error between the nodes.
[[nodiscard]] double highest_terms(const float* field, int nodes);

}  // namespace contrejour::inline internal::ray_maps
