// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/pixel_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kRounding_px = 0.01;  // by which a rasteriser may misplace an edge

// The lowest and the highest x of a polygon between two rows' borders; low > high if there is nothing of it.
struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  Extent(std::span<const Point> polygon, double top, double bottom) {
    for (std::size_t k = 0; k < polygon.size(); ++k)
      add(polygon[k], polygon[k + 1 == polygon.size() ? 0 : k + 1], top, bottom);
  }

 private:
  void add(Point a, Point b, double top, double bottom) {
    if (a.y > b.y) std::swap(a, b);
    const double ax = a.x, ay = a.y, bx = b.x, by = b.y;
    if (by < top || ay > bottom) return;
    const auto x_at = [&](double y) {
      return by > ay ? ax + (bx - ax) * std::clamp((y - ay) / (by - ay), 0.0, 1.0) : ax;
    };
    const double first = x_at(std::max(ay, top)), last = by > ay ? x_at(std::min(by, bottom)) : bx;
    low = std::min({low, first, last});
    high = std::max({high, first, last});
  }
};

// The mean of the samples of a pixel, in floats.
std::array<float, 3> mean_of(Vec2 corner, int samples, const TransmittanceAt& transmittance_at) {
  std::array<float, 3> mean{};
  const float weight = 1.0F / static_cast<float>(samples * samples);
  const auto middle = [&](int part) { return (part + 0.5) / samples - 0.5; };
  for (int part = 0; part < samples * samples; ++part) {
    const Vec2 in_pixel = Vec2{0.5, 0.5} + Vec2{middle(part % samples), middle(part / samples)};
    const auto one = transmittance_at(corner + in_pixel);
    for (std::size_t c = 0; c < 3; ++c) mean[c] = std::fma(static_cast<float>(one[c]), weight, mean[c]);
  }
  return mean;
}

}  // namespace

Pattern pixel_pattern(std::span<const Point> polygon, int width, int height, int samples,
                      const TransmittanceAt& transmittance_at, PolygonList& list) {
  const auto [above, below] = std::ranges::minmax(polygon, {}, &Point::y);
  const auto row = [&](float y) { return static_cast<int>(std::clamp(y, 0.0F, static_cast<float>(height - 1))); };
  const auto column = [&](double x) { return static_cast<int>(std::clamp(std::floor(x), -1.0, width + 0.0)); };
  Pattern pattern{.kind = PatternKind::Pixels, .first = static_cast<std::uint32_t>(list.spans.size())};
  for (int y = row(above.y); y <= row(below.y); ++y) {
    const Extent extent(polygon, y, y + 1.0);
    PixelSpan span{0, y, static_cast<std::uint32_t>(list.pixels.size()), 0};
    if (extent.low <= extent.high) {
      span.x = std::max(column(extent.low - kRounding_px), 0);
      span.count =
          static_cast<std::uint32_t>(std::max(std::min(column(extent.high + kRounding_px), width - 1) - span.x + 1, 0));
    }
    for (std::uint32_t k = 0; k < span.count; ++k)
      list.pixels.push_back(mean_of({span.x + 0.0 + k, y + 0.0}, samples, transmittance_at));
    list.spans.push_back(span);
  }
  pattern.count = static_cast<std::uint32_t>(list.spans.size()) - pattern.first;
  return pattern;
}

}  // namespace contrejour::inline internal::adaptive
