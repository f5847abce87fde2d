// Screens that stand for the iris: its edges' fringes, or a pattern of all of it. At crossings of the stop before the
// last one the iris is sharp.
#pragma once

#include <memory>

#include "ghosts/iris_shape.h"
#include "render/interface/stop_screen.h"
#include "render/screens/edge_profile.h"
#include "render/screens/pattern_texture.h"

namespace contrejour::screens {

class IrisScreen : public StopScreen {
 public:
  explicit IrisScreen(std::shared_ptr<const IrisShape> iris) : iris_(std::move(iris)) {}

  [[nodiscard]] double share(std::span<const StopPlace> places) const final;
  [[nodiscard]] const IrisShape& iris() const { return *iris_; }
  [[nodiscard]] double distance(Vec2 p) const;  // from the opening, negative inside; less than that beyond a corner

 protected:
  [[nodiscard]] virtual double pattern(const StopPlace& place) const = 0;
  [[nodiscard]] double tone(const StopPlace& place) const;  // of a picture's half-tones; else 1

 private:
  std::shared_ptr<const IrisShape> iris_;
};

// For large Fresnel numbers: each bound of the opening has the fringes of a straight edge along it, where two meet they
// multiply, which is exact for right angles. What one edge sends across to another is left out.
class EdgeScreen final : public IrisScreen {
 public:
  EdgeScreen(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const EdgeProfile> profile, double fresnel_number);

  [[nodiscard]] double reach() const override;
  [[nodiscard]] ScreenPart over(Vec2 middle, double radius, double tolerance) const override;

  // The factor that one bound brings at a signed distance from it.
  [[nodiscard]] double edge(double distance, double width) const {
    return profile_->at(-scale_ * distance, width * scale_);
  }
  [[nodiscard]] const EdgeProfile& profile() const { return *profile_; }
  [[nodiscard]] double unit() const { return 1.0 / scale_; }  // of the profile's places, stop radii

 protected:
  [[nodiscard]] double pattern(const StopPlace& place) const override;

 private:
  std::shared_ptr<const EdgeProfile> profile_;
  double scale_;  // of the profile's places over stop radii
};

// Half-tones of a picture as the iris, whose outline is sharp or brings fringes.
class TonedScreen final : public IrisScreen {
 public:
  // edges: null where the outline is sharp.
  TonedScreen(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const EdgeScreen> edges)
      : IrisScreen(std::move(iris)), edges_(std::move(edges)) {}

  [[nodiscard]] double reach() const override;
  [[nodiscard]] ScreenPart over(Vec2 middle, double radius, double tolerance) const override;

 protected:
  [[nodiscard]] double pattern(const StopPlace& place) const override;

 private:
  std::shared_ptr<const EdgeScreen> edges_;
};

// For small Fresnel numbers, and for any other pattern.
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

}  // namespace contrejour::screens
