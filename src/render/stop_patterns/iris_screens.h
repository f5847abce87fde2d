// SPDX-License-Identifier: Apache-2.0
// Stop patterns of the iris: fringes along its edges, or a pattern of the whole iris. At crossings of the stop before
// the last one the iris is sharp.
#pragma once

#include <memory>

#include "ghosts/iris_shape.h"
#include "render/planning/stop_screen.h"
#include "render/stop_patterns/edge_profile.h"
#include "render/stop_patterns/pattern_texture.h"

namespace contrejour::inline internal::screens {

class IrisScreen : public StopScreen {
 public:
  explicit IrisScreen(std::shared_ptr<const IrisShape> iris) : iris_(std::move(iris)) {}

  [[nodiscard]] double share(std::span<const StopPlace> places) const final;
  [[nodiscard]] const IrisShape& iris() const { return *iris_; }
  [[nodiscard]] double distance(Vec2 p) const;  // from the opening, negative inside; too small beyond a corner

 protected:
  [[nodiscard]] virtual double pattern(const StopPlace& place) const = 0;
  [[nodiscard]] double tone(const StopPlace& place) const;  // half-tone of a picture as the iris; otherwise 1

 private:
  std::shared_ptr<const IrisShape> iris_;
};

// Used for large Fresnel numbers. Each bound of the opening has the fringes of a straight edge. Where two edges meet,
// their factors multiply, which is exact for right angles. Light that one edge diffracts across another is left out.
class EdgeScreen final : public IrisScreen {
 public:
  EdgeScreen(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const EdgeProfile> profile, double fresnel_number);

  [[nodiscard]] double reach() const override;
  [[nodiscard]] ScreenPart over(Vec2 middle, double radius, double tolerance) const override;

  // The factor of one bound at a signed distance from it.
  [[nodiscard]] double edge(double distance, double width) const {
    return profile_->at(-scale_ * distance, width * scale_);
  }
  [[nodiscard]] const EdgeProfile& profile() const { return *profile_; }
  [[nodiscard]] double unit() const { return 1.0 / scale_; }  // of the profile's positions, stop radii

 protected:
  [[nodiscard]] double pattern(const StopPlace& place) const override;

 private:
  std::shared_ptr<const EdgeProfile> profile_;
  double scale_;  // profile positions a stop radius
};

// Half-tones of a picture as the iris, with a sharp outline or with fringes.
class TonedScreen final : public IrisScreen {
 public:
  // edges: null if the outline is sharp.
  TonedScreen(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const EdgeScreen> edges)
      : IrisScreen(std::move(iris)), edges_(std::move(edges)) {}

  [[nodiscard]] double reach() const override;
  [[nodiscard]] ScreenPart over(Vec2 middle, double radius, double tolerance) const override;

 protected:
  [[nodiscard]] double pattern(const StopPlace& place) const override;

 private:
  std::shared_ptr<const EdgeScreen> edges_;
};

// Used for small Fresnel numbers, and for any other pattern.
class TextureScreen final : public IrisScreen {
 public:
  TextureScreen(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const PatternTexture> texture)
      : IrisScreen(std::move(iris)), texture_(std::move(texture)) {}

  [[nodiscard]] double reach() const override;
  [[nodiscard]] ScreenPart over(Vec2 middle, double radius, double tolerance) const override;
  [[nodiscard]] const PatternTexture& texture() const { return *texture_; }

 protected:
  [[nodiscard]] double pattern(const StopPlace& place) const override;

 private:
  std::shared_ptr<const PatternTexture> texture_;
};

}  // namespace contrejour::inline internal::screens
