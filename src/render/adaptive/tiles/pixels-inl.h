// SPDX-License-Identifier: Apache-2.0
// Neighbouring pixels of a row in vectors: three numbers a pixel, interleaved as in a frame.
#if defined(CONTREJOUR_ADAPTIVE_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_PIXELS_INL_H_
#undef CONTREJOUR_ADAPTIVE_PIXELS_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_PIXELS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "render/adaptive/tiles/channel_vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kChannels = 3;
template <class T>
using RowTag = hn::CappedTag<T, 8>;  // rows of polygons are some twenty pixels long

// The pixel and the channel of each number in the vectors of kCount pixels.
template <class T, std::size_t kCount>
struct PixelIndices {
  using Index = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
  alignas(64) Index pixel[kChannels][kCount], channel[kChannels][kCount];
  constexpr PixelIndices() : pixel(), channel() {
    for (std::size_t k = 0; k < kChannels * kCount; ++k) {
      pixel[k / kCount][k % kCount] = static_cast<Index>(k / kChannels);
      channel[k / kCount][k % kCount] = static_cast<Index>(k % kChannels);
    }
  }
};

// As many pixels as a vector has lanes. The first vector begins with the first pixel's three numbers.
template <class T>
struct PixelsOf {
  using Tag = RowTag<T>;
  using Vector = hn::Vec<Tag>;
  static constexpr std::size_t kLanes = hn::MaxLanes(Tag());
  static constexpr int kCount = static_cast<int>(kLanes);
  Vector part[kChannels];

  static HWY_INLINE PixelsOf load(const T* from) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::LoadU(Tag(), from + p * kLanes); });
  }
  HWY_INLINE void store(T* to) const {
    for (std::size_t p = 0; p < kChannels; ++p) hn::StoreU(part[p], Tag(), to + p * kLanes);
  }
  static HWY_INLINE PixelsOf all(T value) {
    return made_of([&](std::size_t) HWY_ATTR { return hn::Set(Tag(), value); });
  }
  // Repeats the number of each pixel in all of its channels.
  static HWY_INLINE PixelsOf of(Vector by_pixel) {
    return made_of([&](std::size_t p) HWY_ATTR { return lookup(by_pixel, kIndices.pixel[p]); });
  }
  // Repeats the same channels for each pixel.
  static HWY_INLINE PixelsOf each(const ChannelVectorOf<T>& channels) {
    if constexpr (ChannelVectorOf<T>::kLanes == kVectorChannels) {
      return made_of([&](std::size_t p)
                         HWY_ATTR { return lookup(widened(Tag(), channels.part[0]), kIndices.channel[p]); });
    } else {
      T repeated[2 * kVectorChannels];
      channels.store(repeated);
      channels.store(repeated + kChannels);
      return made_of([&](std::size_t p) HWY_ATTR { return hn::LoadU(Tag(), repeated + p * kLanes % kChannels); });
    }
  }
  // The pixels' indices 0, 1, 2, ... in all of their channels.
  static HWY_INLINE PixelsOf numbers() {
    return made_of([&](std::size_t p) HWY_ATTR {
      return hn::ConvertTo(Tag(), hn::Load(hn::RebindToSigned<Tag>(), kIndices.pixel[p]));
    });
  }
  friend HWY_INLINE PixelsOf operator+(const PixelsOf& a, const PixelsOf& b) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::Add(a.part[p], b.part[p]); });
  }
  friend HWY_INLINE PixelsOf operator*(const PixelsOf& a, const PixelsOf& b) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::Mul(a.part[p], b.part[p]); });
  }
  friend HWY_INLINE PixelsOf multiply_add(const PixelsOf& a, const PixelsOf& b, const PixelsOf& c) {
    return made_of([&](std::size_t p) HWY_ATTR { return hn::MulAdd(a.part[p], b.part[p], c.part[p]); });
  }

 private:
  static constexpr PixelIndices<T, kLanes> kIndices{};

  template <class Index>
  static HWY_INLINE Vector lookup(Vector in, const Index* at) {
    return hn::TableLookupLanes(in, hn::SetTableIndices(Tag(), at));
  }
  template <class D>
  static HWY_INLINE hn::Vec<D> widened(D d, hn::Vec<typename ChannelVectorOf<T>::Tag> quad) {
    if constexpr (hn::MaxLanes(d) == kVectorChannels)
      return quad;
    else
      return ZeroExtendVector(d, quad);  // found by its arguments' types: scalar targets lack it
  }
  template <class PartOf>
  static HWY_INLINE PixelsOf made_of(const PartOf& part_of) {
    return {{part_of(0), part_of(1), part_of(2)}};
  }
};

// Light that is linear along a row.
template <class T>
class PixelLine {
 public:
  using Pixels = PixelsOf<T>;

  // line: its level is that of the middle of pixel 0.
  explicit HWY_INLINE PixelLine(const ChannelLine<T>& line)
      : slope_(Pixels::each(line.slope)), level_(multiply_add(slope_, Pixels::numbers(), Pixels::each(line.level))) {}

  // The light of the pixels from `first` on.
  [[nodiscard]] HWY_INLINE Pixels at(int first) const { return first == 0 ? level_ : from(first).level_; }
  [[nodiscard]] HWY_INLINE PixelLine from(int first) const { return raised(slope_, first); }
  [[nodiscard]] HWY_INLINE PixelLine raised(const Pixels& by, int times) const {
    return {slope_, multiply_add(by, Pixels::all(static_cast<T>(times)), level_)};
  }

 private:
  HWY_INLINE PixelLine(const Pixels& slope, const Pixels& level) : slope_(slope), level_(level) {}
  Pixels slope_, level_;
};

// Reads doubles as floats, and sets the doubles to zero.
template <class T>
HWY_INLINE PixelsOf<T> taken(double* from) {
  const RowTag<double> d;
  constexpr std::size_t kStep = hn::MaxLanes(RowTag<double>());
  const auto take = [&](double* at) HWY_ATTR {
    const auto floats = hn::DemoteTo(hn::Rebind<T, RowTag<double>>(), hn::LoadU(d, at));
    hn::StoreU(hn::Zero(d), d, at);
    return floats;
  };
  PixelsOf<T> out;
  for (std::size_t p = 0; p < kChannels; ++p, from += PixelsOf<T>::kLanes) {
    if constexpr (PixelsOf<T>::kLanes == kStep) {
      out.part[p] = take(from);
    } else {
      const auto low = take(from);
      out.part[p] = Combine(RowTag<T>(), take(from + kStep), low);
    }
  }
  return out;
}

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
