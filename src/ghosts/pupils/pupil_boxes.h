// SPDX-License-Identifier: Apache-2.0
// Finds a ghost's pupil on the entrance plane with a few hundred rays: boxes that together contain all rays that get
// through. Cells of a coarse grid that may transmit light are refined until refinement gains no more.
#pragma once

#include <cstdint>
#include <vector>

#include "ghosts/ray_grid.h"
#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal::pupils {

struct PupilBoxes {
  std::vector<Rectangle> boxes;  // in the meridional frame; those that touch y = 0 are symmetric in y, of the others
                                 // each comes with its mirror image
  std::uint64_t rays = 0;
};

// path: of a light in the meridional frame, from any point of the entrance plane. The iris counts as its circumscribed
// circle.
[[nodiscard]] PupilBoxes find_pupil_boxes(const PacketPath& path, const EntranceWindow& window);

}  // namespace contrejour::inline internal::pupils
