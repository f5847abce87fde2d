// SPDX-License-Identifier: Apache-2.0
// A pattern over the stop plane for look-ups: the mean over a square about any point, and the remainder outside any
// radius.
// Units: stop radii. Thread-safety: constant after construction.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/vec.h"
#include "render/stop_patterns/bounding_polygon.h"
#include "render/stop_patterns/downsampled_picture.h"

namespace contrejour::inline internal::stop_patterns {

class PatternTexture {
 public:
  // samples: side x side over the square from -extent to extent, rows from the top as in FresnelPattern; 0 outside.
  // side: a multiple of 16 or so, since it is halved that often.
  PatternTexture(int side, double extent, std::vector<float> samples);

  [[nodiscard]] double extent() const { return picture_.extent(); }
  [[nodiscard]] int side() const { return picture_.side(); }
  [[nodiscard]] std::span<const float> samples() const { return picture_.samples(); }
  [[nodiscard]] double at(Vec2 p, double width) const { return picture_.at(p, width); }
  [[nodiscard]] double flux() const;  // integral over the plane
  [[nodiscard]] std::size_t bytes() const { return picture_.bytes(); }  // of its samples

  // The radius beyond which the pattern is nowhere brighter than `level` and has only a small part of its flux.
  [[nodiscard]] double radius_above(double level) const;
  // A bounding polygon with the same property, smaller than the circle if the pattern is not round. flux: the fraction
  // that may lie outside.
  [[nodiscard]] BoundingPolygon bounding_polygon_above(double level, double flux) const;
  [[nodiscard]] double brightest_beyond(double radius) const;
  // The integral of the squared pattern outside a radius.
  [[nodiscard]] double squared_beyond(double radius) const;

 private:
  struct Remainder {  // outside a radius
    double brightest = 0.0, squared = 0.0, flux = 0.0;
  };
  [[nodiscard]] const Remainder& remainder_beyond(double radius) const;

  struct SectorRemainder {
    float brightest = 0.0F, squared = 0.0F, flux = 0.0F;
  };
  [[nodiscard]] std::vector<SectorRemainder> sector_rings() const;
  void find_remainders();
  [[nodiscard]] std::size_t rings() const { return static_cast<std::size_t>(side() / 2); }  // each a sample wide

  DownsampledPicture picture_;
  std::vector<Remainder> remainders_;  // by equal steps of the radius up to the extent
  std::vector<SectorRemainder> sector_remainders_;  // the same, by sector
};

}  // namespace contrejour::inline internal::stop_patterns
