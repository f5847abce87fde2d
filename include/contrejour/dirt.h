// Dust and scratches: what lies on the lens and blocks light, as shapes in a plane's own millimetres.
// Statistics and a seed in, shapes out: each place of the plane has its own, whatever part of the plane is asked for,
// so that dirt stays where it is when the lens is stopped down or zoomed, and more of it only adds to what was there.
// Seeds give the same dirt on every platform: SplitMix64 (Steele, Lea & Flood 2014) over integers, no std distribution.
// Units: mm, radians; x right, y up as the photographer sees the plane, the axis at (0, 0). Accuracy: polygons to a
// 50th of a stroke's width. Errors: InvalidArgument for numbers out of range. Thread-safety: plain values.
// Source: hullin2011 5 (density, orientation, length, size), docs/physics/diffraction.md.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/result.h"
#include "contrejour/vec.h"

namespace contrejour {

// Any picture as dirt: white is clean. Its longer side spans the clear diameter of the plane it lies in; beside it the
// plane is clean.
class DirtPicture {
 public:
  // level: of width x height pixels, rows from the top, as shares of light that pass, 1 and more: all.
  // Errors: no pixels, levels that are negative or not finite.
  [[nodiscard]] static Result<std::shared_ptr<const DirtPicture>> from_levels(std::span<const float> level, int width,
                                                                              int height);

  // Share of light that passes at a place in clear radii, bilinear between pixels.
  [[nodiscard]] double transmission(Vec2 place) const;
  [[nodiscard]] double pixel() const { return 2.0 / static_cast<double>(longer_); }  // side of one, in clear radii

 private:
  int width_ = 0, height_ = 0, longer_ = 1;
  std::vector<float> level_;
};

enum class DirtPlane {
  Stop,  // in the plane of the aperture stop
  Front,  // in the plane of the first vertex, as on a filter: its shadow moves over the pupil with the light
};

struct Dirt {
  double dust_per_cm2 = 0.0;  // specks, 0 to kMostDustPerCm2
  double dust_mm = 0.05;  // their median diameter; log-normal, standard deviation kSizeSpread of the logarithm
  double scratches_per_cm2 = 0.0;  // counted by their middles, 0 to kMostScratchesPerCm2
  double scratch_length_mm = 5.0;  // median, as of dust
  double scratch_width_mm = 0.01;  // median, as of dust
  double scratch_angle_rad = 0.0;  // along the scratch, counter-clockwise from +x
  double scratch_spread_rad = 1.5707963267948966;  // evenly up to so much to either side; a quarter turn: any direction
  double scratch_bend_rad = 0.2;  // a scratch turns by up to so much from end to end, either way
  double opacity = 1.0;  // of shapes, 0 to 1
  DirtPlane plane = DirtPlane::Stop;
  std::uint32_t seed = 0;
  double time = 0.0;  // in turns: at every whole number all is where it was; shapes wander smoothly between
  double drift_mm = 0.5;  // how far, about
  std::shared_ptr<const DirtPicture> picture = nullptr;  // besides all shapes

  static constexpr double kSizeSpread = 0.4;
  static constexpr double kMostDustPerCm2 = 1000.0, kMostScratchesPerCm2 = 100.0;
  static constexpr double kLongest_mm = 100.0, kWidest_mm = 10.0, kFarthestDrift_mm = 10.0;

  [[nodiscard]] bool has_shapes() const { return (dust_per_cm2 > 0.0 || scratches_per_cm2 > 0.0) && opacity > 0.0; }
  [[nodiscard]] bool any() const { return has_shapes() || picture != nullptr; }
  friend bool operator==(const Dirt&, const Dirt&) = default;
};

// A speck (length 0 or as short as it is wide) or a scratch: all within half a width of an arc or straight line.
struct DirtStroke {
  Vec2 middle_mm;
  double angle_rad = 0;  // of the line there
  double length_mm = 0, width_mm = 0;
  double bend_rad = 0;  // the line turns by so much, counter-clockwise, from one end to the other
  double opacity = 1;

  [[nodiscard]] Vec2 at(double share) const;  // of the line, -1/2 to 1/2
  [[nodiscard]] Vec2 normal_at(double share) const;  // unit, to the left
  [[nodiscard]] double reach_mm() const { return 0.5 * (length_mm + width_mm); }  // nothing is farther from the middle
  [[nodiscard]] double distance_mm(Vec2 place_mm) const;  // from its edge, negative inside
  // x: along its line, or the circle or straight line that it goes on as, from its middle; y: from that to the left.
  [[nodiscard]] Vec2 along_and_across_mm(Vec2 place_mm) const;
};

[[nodiscard]] Result<void> check_dirt(const Dirt& dirt);

// The shapes that may meet a box, in an order that does not depend on the box.
[[nodiscard]] std::vector<DirtStroke> dirt_within(const Dirt& dirt, Vec2 low_mm, Vec2 high_mm);

// A stroke's outline, counter-clockwise; `low` to `high`: of its line, -1/2 to 1/2. Round ends where it ends itself.
[[nodiscard]] std::vector<Vec2> dirt_outline(const DirtStroke& stroke, double low = -0.5, double high = 0.5);

}  // namespace contrejour
