// SPDX-License-Identifier: Apache-2.0
#include "render/reference/flux_image.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::reference {
namespace {

// A convex polygon of few corners, which is clipped repeatedly; its fixed size avoids heap allocation.
struct Polygon {
  std::array<Vec2, 12> corner;
  int count = 0;

  void add(Vec2 p) { corner[static_cast<std::size_t>(count++)] = p; }
  [[nodiscard]] Vec2 at(int k) const { return corner[static_cast<std::size_t>(k)]; }
};

double area_of(const Polygon& p) {
  double twice = 0.0;
  for (int k = 1; k + 1 < p.count; ++k) twice += cross(p.at(k) - p.at(0), p.at(k + 1) - p.at(0));
  return 0.5 * std::abs(twice);
}

// The part of the polygon on one side of a line parallel to an axis: sign * (coordinate - bound) >= 0.
// Sutherland-Hodgman.
template <double Vec2::* coordinate>
Polygon clipped(const Polygon& p, double bound, double sign) {
  Polygon out;
  for (int k = 0; k < p.count; ++k) {
    const Vec2 a = p.at(k);
    const Vec2 b = p.at(k + 1 == p.count ? 0 : k + 1);
    const double da = sign * (a.*coordinate - bound);
    const double db = sign * (b.*coordinate - bound);
    if (da >= 0.0) out.add(a);
    if ((da < 0.0) != (db < 0.0)) out.add(a + (b - a) * (da / (da - db)));
  }
  return out;
}

struct Bounds {
  Vec2 low, high;
};

Bounds bounds_of(const Polygon& p) {
  Bounds b{p.at(0), p.at(0)};
  for (int k = 1; k < p.count; ++k) {
    b.low = {std::min(b.low.x, p.at(k).x), std::min(b.low.y, p.at(k).y)};
    b.high = {std::max(b.high.x, p.at(k).x), std::max(b.high.y, p.at(k).y)};
  }
  return b;
}

// The first and the last pixel that [low, high] meets in an image with this number of pixels.
struct PixelRange {
  int first, last;
};
PixelRange pixels_between(double low, double high, int count) {
  const double first = std::clamp(std::floor(low), 0.0, static_cast<double>(count));
  const double last = std::clamp(std::floor(high), -1.0, static_cast<double>(count - 1));
  return {static_cast<int>(first), static_cast<int>(last)};
}

// If a polygon's area is below this fraction of its extent squared, it is mostly rounding error.
constexpr double kSliver = 1e-9;
constexpr int kSliverSamplesPerPixel = 8;

}  // namespace

FluxImage::FluxImage(int width, int height)
    : width_(width), height_(height), first_row_(height), last_row_(-1),
      flux_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

void FluxImage::add_pixel(int x, int y, double flux) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  first_row_ = std::min(first_row_, y);
  last_row_ = std::max(last_row_, y);
  flux_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] += flux;
}

void FluxImage::add_polygon(std::span<const Vec2> corners, double flux) {
  Polygon whole;
  for (const Vec2 p : corners) whole.add(p);
  const Bounds bounds = bounds_of(whole);
  const PixelRange rows = pixels_between(bounds.low.y, bounds.high.y, height_);
  const PixelRange columns = pixels_between(bounds.low.x, bounds.high.x, width_);
  if (rows.first > rows.last || columns.first > columns.last) return;
  if (std::floor(bounds.low.x) == std::floor(bounds.high.x) && std::floor(bounds.low.y) == std::floor(bounds.high.y)) {
    add_pixel(columns.first, rows.first, flux);
    return;
  }
  const double area = area_of(whole);
  const Vec2 extent = bounds.high - bounds.low;
  if (area <= kSliver * dot(extent, extent)) {
    add_sliver(corners, flux);
    return;
  }
  for (int y = rows.first; y <= rows.last; ++y) {
    const Polygon strip = clipped<&Vec2::y>(clipped<&Vec2::y>(whole, y, 1.0), y + 1.0, -1.0);
    if (strip.count < 3) continue;
    const Bounds in_row = bounds_of(strip);
    const PixelRange covered = pixels_between(in_row.low.x, in_row.high.x, width_);
    for (int x = covered.first; x <= covered.last; ++x) {
      const Polygon cell = clipped<&Vec2::x>(clipped<&Vec2::x>(strip, x, 1.0), x + 1.0, -1.0);
      if (cell.count >= 3) add_pixel(x, y, flux * area_of(cell) / area);
    }
  }
}

// Spreads the flux over evenly spaced points from the farthest corner of a flat polygon to the opposite end.
void FluxImage::add_sliver(std::span<const Vec2> corners, double flux) {
  Vec2 from = corners[0];
  Vec2 to = corners[0];
  for (const Vec2 a : corners) {
    for (const Vec2 b : corners) {
      if (length(b - a) > length(to - from)) from = a, to = b;
    }
  }
  const int samples = 1 + static_cast<int>(kSliverSamplesPerPixel * std::min(length(to - from), 1e6));
  for (int k = 0; k < samples; ++k) {
    const Vec2 p = from + (to - from) * ((k + 0.5) / samples);
    add_pixel(static_cast<int>(std::floor(std::clamp(p.x, -1.0, static_cast<double>(width_)))),
              static_cast<int>(std::floor(std::clamp(p.y, -1.0, static_cast<double>(height_)))), flux / samples);
  }
}

void FluxImage::add_to(std::vector<double>& rgb, const std::array<double, 3>& gain) const {
  for (int y = first_row_; y <= last_row_; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (std::size_t i = row; i < row + static_cast<std::size_t>(width_); ++i) {
      for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] += gain[c] * flux_[i];
    }
  }
}

}  // namespace contrejour::inline internal::reference
