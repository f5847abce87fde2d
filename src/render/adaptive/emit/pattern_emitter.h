// SPDX-License-Identifier: Apache-2.0
// Emits polygons whose light passes a stop pattern that varies over them instead of the sharp iris. Points in the stop
// are polynomials of the pixel. Large polygons are cut along the edges with fringes into strips and a uniform
// remainder.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/clip/corner.h"
#include "render/adaptive/clip/placed_polygon.h"
#include "render/adaptive/emit/points.h"
#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::adaptive {

class PatternEmitter {
 public:
  // All arguments must outlive this object.
  PatternEmitter(const BandContext& band, PolygonList& out) : band_(band), out_(out) {}

  // transmitted: the largest transmittance of the pattern.
  void emit(std::span<const Corner> polygon, double area_px, const LinearIrradiance& irradiance, const StopMap& map,
            double transmitted);

 private:
  void emit_in_strips(const LinearIrradiance& irradiance, const StopMap& map, int samples, std::uint32_t table);
  void add_fringed(std::span<const PlacedCorner> polygon, const LinearIrradiance& irradiance, const StopMap& map,
                   int samples, std::uint32_t table);
  [[nodiscard]] std::uint32_t table_for(double width);
  [[nodiscard]] Pattern pattern_of(std::span<const Point> polygon, const StopMap& map, int samples);
  [[nodiscard]] std::uint32_t weights();

  const BandContext& band_;
  PolygonList& out_;
  // Indices in the list: of edge tables, by pattern and pixel width; of weights, by pattern.
  std::map<std::pair<const stop_patterns::BandStopPattern*, int>, std::uint32_t> tables_;
  std::map<const stop_patterns::BandStopPattern*, std::uint32_t> weights_;
  PlacedPolygon remaining_, strip_;  // scratch for cutting along edges
  PointBuffer points_;
};

}  // namespace contrejour::inline internal::adaptive
