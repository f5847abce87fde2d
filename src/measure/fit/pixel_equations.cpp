// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/pixel_equations.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "measure/fit/pixel_equations.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 4>;  // divides both numbers of curves

struct ChannelFactors {
  hn::Vec<Tag> red, green, blue;
};

// Adds the sum over the channels of a column of derivatives times a factor.
template <std::size_t kRows>
HWY_INLINE void add_column(const PixelTerm& term, const ChannelFactors& by, std::size_t from, double* sums) {
  const Tag d;
  for (std::size_t row = from; row < kRows; row += hn::Lanes(d)) {
    auto sum = hn::LoadU(d, sums + row);
    sum = hn::MulAdd(by.red, hn::LoadU(d, &term.by_shape[0][row]), sum);
    sum = hn::MulAdd(by.green, hn::LoadU(d, &term.by_shape[1][row]), sum);
    sum = hn::MulAdd(by.blue, hn::LoadU(d, &term.by_shape[2][row]), sum);
    hn::StoreU(sum, d, sums + row);
  }
}

template <std::size_t kRows>
HWY_INLINE void add_channel(const PixelTerm& term, std::size_t channel, double by, double* sums) {
  const Tag d;
  const auto factor = hn::Set(d, by);
  for (std::size_t row = 0; row < kRows; row += hn::Lanes(d)) {
    const auto sum = hn::LoadU(d, sums + row);
    hn::StoreU(hn::MulAdd(factor, hn::LoadU(d, &term.by_shape[channel][row]), sum), d, sums + row);
  }
}

HWY_INLINE ChannelFactors factors_of(const PixelTerm& term, std::size_t curve, const PixelResidual& at) {
  const Tag d;
  return {hn::Set(d, at.weight[0] * term.by_shape[0][curve]), hn::Set(d, at.weight[1] * term.by_shape[1][curve]),
          hn::Set(d, at.weight[2] * term.by_shape[2][curve])};
}

// kStride: of the columns.
template <std::size_t kRows, std::size_t kColumns, std::size_t kStride>
HWY_INLINE void add_products(const PixelTerm& a, const PixelTerm& b, const PixelResidual& at, double* sums) {
  for (std::size_t k = 0; k < kColumns; ++k) add_column<kRows>(a, factors_of(b, k, at), 0, sums + k * kStride);
}

// A term with itself: columns down to the diagonal.
template <std::size_t kRows, std::size_t kStride>
HWY_INLINE void add_squares(const PixelTerm& term, const PixelResidual& at, double* sums) {
  for (std::size_t k = 0; k < kRows; ++k) {
    const std::size_t from = k / hn::Lanes(Tag()) * hn::Lanes(Tag());
    add_column<kRows>(term, factors_of(term, k, at), from, sums + k * kStride);
  }
}

// Derivatives by the curves of one term times those by the levels of another.
template <std::size_t kRows>
HWY_INLINE void add_by_levels(const PixelTerm& term, const PixelTerm& levels, const PixelResidual& at, double* sums) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (levels.border != 0.0) add_channel<kRows>(term, c, at.weight[c] * levels.border, sums + c * kShapeCurves);
    if (levels.inside != 0.0) add_channel<kRows>(term, c, at.weight[c] * levels.inside, sums + (3 + c) * kShapeCurves);
  }
}

HWY_INLINE void add_shape_by_levels(const PixelTerm& term, const PixelTerm& levels, const PixelResidual& at,
                                    double* sums) {
  if (term.shape == kShapeCurves) add_by_levels<kShapeCurves>(term, levels, at, sums);
  if (term.shape == kPlaceCurves) add_by_levels<kPlaceCurves>(term, levels, at, sums);
}

HWY_INLINE void add_levels(const PixelTerm& a, const PixelTerm& b, const PixelResidual& at, GhostProducts& sums) {
  for (std::size_t c = 0; c < 3; ++c) {
    double* to = &sums.levels[4 * c];
    to[0] += at.weight[c] * a.border * b.border;
    to[1] += at.weight[c] * a.border * b.inside;
    to[2] += at.weight[c] * a.inside * b.border;
    to[3] += at.weight[c] * a.inside * b.inside;
  }
}

void add_self(const PixelTerm& term, const PixelResidual& at, GhostProducts& sums, PlaceProducts& place) {
  if (term.shape == kShapeCurves) add_squares<kShapeCurves, kShapeCurves>(term, at, sums.shape.data());
  if (term.shape == kPlaceCurves) add_squares<kPlaceCurves, kPlaceCurves>(term, at, place.data());
  add_shape_by_levels(term, term, at, sums.shape_by_level.data());
  add_levels(term, term, at, sums);
}

void add_pair(const PixelTerm& a, const PixelTerm& b, const PixelResidual& at, GhostProducts& sums,
              PlaceProducts& place) {
  constexpr std::size_t kAll = kShapeCurves, kPlace = kPlaceCurves;
  if (a.shape == kPlace && b.shape == kPlace) return add_products<kPlace, kPlace, kPlace>(a, b, at, place.data());
  if (a.shape == kAll && b.shape == kAll) add_products<kAll, kAll, kAll>(a, b, at, sums.shape.data());
  if (a.shape == kAll && b.shape == kPlace) add_products<kAll, kPlace, kAll>(a, b, at, sums.shape.data());
  if (a.shape == kPlace && b.shape == kAll) add_products<kPlace, kAll, kAll>(a, b, at, sums.shape.data());
  add_shape_by_levels(a, b, at, sums.shape_by_level.data());
  add_shape_by_levels(b, a, at, sums.level_by_shape.data());
  add_levels(a, b, at, sums);
}

// products, places: triangles, row by row.
void add_pixel(std::span<const PixelTerm> terms, const PixelResidual& at, std::size_t ghosts, GhostProducts* products,
               PlaceProducts* places) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const std::size_t a = terms[i].ghost, row = a * ghosts - a * (a + 1) / 2;  // of the triangle, less the column
    add_self(terms[i], at, products[row + a], places[row + a]);
    for (std::size_t j = i + 1; j < terms.size(); ++j)
      add_pair(terms[i], terms[j], at, products[row + terms[j].ghost], places[row + terms[j].ghost]);
  }
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "measure/model/flare_curves.h"

namespace contrejour::inline internal {

HWY_EXPORT(add_pixel);

namespace {

constexpr std::size_t kLevelsOfGhost = 6;
static_assert(kShapeCurves + kLevelsOfGhost == kGhostCurves);

// The product of two curves, each below kGhostCurves.
double product_of(const GhostProducts& sums, const PlaceProducts& places, std::size_t row, std::size_t column) {
  if (row < kShapeCurves && column < kShapeCurves) {
    const bool place = row < kPlaceCurves && column < kPlaceCurves;
    return sums.shape[kShapeCurves * column + row] + (place ? places[kPlaceCurves * column + row] : 0.0);
  }
  if (row < kShapeCurves) return sums.shape_by_level[kShapeCurves * (column - kShapeCurves) + row];
  if (column < kShapeCurves) return sums.level_by_shape[kShapeCurves * (row - kShapeCurves) + column];
  const std::size_t i = row - kShapeCurves, j = column - kShapeCurves;
  return i % 3 == j % 3 ? sums.levels[4 * (i % 3) + 2 * (i / 3) + j / 3] : 0.0;
}

}  // namespace

PixelEquations::PixelEquations(std::size_t ghosts)
    : ghosts_(ghosts), gradient_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kGhostCurves * ghosts))),
      products_(ghosts * (ghosts + 1) / 2), places_(products_.size()) {}

void PixelEquations::add(std::span<const PixelTerm> terms, const PixelResidual& residual) {
  for (const PixelTerm& term : terms) {
    double* to = gradient_.data() + kGhostCurves * term.ghost;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < term.shape; ++k) to[k] += residual.weighted[c] * term.by_shape[c][k];
      to[kShapeCurves + c] += residual.weighted[c] * term.border;
      to[kShapeCurves + 3 + c] += residual.weighted[c] * term.inside;
    }
  }
  HWY_DYNAMIC_DISPATCH(add_pixel)(terms, residual, ghosts_, products_.data(), places_.data());
}

Eigen::MatrixXd PixelEquations::hessian() const {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(gradient_.size(), gradient_.size());
  std::size_t pair = 0;
  for (std::size_t a = 0; a < ghosts_; ++a) {
    for (std::size_t b = a; b < ghosts_; ++b, ++pair) {
      for (std::size_t column = 0; column < kGhostCurves; ++column) {
        for (std::size_t row = 0; row < kGhostCurves; ++row) {
          // One half of a ghost's products with itself is summed.
          const bool swapped = a == b && column < kShapeCurves && (row < column || row >= kShapeCurves);
          all(static_cast<Eigen::Index>(kGhostCurves * a + row), static_cast<Eigen::Index>(kGhostCurves * b + column)) =
              swapped ? product_of(products_[pair], places_[pair], column, row)
                      : product_of(products_[pair], places_[pair], row, column);
        }
      }
    }
  }
  return all;
}

}  // namespace contrejour::inline internal
#endif
