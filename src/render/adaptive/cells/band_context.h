// SPDX-License-Identifier: Apache-2.0
// The context of a band lists what its light passes before it reaches the frame. Every stage that turns patches into
// polygons (choose, budget, clip, emit) reads it, and none changes it.
#pragma once

#include <cstdint>
#include <memory>

#include "ghosts/iris_shape.h"
#include "render/adaptive/cells/dirt_view.h"
#include "render/adaptive/cells/mesh.h"
#include "render/stop_patterns/band_stop_pattern.h"

namespace contrejour::inline internal::adaptive {

struct BandContext {
  const IrisShape& iris;
  int width = 0, height = 0;  // of the frame, pixels
  double peak = 1.0;          // of the frame's pixel values
  // True if straight lines of the patches are curved in the entrance plane: their sides would then leave seams next to
  // another box.
  bool has_curved_sides = false;
  std::shared_ptr<const stop_patterns::BandStopPattern> pattern = nullptr;  // null: the iris is sharp
  double stop_unit = 1.0;  // stop radii: unit of the stop coordinates where there is a stop pattern
  DirtView dirt = {};

  // The bits of Mesh::outside that mark vertices without light. A stop pattern clips nothing.
  [[nodiscard]] std::uint32_t blocking(const Mesh& mesh) const { return pattern ? ~0U << mesh.layout.crossings : ~0U; }
};

}  // namespace contrejour::inline internal::adaptive
