// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/lobatto.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/ray_maps/lobatto.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::ray_maps::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;

// Rows and columns of a left factor: element (row, k) at row * by_row + k * by_k.
struct Factors {
  const float* at;
  std::size_t by_row, by_k;
};

// One column of vectors of four rows of the product: four independent sums, since each addition waits for the preceding
// one of its sum.
HWY_INLINE void combine_four(const Factors& a, std::size_t inner, const float* b, std::size_t b_stride, float* out) {
  const Tag d;
  auto s0 = hn::Zero(d);
  auto s1 = hn::Zero(d);
  auto s2 = hn::Zero(d);
  auto s3 = hn::Zero(d);
  for (std::size_t k = 0; k < inner; ++k) {
    const float* factor = a.at + k * a.by_k;
    const auto row = hn::LoadU(d, b + k * b_stride);
    s0 = hn::MulAdd(hn::Set(d, factor[0]), row, s0);
    s1 = hn::MulAdd(hn::Set(d, factor[a.by_row]), row, s1);
    s2 = hn::MulAdd(hn::Set(d, factor[2 * a.by_row]), row, s2);
    s3 = hn::MulAdd(hn::Set(d, factor[3 * a.by_row]), row, s3);
  }
  hn::StoreU(s0, d, out);
  hn::StoreU(s1, d, out + b_stride);
  hn::StoreU(s2, d, out + 2 * b_stride);
  hn::StoreU(s3, d, out + 3 * b_stride);
}

HWY_INLINE void combine_one(const Factors& a, std::size_t inner, const float* b, std::size_t b_stride, float* out) {
  const Tag d;
  auto sum = hn::Zero(d);
  for (std::size_t k = 0; k < inner; ++k)
    sum = hn::MulAdd(hn::Set(d, a.at[k * a.by_k]), hn::LoadU(d, b + k * b_stride), sum);
  hn::StoreU(sum, d, out);
}

void multiply_rows(const float* a, std::size_t a_rows, std::size_t a_row_step, std::size_t a_step, std::size_t inner,
                   const float* b, std::size_t b_stride, float* out) {
  const std::size_t lanes = hn::Lanes(Tag());
  std::size_t r = 0;
  for (; r + 4 <= a_rows; r += 4) {
    const Factors rows{a + r * a_row_step, a_row_step, a_step};
    for (std::size_t c = 0; c < b_stride; c += lanes)
      combine_four(rows, inner, b + c, b_stride, out + r * b_stride + c);
  }
  for (; r < a_rows; ++r) {
    const Factors row{a + r * a_row_step, a_row_step, a_step};
    for (std::size_t c = 0; c < b_stride; c += lanes) combine_one(row, inner, b + c, b_stride, out + r * b_stride + c);
  }
}

}  // namespace contrejour::inline internal::ray_maps::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal::ray_maps {
namespace {

HWY_EXPORT(multiply_rows);

constexpr int kPadding = 16;  // floats: the widest vector

// Barycentric weights of the Lobatto points: alternating, halved at the ends.
double weight(int k, int count) { return (k % 2 == 0 ? 1.0 : -1.0) * (k == 0 || k == count - 1 ? 0.5 : 1.0); }

// The Lagrange polynomials of the nodes at x.
std::vector<double> lagrange(const std::vector<double>& nodes, double x) {
  const int count = static_cast<int>(nodes.size());
  std::vector<double> values(nodes.size(), 0.0);
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    const double distance = x - nodes[static_cast<std::size_t>(k)];
    if (distance == 0.0) {
      values.assign(nodes.size(), 0.0);
      values[static_cast<std::size_t>(k)] = 1.0;
      return values;
    }
    values[static_cast<std::size_t>(k)] = weight(k, count) / distance;
    sum += values[static_cast<std::size_t>(k)];
  }
  for (double& v : values) v /= sum;
  return values;
}

// Derivative of the k-th Lagrange polynomial at the nodes; Trefethen, Spectral Methods in MATLAB, ch. 6.
std::vector<std::vector<double>> node_derivatives(const std::vector<double>& nodes) {
  const std::size_t count = nodes.size();
  std::vector<std::vector<double>> d(count, std::vector<double>(count, 0.0));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (i == j) continue;
      d[i][j] = weight(static_cast<int>(j), static_cast<int>(count)) /
                weight(static_cast<int>(i), static_cast<int>(count)) / (nodes[i] - nodes[j]);
      d[i][i] -= d[i][j];
    }
  }
  return d;
}

}  // namespace

Matrix::Matrix(int r, int c)
    : rows(r), columns(c), stride((c + kPadding - 1) / kPadding * kPadding),
      values(static_cast<std::size_t>(r) * static_cast<std::size_t>(stride), 0.0F) {}

const std::vector<double>& lobatto_points(int count) {
  static const auto all = [] {
    std::array<std::vector<double>, kMaxLobattoPoints + 1> points;
    for (int n = 2; n <= kMaxLobattoPoints; ++n) {
      auto& of = points[static_cast<std::size_t>(n)];
      for (int k = 0; k < n; ++k) of.push_back(-std::cos(std::numbers::pi * k / (n - 1)));
      if (n % 2 == 1) of[static_cast<std::size_t>(n / 2)] = 0.0;
    }
    return points;
  }();
  assert(count >= 2 && count <= kMaxLobattoPoints);
  return all[static_cast<std::size_t>(count)];
}

Matrix interpolation_matrix(int count, std::span<const double> points) {
  const std::vector<double>& nodes = lobatto_points(count);
  Matrix m(count, static_cast<int>(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::vector<double> values = lagrange(nodes, points[p]);
    for (int k = 0; k < count; ++k)
      m.at(k, static_cast<int>(p)) = static_cast<float>(values[static_cast<std::size_t>(k)]);
  }
  return m;
}

// The derivative has the values D f at the nodes and is itself a polynomial through them.
Matrix derivative_matrix(int count, std::span<const double> points) {
  const std::vector<double>& nodes = lobatto_points(count);
  const auto d = node_derivatives(nodes);
  Matrix m(count, static_cast<int>(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::vector<double> values = lagrange(nodes, points[p]);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      double sum = 0.0;
      for (std::size_t i = 0; i < nodes.size(); ++i) sum += values[i] * d[i][k];
      m.at(static_cast<int>(k), static_cast<int>(p)) = static_cast<float>(sum);
    }
  }
  return m;
}

// The discrete cosine transform that Lobatto points make of it.
Matrix coefficient_matrix(int count) {
  Matrix m(count, count);
  const int n = count - 1;
  for (int k = 0; k < count; ++k) {
    for (int j = 0; j < count; ++j) {
      const double ends = (k == 0 || k == n ? 0.5 : 1.0) * (j == 0 || j == n ? 0.5 : 1.0);
      const double angle = std::numbers::pi * (n - k) * j / n;  // the points rise, the cosine falls
      m.at(k, j) = static_cast<float>(2.0 / n * ends * std::cos(angle));
    }
  }
  return m;
}

void multiply(const float* a, int a_rows, int a_stride, int inner, const Matrix& b, float* out) {
  HWY_DYNAMIC_DISPATCH(multiply_rows)
  (a, static_cast<std::size_t>(a_rows), static_cast<std::size_t>(a_stride), 1, static_cast<std::size_t>(inner),
   b.values.data(), static_cast<std::size_t>(b.stride), out);
}

void multiply_transposed(const Matrix& a, const float* b, int b_stride, float* out) {
  HWY_DYNAMIC_DISPATCH(multiply_rows)
  (a.values.data(), static_cast<std::size_t>(a.columns), 1, static_cast<std::size_t>(a.stride),
   static_cast<std::size_t>(a.rows), b, static_cast<std::size_t>(b_stride), out);
}

void transform(const float* field, int nodes, const Matrix& along_x, const Matrix& along_y, float* out) {
  const int stride = along_x.stride;
  std::array<float, 17 * 32> half{};
  std::array<float, 17 * 32> whole{};
  multiply(field, nodes, nodes, nodes, along_x, half.data());
  multiply_transposed(along_y, half.data(), stride, whole.data());
  for (int row = 0; row < nodes; ++row) std::copy_n(whole.data() + row * stride, nodes, out + row * nodes);
}

double highest_terms(const float* field, int nodes) {
  static const auto all = [] {
    std::array<Matrix, kMaxPatchNodes + 1> matrices;
    for (int n = 2; n <= kMaxPatchNodes; ++n) matrices[static_cast<std::size_t>(n)] = coefficient_matrix(n);
    return matrices;
  }();
  const Matrix& to_coefficients = all[static_cast<std::size_t>(nodes)];
  std::array<float, kMaxPatchNodes * kMaxPatchNodes> c{};
  transform(field, nodes, to_coefficients, to_coefficients, c.data());
  double sum = 0.0;
  for (int k = 0; k < nodes; ++k) {
    sum += std::abs(c[static_cast<std::size_t>(nodes * nodes - nodes + k)]);
    if (k < nodes - 1) sum += std::abs(c[static_cast<std::size_t>(k * nodes + nodes - 1)]);
  }
  return sum;
}

}  // namespace contrejour::inline internal::ray_maps
#endif  // HWY_ONCE
