// SPDX-License-Identifier: Apache-2.0
// The stop pattern of one ghost at one wavelength: the transmittance that takes the place of the sharp iris at the last
// crossing of the stop. There are three kinds: fringes along the edges of the iris, a pattern of the whole iris, and
// half-tones of a picture as the iris. At earlier crossings the iris is sharp. Rims still block.
// Units: stop radii. Thread-safety: a value; const members may run at once.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <variant>

#include "ghosts/iris_shape.h"
#include "render/stop_patterns/edge_profile.h"
#include "render/stop_patterns/pattern_texture.h"

namespace contrejour::inline internal {

// A point at which light crosses the stop, and the side of the square about it over which the mean is taken (the image
// of a pixel in the stop plane), in stop radii.
struct StopPoint {
  Vec2 at;
  double width = 0.0;
};

// What a pattern is all over a disc of the stop plane.
enum class PatternRegion { Dark, Uniform, Varying };  // all 0; 1 within the tolerance; neither

namespace stop_patterns {

// The fringes of straight edges, for large Fresnel numbers: one for each bound of the opening. Where two edges meet,
// their factors multiply, which is exact for right angles. Light that one edge diffracts across another is left out.
class EdgePattern {
 public:
  EdgePattern(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const EdgeProfile> profile, double fresnel_number);

  [[nodiscard]] double outer_radius() const { return 1.0 - EdgeProfile::kDarkBelow / scale_; }
  [[nodiscard]] double transmittance(const StopPoint& point) const;
  [[nodiscard]] PatternRegion region(Vec2 middle, double radius, double tolerance) const;

  // The factor of one bound at a signed distance from it.
  [[nodiscard]] double edge(double distance, double width) const {
    return profile_->at(-scale_ * distance, width * scale_);
  }
  [[nodiscard]] double distance(Vec2 p) const;  // from the opening, negative inside; too small beyond a corner
  [[nodiscard]] const IrisShape& iris() const { return *iris_; }
  [[nodiscard]] const EdgeProfile& profile() const { return *profile_; }
  [[nodiscard]] double fringe_unit() const { return 1.0 / scale_; }  // of the profile's positions, stop radii

 private:
  std::shared_ptr<const IrisShape> iris_;
  std::shared_ptr<const EdgeProfile> profile_;
  double scale_;  // profile positions a stop radius
};

// A diffraction pattern of the whole iris, for small Fresnel numbers and for fractional orders.
class TexturePattern {
 public:
  explicit TexturePattern(std::shared_ptr<const PatternTexture> texture) : texture_(std::move(texture)) {}

  [[nodiscard]] double outer_radius() const { return texture_->extent(); }
  [[nodiscard]] double transmittance(const StopPoint& point) const { return texture_->at(point.at, point.width); }
  [[nodiscard]] PatternRegion region(Vec2 middle, double radius, double tolerance) const;

  [[nodiscard]] const PatternTexture& texture() const { return *texture_; }

 private:
  std::shared_ptr<const PatternTexture> texture_;
};

// Half-tones of a picture as the iris, with a sharp outline or with fringes.
class TonedPattern {
 public:
  // edges: null if the outline is sharp.
  TonedPattern(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const EdgePattern> edges)
      : iris_(std::move(iris)), edges_(std::move(edges)) {}

  [[nodiscard]] double outer_radius() const;
  [[nodiscard]] double transmittance(const StopPoint& point) const;
  [[nodiscard]] PatternRegion region(Vec2 middle, double radius, double tolerance) const;
  [[nodiscard]] const EdgePattern* edges() const { return edges_.get(); }  // null if the outline is sharp

 private:
  std::shared_ptr<const IrisShape> iris_;
  std::shared_ptr<const EdgePattern> edges_;
};

}  // namespace stop_patterns

class StopPattern {
 public:
  using Kind = std::variant<stop_patterns::EdgePattern, stop_patterns::TexturePattern, stop_patterns::TonedPattern>;

  StopPattern(std::shared_ptr<const IrisShape> iris, Kind kind) : iris_(std::move(iris)), kind_(std::move(kind)) {}

  // No light passes farther from the axis than this; at least 1.
  [[nodiscard]] double outer_radius() const;

  // The mean transmittance over the squares of the points: at least 0, and above 1 on bright fringes. points: one for
  // each crossing of the stop, in the order of the path.
  [[nodiscard]] double transmittance(std::span<const StopPoint> points) const;

  // What the pattern is over a disc at the last crossing; tolerance: the deviation from 1 that still counts as uniform.
  [[nodiscard]] PatternRegion region(Vec2 middle, double radius, double tolerance) const;

  // The pattern's kind; null if it is of another one.
  [[nodiscard]] const stop_patterns::EdgePattern* edges() const {
    return std::get_if<stop_patterns::EdgePattern>(&kind_);
  }
  [[nodiscard]] const stop_patterns::PatternTexture* texture() const {
    const auto* const pattern = std::get_if<stop_patterns::TexturePattern>(&kind_);
    return pattern != nullptr ? &pattern->texture() : nullptr;
  }
  [[nodiscard]] const stop_patterns::TonedPattern* toned() const {
    return std::get_if<stop_patterns::TonedPattern>(&kind_);
  }

 private:
  std::shared_ptr<const IrisShape> iris_;
  Kind kind_;
};

}  // namespace contrejour::inline internal
