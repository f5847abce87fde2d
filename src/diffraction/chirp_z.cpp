// SPDX-License-Identifier: Apache-2.0
#include "diffraction/chirp_z.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/tasks.h"
#include "diffraction/complex_product.h"
#include "diffraction/fft.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kRowsAtOnce = 16;

// exp(-2 pi i turns), also accurate for turns too large for sin and cos.
std::complex<double> phasor(double turns) {
  return std::polar(1.0, -2.0 * std::numbers::pi * (turns - std::nearbyint(turns)));
}

}  // namespace

RegularPoints centred_points(std::size_t count, double step) {
  return {count, -0.5 * static_cast<double>(count - 1) * step, step};
}

// x_j u_k = x0 u0 + j dx u0 + k du x0 + dx du (j^2 + k^2 - (k - j)^2) / 2: a product before and one after a convolution
// with exp(+i pi dx du m^2).
ChirpZ::ChirpZ(const RegularPoints& from, const RegularPoints& to)
    : from_(from.count), to_(to.count), length_(good_fft_size(from.count + to.count)), before_(from_), kernel_(length_),
      after_(to_) {
  const double half = 0.5 * from.step * to.step;
  for (std::size_t j = 0; j < from_; ++j) {
    const auto x = static_cast<double>(j);
    before_[j] = phasor(x * from.step * to.first + half * x * x);
  }
  for (std::size_t k = 0; k < to_; ++k) {
    const auto u = static_cast<double>(k);
    after_[k] = phasor(from.first * (to.first + u * to.step) + half * u * u) / static_cast<double>(length_);
    kernel_[k] = phasor(-half * u * u);
  }
  for (std::size_t j = 1; j < from_; ++j) {
    const auto m = static_cast<double>(j);
    kernel_[length_ - j] = phasor(-half * m * m);
  }
  fft_rows<double>(kernel_, {1, length_}, FftDirection::Forward);
}

ChirpZ::Row ChirpZ::transform_transposed(std::span<const std::complex<double>> data, std::size_t rows,
                                         const Context& context) const {
  Row result(rows * to_);
  parallel_for((rows + kRowsAtOnce - 1) / kRowsAtOnce, context, [&](std::size_t block) {
    const std::size_t first = block * kRowsAtOnce, count = std::min(kRowsAtOnce, rows - first);
    Row work(count * length_);
    for (std::size_t r = 0; r < count; ++r)
      for (std::size_t j = 0; j < from_; ++j)
        work[r * length_ + j] = product(data[(first + r) * from_ + j], before_[j]);
    fft_rows<double>(work, {count, length_}, FftDirection::Forward);
    for (std::size_t r = 0; r < count; ++r)
      for (std::size_t i = 0; i < length_; ++i) work[r * length_ + i] = product(work[r * length_ + i], kernel_[i]);
    fft_rows<double>(work, {count, length_}, FftDirection::Backward);
    for (std::size_t k = 0; k < to_; ++k)
      for (std::size_t r = 0; r < count; ++r) result[k * rows + first + r] = product(work[r * length_ + k], after_[k]);
  });
  return result;
}

std::vector<std::complex<double>> ChirpZ::transform_2d(std::span<const std::complex<double>> data,
                                                       const Context& context) const {
  assert(data.size() == from_ * from_);
  return transform_transposed(transform_transposed(data, from_, context), to_, context);
}

}  // namespace contrejour::inline internal
