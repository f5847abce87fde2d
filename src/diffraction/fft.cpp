// SPDX-License-Identifier: Apache-2.0
#include "diffraction/fft.h"

#include <algorithm>
#include <cassert>

#define POCKETFFT_NO_MULTITHREADING  // threads come from base/tasks
#define POCKETFFT_CACHE_SIZE 0       // no state between calls
// pocketfft calls aligned_alloc with sizes that are no multiple of the alignment, which C11 forbids and sanitizers
// report. This macro makes it align memory itself.
#ifndef _LIBCPP_HAS_NO_ALIGNED_ALLOCATION
#define _LIBCPP_HAS_NO_ALIGNED_ALLOCATION  // NOLINT(bugprone-reserved-identifier)
#endif
#include <gemmi/third_party/pocketfft_hdronly.h>

#include "base/tasks.h"

namespace contrejour::inline internal {
namespace {

// Rows and columns are divided into a fixed number of pieces: enough for many threads, few enough that each is worth
// its own tables.
constexpr std::size_t kPieces = 32;

struct Piece {
  std::size_t begin, size;
};

Piece piece_of(std::size_t count, std::size_t k) {
  const std::size_t begin = count * k / kPieces;
  return {begin, count * (k + 1) / kPieces - begin};
}

bool forward(FftDirection direction) { return direction == FftDirection::Forward; }

template <class Real>
bool fft_columns(std::complex<Real>* data, FftShape shape, FftDirection direction, const Context& context) {
  constexpr auto item = static_cast<std::ptrdiff_t>(sizeof(std::complex<Real>));
  const pocketfft::stride_t strides{static_cast<std::ptrdiff_t>(shape.columns) * item, item};
  return parallel_for(kPieces, context, [&](std::size_t k) {
    const Piece piece = piece_of(shape.columns, k);
    if (piece.size == 0) return;
    pocketfft::c2c({shape.rows, piece.size}, strides, strides, {0}, forward(direction), data + piece.begin,
                   data + piece.begin, Real(1));
  });
}

}  // namespace

template <class Real>
void fft_rows(std::span<std::complex<Real>> data, FftShape shape, FftDirection direction) {
  assert(data.size() == shape.rows * shape.columns);
  constexpr auto item = static_cast<std::ptrdiff_t>(sizeof(std::complex<Real>));
  const pocketfft::stride_t strides{static_cast<std::ptrdiff_t>(shape.columns) * item, item};
  pocketfft::c2c({shape.rows, shape.columns}, strides, strides, {1}, forward(direction), data.data(), data.data(),
                 Real(1));
}

template <class Real>
bool fft_2d(std::span<std::complex<Real>> data, FftShape shape, FftDirection direction, const Context& context) {
  assert(data.size() == shape.rows * shape.columns);
  const bool finished = parallel_for(kPieces, context, [&](std::size_t k) {
    const Piece piece = piece_of(shape.rows, k);
    if (piece.size > 0)
      fft_rows(data.subspan(piece.begin * shape.columns, piece.size * shape.columns), {piece.size, shape.columns},
               direction);
  });
  return finished && fft_columns(data.data(), shape, direction, context);
}

template void fft_rows(std::span<std::complex<float>>, FftShape, FftDirection);
template void fft_rows(std::span<std::complex<double>>, FftShape, FftDirection);
template bool fft_2d(std::span<std::complex<float>>, FftShape, FftDirection, const Context&);
template bool fft_2d(std::span<std::complex<double>>, FftShape, FftDirection, const Context&);

std::vector<std::complex<float>> fft_2d_real(std::span<const float> data, FftShape shape, std::size_t padded,
                                             std::size_t columns, const Context& context) {
  const std::size_t all = padded / 2 + 1;
  assert(shape.rows <= padded && shape.columns <= padded && padded % 2 == 0 && columns <= all);
  std::vector<std::complex<float>> spectrum(padded * columns);
  constexpr auto real_item = static_cast<std::ptrdiff_t>(sizeof(float));
  constexpr auto item = static_cast<std::ptrdiff_t>(sizeof(std::complex<float>));
  // Rows of zeros stay zeros: only those with data are transformed.
  parallel_for(kPieces, context, [&](std::size_t k) {
    const Piece piece = piece_of(shape.rows, k);
    if (piece.size == 0) return;
    std::vector<float> rows(piece.size * padded);
    std::vector<std::complex<float>> transformed(piece.size * all);
    for (std::size_t r = 0; r < piece.size; ++r)
      std::copy_n(data.data() + (piece.begin + r) * shape.columns, shape.columns, rows.data() + r * padded);
    pocketfft::r2c({piece.size, padded}, {static_cast<std::ptrdiff_t>(padded) * real_item, real_item},
                   {static_cast<std::ptrdiff_t>(all) * item, item}, 1, true, rows.data(), transformed.data(), 1.0F);
    for (std::size_t r = 0; r < piece.size; ++r)
      std::copy_n(transformed.data() + r * all, columns, spectrum.data() + (piece.begin + r) * columns);
  });
  fft_columns(spectrum.data(), {padded, columns}, FftDirection::Forward, context);
  return spectrum;
}

std::size_t good_fft_size(std::size_t min_size) {
  return 2 * pocketfft::detail::util::good_size_cmplx(std::max<std::size_t>(1, (min_size + 1) / 2));
}

}  // namespace contrejour::inline internal
