// SPDX-License-Identifier: Apache-2.0
// Emits the open parts of cells as polygons of a list: with their light, behind what they pass, and as points where
// they are smaller than pixels resolve.
#pragma once

#include <span>
#include <vector>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/dirt_crossings.h"
#include "render/adaptive/clip/corner.h"
#include "render/adaptive/emit/cell_light.h"
#include "render/adaptive/emit/pattern_emitter.h"
#include "render/adaptive/emit/points.h"
#include "render/polygons/polygon_list.h"
#include "render/stop_patterns/shadow_clipper.h"

namespace contrejour::inline internal::adaptive {

// The occluders in front of a polygon whose transmittance varies over it. If dirt is set, the polygon lies
// within its triangle.
struct Occluders {
  const StopMap* pattern = nullptr;
  const DirtTriangle* dirt = nullptr;
  double max_transmittance = 1.0;  // largest transmittance of the stop pattern
};

class PolygonEmitter {
 public:
  // All arguments must outlive this object.
  PolygonEmitter(const BandContext& band, PolygonList& out) : band_(band), out_(out), patterns_(band, out) {}

  // light: of the whole cell or triangle that the polygon is a part of.
  void emit(std::span<const Corner> polygon, const CellLight& light, const Occluders& occluders);

 private:
  void emit_resolved(std::span<const Corner> polygon, double area_px, const CellLight& light,
                     const Occluders& occluders);
  void emit_occluded_by_dirt(std::span<const Corner> polygon, const LinearIrradiance& irradiance,
                             const Occluders& occluders);
  void emit_shadows(std::span<const Corner> polygon, const CellLight& light, const Occluders& occluders);
  void emit_line(std::span<const Corner> polygon, const Flux& flux);
  [[nodiscard]] Flux transmitted(Flux flux, Vec2 pixel, const Occluders& occluders) const;

  const BandContext& band_;
  PolygonList& out_;
  PatternEmitter patterns_;
  stop_patterns::ShadowClipper shadows_;
  PointBuffer points_;
};

}  // namespace contrejour::inline internal::adaptive
