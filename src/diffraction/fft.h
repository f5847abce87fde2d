// SPDX-License-Identifier: Apache-2.0
// The interface to the FFT (pocketfft, in float and double), on the project's threads.
// Row-major squares and rectangles; unscaled both ways, exp(-2 pi i) forward. The same bits for any number of threads.
// Returns false when cancelled; the data are then incomplete.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/context.h"

namespace contrejour::inline internal {

struct FftShape {
  std::size_t rows = 0, columns = 0;
};
enum class FftDirection { Forward, Backward };

template <class Real>
bool fft_2d(std::span<std::complex<Real>> data, FftShape shape, FftDirection direction, const Context& context);

// Transforms each row, on the calling thread.
template <class Real>
void fft_rows(std::span<std::complex<Real>> data, FftShape shape, FftDirection direction);

// Spectrum of a real rectangle in the top left corner of a padded x padded square of zeros: rows are all `padded`
// frequencies, columns the first ones, at most padded / 2 + 1: the others are complex conjugates of these. padded is
// even.
[[nodiscard]] std::vector<std::complex<float>> fft_2d_real(std::span<const float> data, FftShape shape,
                                                           std::size_t padded, std::size_t columns,
                                                           const Context& context);

// The smallest even size >= least for which pocketfft is fast.
[[nodiscard]] std::size_t good_fft_size(std::size_t min_size);

}  // namespace contrejour::inline internal
