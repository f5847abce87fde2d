// SPDX-License-Identifier: Apache-2.0
// Dust and scratches: what lies on the lens and blocks light, as shapes in a plane's own millimetres.
// Shapes are computed from statistics and a seed. Each part of the plane has its own shapes, whatever box is requested,
// so dirt stays where it is when the lens is stopped down or zoomed, and a higher density only adds shapes. Seeds give
// the same dirt on every platform: SplitMix64 (Steele, Lea & Flood 2014) over integers, no std distribution. Units: mm,
// radians; x right, y up as the photographer sees the plane, the axis at (0, 0). Accuracy: polygons to a 50th of a
// stroke's width. Errors: InvalidArgument for numbers out of range. Thread-safety: plain values.
// Source: hullin2011 5 (density, orientation, length, size), docs/physics/diffraction.md.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

// A picture as dirt: white is clean. Its longer side spans the clear diameter of the plane it lies in; outside the
// picture the plane is clean.
class CONTREJOUR_API DirtPicture {
 public:
  // level: the transmittance of width x height pixels, rows from the top; 1 and more transmits everything.
  // Errors: no pixels, levels that are negative or not finite.
  [[nodiscard]] static Result<std::shared_ptr<const DirtPicture>> from_levels(std::span<const float> level, int width,
                                                                              int height);

  // Transmittance at a point in clear radii, bilinear between pixels.
  [[nodiscard]] double transmission(Vec2 point) const;
  [[nodiscard]] double pixel() const { return 2.0 / static_cast<double>(longer_); }  // side of a pixel in clear radii
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  // Transmittances of the pixels, 0 to 1, rows from the top.
  [[nodiscard]] std::span<const float> levels() const { return level_; }

 private:
  int width_ = 0, height_ = 0, longer_ = 1;
  std::vector<float> level_;
};

enum class DirtPlane {
  Stop,  // in the plane of the aperture stop
  Front,  // in the plane of the first vertex, as on a filter: its shadow moves over the pupil with the light
};

struct Dirt {
  double dust_per_cm2 = 0.0;  // number of specks, 0 to kMaxDustPerCm2
  double dust_mm = 0.05;  // median diameter of specks; log-normal, standard deviation kSizeSpread of the logarithm
  double scratches_per_cm2 = 0.0;  // counted by their middles, 0 to kMaxScratchesPerCm2
  double scratch_length_mm = 5.0;  // median, as of dust
  double scratch_width_mm = 0.01;  // median, as of dust
  double scratch_angle_rad = 0.0;  // along the scratch, counter-clockwise from +x
  double scratch_spread_rad = 1.5707963267948966;  // uniform up to this angle to either side; pi / 2: any direction
  double scratch_bend_rad = 0.2;  // largest change of direction from end to end, either way
  double opacity = 1.0;  // of shapes, 0 to 1
  DirtPlane plane = DirtPlane::Stop;
  std::uint32_t seed = 0;
  double phase = 0.0;  // in periods: shapes move smoothly and are back at every whole number
  double drift_mm = 0.5;  // typical distance of that motion
  std::shared_ptr<const DirtPicture> picture = nullptr;  // in addition to all shapes

  static constexpr double kSizeSpread = 0.4;
  static constexpr double kMaxDustPerCm2 = 1000.0, kMaxScratchesPerCm2 = 100.0;
  static constexpr double kLongest_mm = 100.0, kWidest_mm = 10.0, kFarthestDrift_mm = 10.0;

  [[nodiscard]] bool has_shapes() const { return (dust_per_cm2 > 0.0 || scratches_per_cm2 > 0.0) && opacity > 0.0; }
  [[nodiscard]] bool any() const { return has_shapes() || picture != nullptr; }
  friend bool operator==(const Dirt&, const Dirt&) = default;
};

// A speck (length 0 to about its width) or a scratch: all points within half a width of an arc or straight line.
struct CONTREJOUR_API DirtStroke {
  Vec2 middle_mm;
  double angle_rad = 0;  // of the line at its middle
  double length_mm = 0, width_mm = 0;
  double bend_rad = 0;  // change of the line's direction from end to end, counter-clockwise
  double opacity = 1;

  [[nodiscard]] Vec2 at(double fraction) const;  // fraction of the line, -1/2 to 1/2
  [[nodiscard]] Vec2 normal_at(double fraction) const;  // unit, to the left
  [[nodiscard]] double outer_radius_mm() const {
    return 0.5 * (length_mm + width_mm);
  }  // upper bound of the distance from
     // the middle
  [[nodiscard]] double distance_mm(Vec2 point_mm) const;  // from its edge, negative inside
  // x: arc length from the middle along its line, which continues as a circle or straight line; y: distance to the
  // left.
  [[nodiscard]] Vec2 along_and_across_mm(Vec2 point_mm) const;
};

[[nodiscard]] CONTREJOUR_API Result<void> check_dirt(const Dirt& dirt);

// The shapes that may overlap a box, in an order that does not depend on the box.
[[nodiscard]] CONTREJOUR_API std::vector<DirtStroke> dirt_within(const Dirt& dirt, Vec2 low_mm, Vec2 high_mm);

// A stroke's outline, counter-clockwise; `low` to `high` is the part of its line, -1/2 to 1/2. The line's own ends are
// round.
[[nodiscard]] CONTREJOUR_API std::vector<Vec2> dirt_outline(const DirtStroke& stroke, double low = -0.5,
                                                            double high = 0.5);

}  // namespace contrejour
