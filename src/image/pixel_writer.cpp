// SPDX-License-Identifier: Apache-2.0
#include "image/pixel_writer.h"

#include <algorithm>
#include <cstdint>

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/pixel_writer.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The number of floats before the next aligned vector in memory.
std::size_t floats_to_vector(const float* at, std::size_t lanes) {
  const auto past = reinterpret_cast<std::uintptr_t>(at) / sizeof(float) % lanes;
  return past == 0 ? 0 : lanes - past;
}

// Calls `vector(k)` for aligned vectors of the memory at `to`, and `one(k)` for floats before and after them.
template <class Vector, class One>
HWY_INLINE void stream(float* to, std::size_t count, const Vector& vector, const One& one) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d), first = std::min(floats_to_vector(to, lanes), count);
  std::size_t k = 0;
  for (; k < first; ++k) to[k] = one(k);
  for (; k + lanes <= count; k += lanes) hn::Stream(vector(k), d, to + k);
  for (; k < count; ++k) to[k] = one(k);
}

void stream_copy(const float* from, std::size_t count, float* to) {
  const hn::ScalableTag<float> d;
  stream(
      to, count, [&](std::size_t k) HWY_ATTR { return hn::LoadU(d, from + k); },
      [&](std::size_t k) { return from[k]; });
}

void stream_zeros(std::size_t count, float* to) {
  const hn::ScalableTag<float> d;
  stream(to, count, [&](std::size_t) HWY_ATTR { return hn::Zero(d); }, [](std::size_t) { return 0.0F; });
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal {
namespace {

HWY_EXPORT(stream_copy);
HWY_EXPORT(stream_zeros);

constexpr std::size_t kCacheBytes = std::size_t{16} << 20U;  // that may hold a picture until it is read

}  // namespace

PixelWriter::PixelWriter(const Image& image) : past_caches_(image.pixels.size() * sizeof(float) > kCacheBytes) {}

PixelWriter::~PixelWriter() {
  if (past_caches_) hwy::FlushStream();
}

void PixelWriter::write(const float* from, std::size_t count, float* to) const {
  if (past_caches_)
    HWY_DYNAMIC_DISPATCH(stream_copy)(from, count, to);
  else
    std::copy_n(from, count, to);
}

void PixelWriter::clear(std::size_t count, float* to) const {
  if (past_caches_)
    HWY_DYNAMIC_DISPATCH(stream_zeros)(count, to);
  else
    std::fill_n(to, count, 0.0F);
}

}  // namespace contrejour::inline internal
#endif  // HWY_ONCE
