// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/design_poses.h"

#include <cmath>

#include <fmt/format.h>

#include "optics/lens_files/sequential/design_opening.h"

namespace contrejour::inline internal {
namespace {

Placement in_mm(const Placement& placement, double unit_mm) {
  Placement out = placement;
  out.shift = out.shift * unit_mm;
  return out;
}

// The pose of each row in one zoom position; the last one is the image's.
std::vector<PoseAndRotation> poses(const SequentialDesign& design, const std::vector<DesignRow>& rows,
                                   const std::vector<double>& thickness) {
  const double unit_mm = design.unit_mm;
  std::vector<PoseAndRotation> out;
  Placement frame;
  std::size_t next = 0;
  for (std::size_t k = 1; k < design.surfaces.size(); ++k) {
    const DesignSurface& at = design.surfaces[k];
    if (!(at.move == Placement{})) frame = frame.then(in_mm(at.move, unit_mm));
    for (; next < rows.size() && rows[next].of == k; ++next) out.push_back(pose_of(frame.then(in_mm(at.own, unit_mm))));
    if (k + 1 == design.surfaces.size()) break;
    const Vec3 along{0, 0, thickness[k] * unit_mm};
    if (!(frame.axes == Placement{}.axes)) frame.shift = frame.shift + frame.rotated(along) - along;
  }
  out.push_back(pose_of(frame.then(in_mm(design.surfaces.back().own, unit_mm))));
  return out;
}

Result<void> set_pose(const std::string& file, const PoseAndRotation& at, Surface& surface) {
  if (surface.kind == SurfaceKind::Stop) {
    if (at.pose == SurfacePose{}) return {};
    return failure(ErrorCode::Unsupported,
                   "the stop is decentred or tilted; it is computed centred on the axis: move the coordinate break "
                   "behind it",
                   {file, surface.source_line, 0});
  }
  surface.pose = at.pose;
  if (!surface.shape.has_axial_symmetry()) surface.shape.rotation_rad += at.rotation_rad;
  rotate_opening(at.rotation_rad, surface.aperture);
  rotate_opening(at.rotation_rad, surface.obscuration);
  return {};
}

}  // namespace

Result<void> place_rows(const SequentialDesign& design, const std::vector<DesignPosition>& positions,
                        std::vector<DesignRow>& rows) {
  const auto unsupported = [&](int line, std::string message) {
    return failure(ErrorCode::Unsupported, std::move(message), {design.file, line, 0});
  };
  const auto placed = poses(design, rows, positions.front().thickness);
  for (const auto& position : positions) {
    const auto other = poses(design, rows, position.thickness);
    for (std::size_t k = 0; k < placed.size(); ++k)
      if (!(other[k].pose == placed[k].pose))
        return unsupported(design.surfaces.front().line,
                           "the coordinates are tilted where a zoom's gap changes, which moves elements aside");
  }
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (auto good = set_pose(design.file, placed[k], rows[k].surface); !good) return good;
  const SurfacePose& image = placed.back().pose;
  if (image == SurfacePose{}) return {};
  return unsupported(
      design.surfaces.back().line,
      fmt::format("the image surface stands {:.4g} mm beside the lens's axis with its own along ({:.4g}, {:.4g}, "
                  "{:.4g}); the sensor is computed centred and upright: bring the coordinates back before it",
                  std::hypot(image.shift_mm.x, image.shift_mm.y), image.axis.x, image.axis.y, image.axis.z));
}

}  // namespace contrejour::inline internal
