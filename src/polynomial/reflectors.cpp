// SPDX-License-Identifier: Apache-2.0
#include "polynomial/reflectors.h"

#include <algorithm>
#include <cmath>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "polynomial/reflectors.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::polynomial::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using DoubleTag = hn::CappedTag<double, kRowsMultiple>;
using Doubles = hn::Vec<DoubleTag>;
constexpr std::size_t kVectorsAtOnce = 4, kColumnsAtOnce = 3;  // sums in registers: 12

// The products of kVectors vectors and kColumns columns, to products[column * kPanelColumns + vector].
template <std::size_t kVectors, std::size_t kColumns>
HWY_INLINE void multiply_block(const double* vectors, const double* columns, std::size_t rows, double* products) {
  const DoubleTag d;
  std::array<std::array<Doubles, kVectors>, kColumns> sums;
  for (auto& of_column : sums)
    for (Doubles& sum : of_column) sum = hn::Zero(d);
  for (std::size_t row = 0; row < rows; row += hn::Lanes(d)) {
    std::array<Doubles, kColumns> x;
    for (std::size_t k = 0; k < kColumns; ++k) x[k] = hn::LoadU(d, columns + k * rows + row);
    for (std::size_t j = 0; j < kVectors; ++j) {
      const Doubles v = hn::LoadU(d, vectors + j * rows + row);
      for (std::size_t k = 0; k < kColumns; ++k) sums[k][j] = hn::MulAdd(v, x[k], sums[k][j]);
    }
  }
  for (std::size_t k = 0; k < kColumns; ++k)
    for (std::size_t j = 0; j < kVectors; ++j)
      products[k * kPanelColumns + j] = hn::GetLane(hn::SumOfLanes(d, sums[k][j]));
}

template <std::size_t kColumns>
HWY_INLINE void multiply(const double* vectors, std::size_t count, const double* columns, std::size_t rows,
                         double* products) {
  std::size_t j = 0;
  for (; j + kVectorsAtOnce <= count; j += kVectorsAtOnce)
    multiply_block<kVectorsAtOnce, kColumns>(vectors + j * rows, columns, rows, products + j);
  for (; j < count; ++j) multiply_block<1, kColumns>(vectors + j * rows, columns, rows, products + j);
}

// Subtracts from each column the sum of the vectors times factors[column * kPanelColumns + vector].
template <std::size_t kVectors, std::size_t kColumns>
HWY_INLINE void subtract_block(const double* vectors, const double* factors, double* columns, std::size_t rows) {
  const DoubleTag d;
  std::array<std::array<Doubles, kVectors>, kColumns> by;
  for (std::size_t k = 0; k < kColumns; ++k)
    for (std::size_t j = 0; j < kVectors; ++j) by[k][j] = hn::Set(d, factors[k * kPanelColumns + j]);
  for (std::size_t row = 0; row < rows; row += hn::Lanes(d)) {
    std::array<Doubles, kColumns> x;
    for (std::size_t k = 0; k < kColumns; ++k) x[k] = hn::LoadU(d, columns + k * rows + row);
    for (std::size_t j = 0; j < kVectors; ++j) {
      const Doubles v = hn::LoadU(d, vectors + j * rows + row);
      for (std::size_t k = 0; k < kColumns; ++k) x[k] = hn::NegMulAdd(by[k][j], v, x[k]);
    }
    for (std::size_t k = 0; k < kColumns; ++k) hn::StoreU(x[k], d, columns + k * rows + row);
  }
}

template <std::size_t kColumns>
HWY_INLINE void subtract(const double* vectors, std::size_t count, const double* factors, double* columns,
                         std::size_t rows) {
  std::size_t j = 0;
  for (; j + kVectorsAtOnce <= count; j += kVectorsAtOnce)
    subtract_block<kVectorsAtOnce, kColumns>(vectors + j * rows, factors + j, columns, rows);
  for (; j < count; ++j) subtract_block<1, kColumns>(vectors + j * rows, factors + j, columns, rows);
}

// Replaces kColumns columns x by x - V T^T V^T x. Their entries in the panel's rows of the ridge are 0 before.
template <std::size_t kColumns>
HWY_INLINE void reflect_columns(const Panel& panel, const double* vectors, std::size_t rows, double* columns,
                                double* panel_rows) {
  std::array<double, kColumns * kPanelColumns> products{}, factors{};
  multiply<kColumns>(vectors, panel.count, columns, rows, products.data());
  for (std::size_t k = 0; k < kColumns * kPanelColumns; k += kPanelColumns) {
    for (std::size_t j = 0; j < panel.count; ++j) {
      for (std::size_t i = 0; i <= j; ++i) factors[k + j] += panel.t[i][j] * products[k + i];
      panel_rows[k + j] = -factors[k + j];
    }
  }
  subtract<kColumns>(vectors, panel.count, factors.data(), columns, rows);
}

void reflect_all(const Panel& panel, const double* vectors, std::size_t rows, double* columns, std::size_t count,
                 double* panel_rows) {
  std::size_t k = 0;
  for (; k + kColumnsAtOnce <= count; k += kColumnsAtOnce)
    reflect_columns<kColumnsAtOnce>(panel, vectors, rows, columns + k * rows, panel_rows + k * kPanelColumns);
  for (; k < count; ++k) reflect_columns<1>(panel, vectors, rows, columns + k * rows, panel_rows + k * kPanelColumns);
}

void factor(double* columns, std::size_t rows, double ridge, Panel& panel,
            std::array<std::array<double, kPanelColumns>, kPanelColumns>& r) {
  const DoubleTag d;
  for (std::size_t j = 0; j < panel.count; ++j) {
    double* const v = columns + j * rows;
    std::array<double, kPanelColumns> products{};
    multiply_block<1, 1>(v, v, rows, products.data());
    const double norm = std::sqrt(ridge * ridge + products[0]);
    // The ridge is not negative, so that this sum loses no digits.
    const double first = ridge + norm, tau = norm > 0.0 ? first / norm : 0.0;
    const Doubles by = hn::Set(d, first > 0.0 ? 1.0 / first : 0.0);
    for (std::size_t row = 0; row < rows; row += hn::Lanes(d))
      hn::StoreU(hn::Mul(by, hn::LoadU(d, v + row)), d, v + row);
    r[j][j] = -norm;
    panel.t[j][j] = tau;
    // Products with the vectors before give T's column, which LAPACK's dlarft computes like this, too.
    if (j > 0) multiply<1>(columns, j, v, rows, products.data());
    for (std::size_t i = 0; i < j; ++i) {
      double sum = 0.0;
      for (std::size_t l = i; l < j; ++l) sum += panel.t[i][l] * products[l];
      panel.t[i][j] = -tau * sum;
    }
    for (std::size_t k = j + 1; k < panel.count; ++k) {
      double* const x = columns + k * rows;
      multiply_block<1, 1>(v, x, rows, products.data());
      products[0] *= tau;
      r[j][k] = -products[0];
      subtract_block<1, 1>(v, products.data(), x, rows);
    }
  }
}

}  // namespace contrejour::inline internal::polynomial::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal::polynomial {
namespace {

HWY_EXPORT(factor);
HWY_EXPORT(reflect_all);

}  // namespace

void factor_panel(double* columns, std::size_t rows, double ridge, Panel& panel,
                  std::array<std::array<double, kPanelColumns>, kPanelColumns>& r) {
  HWY_DYNAMIC_DISPATCH(factor)(columns, rows, ridge, panel, r);
}

void reflect(const Panel& panel, const double* vectors, std::size_t rows, double* columns, std::size_t count,
             double* panel_rows) {
  HWY_DYNAMIC_DISPATCH(reflect_all)(panel, vectors, rows, columns, count, panel_rows);
}

}  // namespace contrejour::inline internal::polynomial
#endif  // HWY_ONCE
