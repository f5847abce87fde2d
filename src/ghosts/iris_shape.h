// SPDX-License-Identifier: Apache-2.0
// The iris as functions of the stop coordinates that are <= 0 where a ray passes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "contrejour/expert/iris_field.h"

namespace contrejour::inline internal {

// The iris opening as the circles and half-planes that its outline lies on: the rim where it bounds the opening, then
// the blades in order. The opening is their intersection, which is convex; the largest of their distances is
// iris_distance() inside and near the opening.
// A picture's opening is not convex: its bounds are those of its hull, its distances are those of its field, and
// polygons are clipped to it piece by piece.
class IrisShape {
 public:
  explicit IrisShape(const Iris& iris);

  [[nodiscard]] const std::vector<IrisBound>& bounds() const { return bounds_; }
  [[nodiscard]] bool is_circle() const { return is_circle_; }  // of radius 1 about the axis
  [[nodiscard]] bool is_picture() const { return field_ != nullptr; }
  [[nodiscard]] IrisShape hull() const;  // convex, for searches
  [[nodiscard]] const IrisField* picture() const { return field_.get(); }  // null unless the iris is one
  // A point of the stop in the picture's own orientation.
  [[nodiscard]] Vec2 picture_from_stop(Vec2 p) const {
    return {cosine_ * p.x + sine_ * p.y, cosine_ * p.y - sine_ * p.x};
  }

  // Signed distances of many points of the stop plane, in stop radii.
  void distances(const float* x, const float* y, std::size_t count, float* out) const;
  [[nodiscard]] double picture_distance(Vec2 p) const { return field_->distance(picture_from_stop(p)); }
  // The transmittance of a picture with half-tones, as the mean over a square (IrisField).
  [[nodiscard]] bool has_half_tones() const { return field_ != nullptr && field_->has_half_tones(); }
  [[nodiscard]] double picture_transmittance(Vec2 p, double width) const {
    return field_->transmittance(picture_from_stop(p), width);
  }

  // Calls visit(std::span<const IrisBound> half_planes, double open) for the pieces of a picture that may overlap a
  // box: the intersection of the half-planes, and the transmittance there (IrisField::for_each_piece).
  template <class Visit>
  void for_each_piece(Vec2 low, Vec2 high, double detail, const Visit& visit) const {
    const Vec2 middle = picture_from_stop((low + high) * 0.5);
    const Vec2 half = (high - low) * 0.5;
    const double c = std::abs(cosine_);
    const double s = std::abs(sine_);
    const Vec2 reach{c * half.x + s * half.y, s * half.x + c * half.y};
    field_->for_each_piece(middle - reach, middle + reach, detail, [&](const IrisPiece& piece) {
      const auto [half_planes, count] = half_planes_of(piece);
      visit(std::span<const IrisBound>(half_planes.data(), count), piece.open);
    });
  }

 private:
  IrisShape() = default;
  [[nodiscard]] IrisBound in_stop(IrisBound half_plane) const {
    const Vec2 n = half_plane.normal;
    half_plane.normal = {cosine_ * n.x - sine_ * n.y, sine_ * n.x + cosine_ * n.y};
    return half_plane;
  }
  [[nodiscard]] std::pair<std::array<IrisBound, 6>, std::size_t> half_planes_of(const IrisPiece& piece) const;

  std::vector<IrisBound> bounds_;  // never empty
  bool is_circle_ = false;
  std::shared_ptr<const IrisField> field_;
  double cosine_ = 1.0, sine_ = 0.0;  // of the picture's rotation
};

}  // namespace contrejour::inline internal
