// SPDX-License-Identifier: Apache-2.0
// Pixels of a host's image: RGB or RGBA, float or half, the lowest row first, rows any number of bytes apart, also a
// negative one. Thread-safety: one thread at a time uses an image.
#pragma once

#include <cstddef>
#include <optional>

#include "contrejour/apply.h"
#include "openfx/host.h"
#include "openfx/transfer.h"

namespace contrejour::openfx {

enum class Depth { Float, Half };

// An image of a clip, released when this object is destroyed.
class HostImage {
 public:
  // Empty if the clip has no image.
  [[nodiscard]] static std::optional<HostImage> fetch(const Host& host, ClipHandle clip, Time time);
  HostImage(HostImage&& other) noexcept;
  HostImage& operator=(HostImage&&) = delete;
  ~HostImage();

  // Errors: bytes or shorts, other channels, rows that overlap, no pixels.
  [[nodiscard]] Result<void> check() const;

  [[nodiscard]] const Properties& properties() const { return properties_; }
  [[nodiscard]] RectI bounds() const { return bounds_; }
  [[nodiscard]] Depth depth() const { return depth_.value_or(Depth::Float); }
  [[nodiscard]] int channels() const { return channels_; }
  [[nodiscard]] std::ptrdiff_t pixel_bytes() const;
  [[nodiscard]] bool contains_row(int y) const { return y >= bounds_.y1 && y < bounds_.y2; }
  // The first pixel of a row of the bounds.
  [[nodiscard]] std::byte* row(int y) const {
    return data_ + (static_cast<std::ptrdiff_t>(y) - bounds_.y1) * row_bytes_;
  }

 private:
  HostImage(const Host& host, PropertySetHandle image);

  const Host* host_;
  Properties properties_;
  std::byte* data_ = nullptr;
  RectI bounds_{};
  std::ptrdiff_t row_bytes_ = 0;
  std::optional<Depth> depth_;
  int channels_ = 0;  // 0: neither RGB nor RGBA
};

// The part of a source in a region (rows from the top, y = 0 between the host's rows -1 and 0), decoded; 0 outside.
[[nodiscard]] Image decoded_region(const HostImage& source, const PixelWindow& region, TransferCurve curve);

// The pictures that make up the output, and how.
struct Composition {
  const HostImage* source = nullptr;  // null: black
  const Image* flare = nullptr;  // of the region; null: none
  PixelWindow region;
  bool shows_source = true;
  enum class Alpha { Source, Zero, Flare } alpha = Alpha::Source;
  TransferCurve curve = TransferCurve::Linear;
};

// Writes the window's pixels, and no others. Where no flare is added, the source's samples keep their bits.
void compose(const Composition& what, const RectI& window, const HostImage& output);

}  // namespace contrejour::openfx
