// SPDX-License-Identifier: Apache-2.0
// Draws polygons in the simplest way, pixel by pixel, each clipped to it: the reference for tiles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "contrejour/image.h"
#include "render/polygons/polygon_list.h"

namespace contrejour::test {

using adaptive::LinearIrradiance;
using adaptive::Point;
using adaptive::Polygon;
using adaptive::PolygonList;

using Corners = std::vector<Vec2>;

// The part of a polygon where sign * (coordinate - limit) >= 0.
inline Corners clipped(const Corners& polygon, double Vec2::* coordinate, double limit, double sign) {
  Corners out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k];
    const Vec2 b = polygon[(k + 1) % polygon.size()];
    const double fa = sign * (a.*coordinate - limit);
    const double fb = sign * (b.*coordinate - limit);
    if (fa >= 0.0) out.push_back(a);
    if ((fa >= 0.0) != (fb >= 0.0)) out.push_back(a + (b - a) * (fa / (fa - fb)));
  }
  return out;
}

inline double area_of(const Corners& polygon) {
  double twice = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k) twice += cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
  return 0.5 * std::abs(twice);
}

inline double irradiance_at(const LinearIrradiance& irradiance, std::size_t channel, Vec2 p) {
  return irradiance.value[channel] + (p.x - irradiance.at.x) * static_cast<double>(irradiance.along_x[channel]) +
         (p.y - irradiance.at.y) * static_cast<double>(irradiance.along_y[channel]);
}

// Each pixel receives the polygon's area in it times the irradiance at its centre.
class PlainImage {
 public:
  PlainImage(int width, int height)
      : width_(width), height_(height), values_(static_cast<std::size_t>(3 * width * height)) {}

  // fraction: the transmittance of a polygon's light at a pixel, by channel.
  using Fraction = std::function<std::array<double, 3>(const Polygon& polygon, Vec2 pixel)>;
  void add(const PolygonList& list, const Fraction& fraction = {}) {
    for (const Polygon& p : list.polygons) add(list, p, fraction);
  }

  // The largest difference, relative to the size of the summands.
  [[nodiscard]] double difference(const Image& image) const {
    double worst = 0.0;
    for (std::size_t k = 0; k < values_.size(); ++k) worst = std::max(worst, std::abs(values_[k] - image.pixels[k]));
    return worst / std::max(scale_, 1e-30);
  }
  [[nodiscard]] double scale() const { return scale_; }

 private:
  void add(const PolygonList& list, const Polygon& polygon, const Fraction& passes) {
    const LinearIrradiance& irradiance = list.irradiance_of(polygon);
    Corners corners;
    for (const Point p : list.corners_of(polygon)) corners.push_back({p.x, p.y});
    const auto by_x = std::minmax_element(corners.begin(), corners.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; });
    const auto by_y = std::minmax_element(corners.begin(), corners.end(), [](Vec2 a, Vec2 b) { return a.y < b.y; });
    const auto pixel = [](double v, int largest) {
      return static_cast<int>(std::clamp(std::floor(v), 0.0, largest - 1.0));
    };
    for (int y = pixel(by_y.first->y, height_); y <= pixel(by_y.second->y, height_); ++y) {
      const Corners row = clipped(clipped(corners, &Vec2::y, y, 1.0), &Vec2::y, y + 1, -1.0);
      for (int x = pixel(by_x.first->x, width_); x <= pixel(by_x.second->x, width_); ++x) {
        double fraction = area_of(clipped(clipped(row, &Vec2::x, x, 1.0), &Vec2::x, x + 1, -1.0));
        if (corners.size() == 1) {
          fraction = std::floor(corners[0].x) == x && std::floor(corners[0].y) == y ? 1.0 : 0.0;
        }
        const Vec2 at = corners.size() == 1 ? Vec2{irradiance.at.x, irradiance.at.y} : Vec2{x + 0.5, y + 0.5};
        const auto passed = passes && fraction > 0.0 ? passes(polygon, at) : std::array{1.0, 1.0, 1.0};
        for (std::size_t c = 0; c < 3; ++c) {
          const double value = irradiance_at(irradiance, c, at) * passed[c];
          scale_ = std::max(scale_, std::abs(value));
          values_[static_cast<std::size_t>(3 * (y * width_ + x)) + c] += fraction * value;
        }
      }
    }
  }

  int width_, height_;
  std::vector<double> values_;
  double scale_ = 0.0;
};

class Fuzz {
 public:
  explicit Fuzz(unsigned seed) : random_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * unit_(random_); }

  LinearIrradiance irradiance(Vec2 at) {
    LinearIrradiance s;
    s.at = {static_cast<float>(at.x), static_cast<float>(at.y)};
    for (std::size_t c = 0; c < 3; ++c) {
      s.value[c] = static_cast<float>((*this)(0.1, 2.0));
      s.along_x[c] = static_cast<float>((*this)(-0.05, 0.05));
      s.along_y[c] = static_cast<float>((*this)(-0.05, 0.05));
    }
    return s;
  }

  // An ellipse's polygon, either way round; flat: how much narrower than long. snap: corners on halves of pixels.
  std::vector<Point> ellipse(Vec2 middle, double radius, double flat, bool snap) {
    const double rotation = (*this)(0.0, 6.3);
    const int count = 3 + static_cast<int>((*this)(0.0, 7.0));
    std::vector<Point> corners;
    for (int k = 0; k < count; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / count;
      const Vec2 q{radius * std::cos(angle), radius * flat * std::sin(angle)};
      Vec2 p = middle + Vec2{q.x * std::cos(rotation) - q.y * std::sin(rotation),
                             q.x * std::sin(rotation) + q.y * std::cos(rotation)};
      if (snap) p = {std::round(2.0 * p.x) / 2.0, std::round(2.0 * p.y) / 2.0};
      corners.push_back({static_cast<float>(p.x), static_cast<float>(p.y)});
    }
    if ((*this)(0.0, 1.0) < 0.5) std::reverse(corners.begin(), corners.end());
    return corners;
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

}  // namespace contrejour::test
