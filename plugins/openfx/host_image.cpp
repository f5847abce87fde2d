// SPDX-License-Identifier: Apache-2.0
#include "openfx/host_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <half.h>

namespace contrejour::openfx {
namespace {

constexpr std::size_t kColours = 3;

// Samples need not be aligned.
template <class Sample>
float load(const std::byte* from) {
  Sample sample;
  std::memcpy(&sample, from, sizeof sample);
  return static_cast<float>(sample);
}

template <class Sample>
void store(float value, std::byte* to) {
  constexpr float kLargestHalf = 65504.0F;
  if constexpr (sizeof(Sample) == 2) value = std::clamp(value, -kLargestHalf, kLargestHalf);  // a NaN stays one
  const Sample sample(value);
  std::memcpy(to, &sample, sizeof sample);
}

// The row of a region's image in which the host's row y is.
int row_of(const PixelWindow& region, int y) { return -1 - y - region.y; }

template <class Sample>
void decode_row(const HostImage& source, int y, const PixelWindow& region, TransferCurve curve, Image& image) {
  const RectI bounds = source.bounds();
  const int first = std::max(bounds.x1, region.x), last = std::min(bounds.x2, region.x + region.width);
  if (first >= last) return;
  const std::byte* from = source.row(y) + (first - bounds.x1) * source.pixel_bytes();
  float* to = &image.at(first - region.x, row_of(region, y));
  for (int x = first; x < last; ++x, from += source.pixel_bytes(), to += kColours)
    for (std::size_t c = 0; c < kColours; ++c) {
      const float sample = load<Sample>(from + c * sizeof(Sample));
      to[c] = curve == TransferCurve::Linear ? sample : static_cast<float>(linear_from(sample, curve));
    }
}

// One row of the output, from x1 on. Pointers are null where a row has no source or no flare.
template <class Sample>
class RowWriter {
 public:
  RowWriter(const Composition& what, const HostImage& output, int y) : what_(what), output_(output) {
    if (what.source != nullptr && what.source->contains_row(y)) source_ = what.source->row(y);
    const int row = row_of(what.region, y);
    if (what.flare != nullptr && row >= 0 && row < what.region.height) flare_ = what.flare->row(row).data();
    to_ = output.row(y);
  }

  void write(int first, int last) const {
    for (int x = first; x < last; ++x) write_pixel(x);
  }

 private:
  [[nodiscard]] const std::byte* source_pixel(int x) const {
    if (source_ == nullptr) return nullptr;
    const RectI bounds = what_.source->bounds();
    return x >= bounds.x1 && x < bounds.x2 ? source_ + (x - bounds.x1) * what_.source->pixel_bytes() : nullptr;
  }

  [[nodiscard]] const float* flare_pixel(int x) const {
    const int column = x - what_.region.x;
    if (flare_ == nullptr || column < 0 || column >= what_.region.width) return nullptr;
    return flare_ + kColours * static_cast<std::size_t>(column);
  }

  void write_pixel(int x) const {
    const std::byte* const source = source_pixel(x);
    const float* const flare = flare_pixel(x);
    std::byte* const to = to_ + (x - output_.bounds().x1) * output_.pixel_bytes();
    for (std::size_t c = 0; c < kColours; ++c) write_colour(source, flare, c, to + c * sizeof(Sample));
    if (output_.channels() > 3) write_alpha(source, flare, to + kColours * sizeof(Sample));
  }

  // As add_flare(): a flare never subtracts, and what is not finite stays.
  void write_colour(const std::byte* source, const float* flare, std::size_t c, std::byte* to) const {
    const float added = flare != nullptr ? flare[c] : 0.0F;
    if (!what_.shows_source) return store<Sample>(encoded(added), to);
    if (source == nullptr) return store<Sample>(encoded(std::max(added, 0.0F)), to);
    source += c * sizeof(Sample);
    const float sample = load<Sample>(source);
    if (!(added > 0.0F) || !std::isfinite(sample)) {
      std::memcpy(to, source, sizeof(Sample));
    } else if (what_.curve == TransferCurve::Linear) {
      store<Sample>(sample + added, to);
    } else {
      store<Sample>(encoded(linear_from(sample, what_.curve) + static_cast<double>(added)), to);
    }
  }

  void write_alpha(const std::byte* source, const float* flare, std::byte* to) const {
    switch (what_.alpha) {
      case Composition::Alpha::Zero: return store<Sample>(0.0F, to);
      case Composition::Alpha::Flare: {
        const float most = flare != nullptr ? std::max({flare[0], flare[1], flare[2]}) : 0.0F;
        return store<Sample>(std::clamp(most, 0.0F, 1.0F), to);
      }
      case Composition::Alpha::Source: break;
    }
    if (source != nullptr && what_.source->channels() > 3) {
      std::memcpy(to, source + kColours * sizeof(Sample), sizeof(Sample));
    } else {
      store<Sample>(source != nullptr || what_.source == nullptr ? 1.0F : 0.0F, to);
    }
  }

  [[nodiscard]] float encoded(double linear) const {
    return static_cast<float>(what_.curve == TransferCurve::Linear ? linear : coded_from(linear, what_.curve));
  }

  const Composition& what_;
  const HostImage& output_;
  const std::byte* source_ = nullptr;
  const float* flare_ = nullptr;
  std::byte* to_ = nullptr;
};

std::optional<Depth> depth_of(const std::string& name) {
  if (name == value::kFloat) return Depth::Float;
  if (name == value::kHalf) return Depth::Half;
  return std::nullopt;
}

int channels_of(const std::string& name) { return name == value::kRgba ? 4 : name == value::kRgb ? 3 : 0; }

}  // namespace

HostImage::HostImage(const Host& host, PropertySetHandle image)
    : host_(&host), properties_(host.of(image)), data_(static_cast<std::byte*>(properties_.pointer(name::kImageData))),
      bounds_(properties_.rectangle(name::kImageBounds).value_or(RectI{})),
      row_bytes_(properties_.integer(name::kImageRowBytes).value_or(0)),
      depth_(depth_of(properties_.text(name::kPixelDepth).value_or(""))),
      channels_(channels_of(properties_.text(name::kComponents).value_or(""))) {}

std::optional<HostImage> HostImage::fetch(const Host& host, ClipHandle clip, Time time) {
  PropertySetHandle image = nullptr;
  if (clip == nullptr || host.effects->clip_get_image(clip, time, nullptr, &image) != status::kOk || image == nullptr)
    return std::nullopt;
  return HostImage(host, image);
}

HostImage::HostImage(HostImage&& other) noexcept
    : host_(other.host_), properties_(std::exchange(other.properties_, {})), data_(other.data_), bounds_(other.bounds_),
      row_bytes_(other.row_bytes_), depth_(other.depth_), channels_(other.channels_) {}

HostImage::~HostImage() {
  if (properties_) host_->effects->clip_release_image(properties_.handle());
}

std::ptrdiff_t HostImage::pixel_bytes() const {
  return channels_ * static_cast<std::ptrdiff_t>(depth() == Depth::Half ? sizeof(half) : sizeof(float));
}

Result<void> HostImage::check() const {
  if (!depth_ || channels_ == 0)
    return invalid_argument("the host gave an image that is not RGB or RGBA in float or half; convert it to float");
  const std::ptrdiff_t width = static_cast<std::ptrdiff_t>(bounds_.x2) - bounds_.x1;
  if (data_ == nullptr || width < 1 || bounds_.y2 <= bounds_.y1)
    return invalid_argument("the host gave an image without pixels");
  if (bounds_.y2 - bounds_.y1 > 1 && std::abs(row_bytes_) < width * pixel_bytes())
    return invalid_argument(fmt::format("the host gave an image whose rows of {} pixels are {} bytes apart and overlap",
                                        width, row_bytes_));
  return {};
}

Image decoded_region(const HostImage& source, const PixelWindow& region, TransferCurve curve) {
  Image image(region.width, region.height);
  const RectI bounds = source.bounds();
  const int top = -region.y;  // the host's row above the region
  for (int y = std::max(bounds.y1, top - region.height); y < std::min(bounds.y2, top); ++y)
    (source.depth() == Depth::Half ? decode_row<half> : decode_row<float>)(source, y, region, curve, image);
  return image;
}

void compose(const Composition& what, const RectI& window, const HostImage& output) {
  const RectI bounds = output.bounds();
  const int first = std::max(window.x1, bounds.x1), last = std::min(window.x2, bounds.x2);
  for (int y = std::max(window.y1, bounds.y1); y < std::min(window.y2, bounds.y2); ++y) {
    if (output.depth() == Depth::Half)
      RowWriter<half>(what, output, y).write(first, last);
    else
      RowWriter<float>(what, output, y).write(first, last);
  }
}

}  // namespace contrejour::openfx
