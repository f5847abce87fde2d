// SPDX-License-Identifier: Apache-2.0
// The search for a pupil: the part of the entrance plane through which a light's rays get through along a path;
// hullin2011 4.2, ray bounding. Differs: hullin2011 precomputes tables over light directions (pupil_bounds.h); packets
// are fast enough to search anew for every light.
//
// Options say where and how to search:
// - over a window: grids of rays, each over the open part of the one before. For any lens, in any frame; blades count
//   as the circle or polygon around them. Finds one rectangle.
// - along the meridian: coarse grids in one half of the window, refined where light may pass, and a scan of the line
//   y = 0 for small pupils among failing rays. For a light in its meridional frame and a path with axial symmetry; the
//   iris counts as its circumscribed circle. Finds separate boxes with a few hundred rays.
// - around a hint, the box at another wavelength or angle: one grid. Over a window it finds nothing if the pupil
//   extends beyond the hint; along the meridian the hint grows.
//
// Both ways trace rays at points, decide from the corners of cells where light may pass, and continue there
// (clearance_rays.h, clearance_grid.h, open_cells.h). They stay two: `bundle` and `tiled` spread their grids over the
// rectangle of the first, so that another rectangle, however good, would change every pixel, and irises with blades
// need its narrower bounds; `adaptive` needs the boxes of the second, and their few rays. pupil_shape.h describes a
// pupil for lights with a size, from the same rays.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "ghosts/ray_grid.h"
#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal::pupils {

// The grids over a window that are tried if the first one finds nothing. Some ghosts of a fisheye get through a
// thousandth of its front.
enum class PupilEffort {
  Once,      // not at all
  Finer,     // a grid of four times as many rays a side
  Finest,    // and one of twelve times
};
inline constexpr int kSearchSide = 49;  // default of the rays along a side of a search's grids
[[nodiscard]] int first_grid_side(PupilEffort effort);  // rays a side of the effort's finest grid
// The effort for a ghost that is drawn with this number of rays a side, so that searching costs in proportion to
// drawing.
[[nodiscard]] PupilEffort effort_for_grid(int side);

// The rays among which a pupil is searched. Obscurations do not count.
struct PupilRays {
  // tables and what they refer to must outlive it.
  PupilRays(const OpticalPath& path, const ReflectanceTables& tables, const LightSource& light, const IrisShape& iris,
            const EntranceWindow& window);
  // The iris counts as its circumscribed circle. path: of the light, from any point of the entrance plane.
  PupilRays(PacketPath path, const EntranceWindow& window);

  PacketPath path;
  IrisShape iris;  // without concave parts
  EntranceWindow window;
};

struct PupilSearch {
  bool along_meridian = false;
  // Along the meridian, without a hint: searches only if light gets through on the line y = 0, which a hundred rays
  // tell. For a pupil that was not found at another wavelength.
  bool only_through_line = false;
  std::optional<Rectangle> hint = std::nullopt;
  // Over a window without a hint. A side below kSearchSide is for well-behaved paths.
  PupilEffort effort = PupilEffort::Finest;
  int side = kSearchSide;
  // Asked between the parts of a grid over a window, whose finest takes tenths of a second: once it is cancelled,
  // nothing is found. Null: never.
  const Context* context = nullptr;
};

struct Pupil {
  // Along the meridian: those that touch y = 0 are symmetric in y; of the others each comes with its mirror image, or
  // lies above the axis where a hint does. Otherwise one at most, with a margin. Empty: nothing gets through.
  std::vector<Rectangle> boxes{};
  Rectangle sensor_mm{};  // approximate bounds of its rays on the sensor; not along the meridian
  std::uint64_t rays = 0;

  [[nodiscard]] bool is_empty() const { return boxes.empty(); }
  [[nodiscard]] const Rectangle& box() const { return boxes.front(); }  // where there is one
};

// grid: scratch memory for searches over a window.
[[nodiscard]] Pupil find_pupil(PupilRays& rays, const PupilSearch& search, RayGrid& grid);
[[nodiscard]] inline Pupil find_pupil(PupilRays rays, const PupilSearch& search) {
  RayGrid grid;
  return find_pupil(rays, search, grid);
}

}  // namespace contrejour::inline internal::pupils
