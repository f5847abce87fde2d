#include "render/area/convolve_block.h"

#include "kernels/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/area/convolve_block.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::area::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 8>;

// Half a block at a time, three vectors of up to 8 with one pattern each, so that sums stay in registers.
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

void add_block(const BlockTerm* terms, std::size_t count, float* to) {
  for (std::size_t half = 0; half < kBlockFloats; half += kPatternFloats) add_half(terms, count, half, to);
}

}  // namespace contrejour::area::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::area {

HWY_EXPORT(add_block);

void add_block(std::span<const BlockTerm> terms, float* to) {
  HWY_DYNAMIC_DISPATCH(add_block)(terms.data(), terms.size(), to);
}

}  // namespace contrejour::area
#endif  // HWY_ONCE
