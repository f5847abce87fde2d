// SPDX-License-Identifier: Apache-2.0
// A convex polygon of the frame whose corners have positions in the stop, along which straight lines cut it.
// Units: pixels, stop radii. Thread-safety: a value.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "render/adaptive/cells/stop_map.h"
#include "render/adaptive/clip/polygon_clipper.h"

namespace contrejour::inline internal::adaptive {

struct PlacedCorner {
  Vec2 position, uv;  // as of a Corner
  Vec2 stop;
};

struct HalfPlane {  // normal . p <= most, in the stop
  Vec2 normal;
  double distance = 0.0;
  [[nodiscard]] double beyond(const PlacedCorner& c) const { return dot(normal, c.stop) - distance; }
};

class PlacedPolygon {
 public:
  void assign(std::span<const Corner> polygon, const StopMap& map) {
    corners_.clear();
    for (const Corner& c : polygon) corners_.push_back({c.position, c.uv, map.stop_point(c.position)});
  }
  void take(const PlacedPolygon& other) { corners_.assign(other.corners_.begin(), other.corners_.end()); }
  [[nodiscard]] std::span<const PlacedCorner> corners() const { return corners_; }
  [[nodiscard]] bool is_empty() const { return corners_.size() < 3; }

  void keep_within(const HalfPlane& kept, const StopMap& map) {
    const auto within = [&](const PlacedCorner& c) { return kept.beyond(c) <= 0.0; };
    if (std::all_of(corners_.begin(), corners_.end(), within)) return;
    before_.swap(corners_);
    corners_.clear();
    for (std::size_t k = 0; k < before_.size(); ++k) {
      const PlacedCorner& a = before_[k];
      const PlacedCorner& b = before_[k + 1 == before_.size() ? 0 : k + 1];
      const double fa = kept.beyond(a), fb = kept.beyond(b);
      if (fa <= 0.0) corners_.push_back(a);
      if ((fa <= 0.0) == (fb <= 0.0)) continue;
      const double t = fa / (fa - fb);
      const Vec2 position = a.position + (b.position - a.position) * t;
      corners_.push_back({position, a.uv + (b.uv - a.uv) * t, map.stop_point(position)});
    }
  }

 private:
  std::vector<PlacedCorner> corners_, before_;
};

}  // namespace contrejour::inline internal::adaptive
