// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/clip/cell_clipper.h"

#include <algorithm>

#include "render/adaptive/budget/small_polygons.h"
#include "render/adaptive/cells/cell_shape.h"

namespace contrejour::inline internal::adaptive {
namespace {

// The corners in pixels of the frame; only those of cut cells have values of the fields that clip them.
std::span<const Corner> in_frame(const Mesh& mesh, CellState state, std::span<const CellCorner> corners,
                                 std::vector<Corner>& to) {
  to.resize(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    to[k].position = corners[k].position + mesh.origin_px;
    to[k].uv = corners[k].uv;
    for (int f = PatchLayout::kStop; state == CellState::Clipped && f < mesh.layout.limits_end(); ++f)
      to[k].limit[static_cast<std::size_t>(f - PatchLayout::kStop)] = corners[k].value_of(mesh.field(f));
  }
  return to;
}

}  // namespace

std::span<const Corner> CellClipper::open_part(const Mesh& mesh, CellState state, const CellOutline& of,
                                               double arc_step_rad) {
  if (state != CellState::Clipped) return in_frame(mesh, state, of.all, outline_);
  const std::span<const Corner> whole = in_frame(mesh, state, of.shape, shape_);
  const std::span<const Corner> along =
      of.all.size() == of.shape.size() ? whole : in_frame(mesh, state, of.all, outline_);
  const PatchLayout& layout = mesh.layout;
  return band_.pattern ? polygon_clipper_.within_rims(whole, along, layout.crossings, layout.rims)
                       : polygon_clipper_.open_part(whole, along, layout.crossings, layout.rims, arc_step_rad);
}

void CellClipper::for_each_open_part(const Mesh& mesh, const CellOutline& of, const PolygonClipper::OpenPart& visit) {
  const std::span<const Corner> whole = in_frame(mesh, CellState::Clipped, of.shape, shape_);
  Bounds b;
  for (const Corner& c : whole) b.add(c.position);
  const double finest = std::min(1.0, kInvisibleDetail_px / std::max({b.size().x, b.size().y, kInvisibleDetail_px}));
  polygon_clipper_.for_each_open_part(whole, mesh.layout.crossings, mesh.layout.rims, finest, visit);
}

}  // namespace contrejour::inline internal::adaptive
