// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/convolve_block.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/area_lights/convolve_block.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::area::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 8>;

bool has_light(const float* block) {
  const Tag d;
  const hn::RebindToUnsigned<Tag> du;
  auto bits = hn::Zero(du);
  for (std::size_t k = 0; k < kBlockFloats; k += hn::Lanes(d))
    bits = hn::Or(bits, hn::BitCast(du, hn::LoadU(d, block + k)));
  return !hn::AllTrue(du, hn::Eq(bits, hn::Zero(du)));
}

bool is_curved(const float* above, const float* block, const float* below, float threshold) {
  const Tag d;
  const auto limit = hn::Set(d, threshold);
  auto curved = hn::Zero(d);
  for (std::size_t k = 0; k < kBlockFloats; k += hn::Lanes(d)) {
    const auto twice = hn::Add(hn::LoadU(d, block + k), hn::LoadU(d, block + k));
    const auto second = [&](const float* a, const float* b)
                            HWY_ATTR { return hn::Abs(hn::Sub(hn::Add(hn::LoadU(d, a), hn::LoadU(d, b)), twice)); };
    curved = hn::Max(curved, hn::Max(second(block + k - 3, block + k + 3), second(above + k, below + k)));
  }
  return !hn::AllTrue(d, hn::Le(curved, limit));
}

// Adds half a block at a time, in three vectors of up to 8 with one pattern of weights each, so that sums stay in
// registers.
void add_half(const BlockTerm* terms, std::size_t count, std::size_t offset, float* to) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t part = 0; part < kPatternFloats; part += 3 * lanes) {
    const std::size_t at = offset + part;
    auto a = hn::LoadU(d, to + at), b = hn::LoadU(d, to + at + lanes), c = hn::LoadU(d, to + at + 2 * lanes);
    for (std::size_t t = 0; t < count; ++t) {
      const float* from = terms[t].from + at;
      const float* weights = terms[t].weights + part;
      for (std::size_t k = 0; k < terms[t].count; ++k, from -= 3, weights += kPatternFloats) {
        a = hn::MulAdd(hn::LoadU(d, weights), hn::LoadU(d, from), a);
        b = hn::MulAdd(hn::LoadU(d, weights + lanes), hn::LoadU(d, from + lanes), b);
        c = hn::MulAdd(hn::LoadU(d, weights + 2 * lanes), hn::LoadU(d, from + 2 * lanes), c);
      }
    }
    hn::StoreU(a, d, to + at);
    hn::StoreU(b, d, to + at + lanes);
    hn::StoreU(c, d, to + at + 2 * lanes);
  }
}

void add_coloured_block(const BlockTerm* terms, std::size_t count, float* to) {
  for (std::size_t half = 0; half < kBlockFloats; half += kPatternFloats) add_half(terms, count, half, to);
}

// Six vectors at a time share each weight.
void add_block(const BlockTerm* terms, std::size_t count, float* to) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t part = 0; part < kBlockFloats; part += 6 * lanes) {
    float* const out = to + part;
    auto s0 = hn::LoadU(d, out), s1 = hn::LoadU(d, out + lanes), s2 = hn::LoadU(d, out + 2 * lanes);
    auto s3 = hn::LoadU(d, out + 3 * lanes), s4 = hn::LoadU(d, out + 4 * lanes), s5 = hn::LoadU(d, out + 5 * lanes);
    for (std::size_t t = 0; t < count; ++t) {
      const float* from = terms[t].from + part;
      const float* const weights = terms[t].weights;
      for (std::size_t k = 0; k < terms[t].count; ++k, from -= 3) {
        const auto w = hn::Set(d, weights[k]);
        s0 = hn::MulAdd(w, hn::LoadU(d, from), s0);
        s1 = hn::MulAdd(w, hn::LoadU(d, from + lanes), s1);
        s2 = hn::MulAdd(w, hn::LoadU(d, from + 2 * lanes), s2);
        s3 = hn::MulAdd(w, hn::LoadU(d, from + 3 * lanes), s3);
        s4 = hn::MulAdd(w, hn::LoadU(d, from + 4 * lanes), s4);
        s5 = hn::MulAdd(w, hn::LoadU(d, from + 5 * lanes), s5);
      }
    }
    hn::StoreU(s0, d, out);
    hn::StoreU(s1, d, out + lanes);
    hn::StoreU(s2, d, out + 2 * lanes);
    hn::StoreU(s3, d, out + 3 * lanes);
    hn::StoreU(s4, d, out + 4 * lanes);
    hn::StoreU(s5, d, out + 5 * lanes);
  }
}

}  // namespace contrejour::inline internal::area::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal::area {

HWY_EXPORT(has_light);
HWY_EXPORT(is_curved);
HWY_EXPORT(add_block);
HWY_EXPORT(add_coloured_block);

bool has_light(const float* block) { return HWY_DYNAMIC_DISPATCH(has_light)(block); }

bool is_curved(const float* above, const float* block, const float* below, float threshold) {
  return HWY_DYNAMIC_DISPATCH(is_curved)(above, block, below, threshold);
}

void add_block(std::span<const BlockTerm> terms, float* to) {
  HWY_DYNAMIC_DISPATCH(add_block)(terms.data(), terms.size(), to);
}

void add_coloured_block(std::span<const BlockTerm> terms, float* to) {
  HWY_DYNAMIC_DISPATCH(add_coloured_block)(terms.data(), terms.size(), to);
}

}  // namespace contrejour::inline internal::area
#endif  // HWY_ONCE
