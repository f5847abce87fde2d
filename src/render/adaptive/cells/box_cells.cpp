// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/cells/box_cells.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr std::array<std::array<int, 2>, 4> kAlong{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};  // directions of a cell's sides

}  // namespace

MeshPosition MeshPosition::quarter(std::size_t q) const {
  const int half = size() / 2;
  return {box, mirrored_box, x + static_cast<int>(q % 2) * half, y + static_cast<int>(q / 2) * half, step / 2};
}

void BoxMesh::start_with(const MeshPosition& at, const LinearIrradiance* given) {
  position = at;
  plane.fill(given);
  planes.clear();
  cells.clear();
  corners.clear();
  hanging_vertices_.clear();
}

void BoxMesh::add(const ChosenCell& chosen) {
  cells.push_back(chosen);
  for (const std::size_t vertex : chosen.cell.corner) corners.add(vertex);
  for (const std::size_t vertex : chosen.cell.side)
    if (chosen.sides == Sides::Curved) corners.add(vertex);
}

const LinearIrradiance* BoxMesh::keep(const std::optional<LinearIrradiance>& some) {
  return some ? &planes.emplace_front(*some) : nullptr;
}

std::size_t BoxCells::bytes() const {
  std::size_t sum = nodes_.size() * sizeof(Node);
  for (const BoxMesh& one : meshes_)
    sum += sizeof(BoxMesh) + one.mesh.fields.size() * sizeof(Mesh::Field) + one.cells.capacity() * sizeof(ChosenCell);
  return sum;
}

void BoxCells::clear() {
  count_ = 0;
  nodes_.clear();
  roots_.clear();
}

// Descends from the box to the position's node, and makes the nodes that do not exist yet.
int BoxCells::node_at(const MeshPosition& position) {
  const auto box = static_cast<std::size_t>(position.box);
  if (roots_.size() <= box) roots_.resize(box + 1, kNone);
  const auto make = [&] {
    nodes_.emplace_back();
    return static_cast<int>(nodes_.size()) - 1;
  };
  if (roots_[box] == kNone) roots_[box] = make();
  int node = roots_[box];
  MeshPosition at{position.box, position.mirrored_box};
  while (at.step > position.step) {
    const int half = at.size() / 2;
    const std::size_t q = (position.x >= at.x + half ? 1U : 0U) + (position.y >= at.y + half ? 2U : 0U);
    at = at.quarter(q);
    int next = nodes_[static_cast<std::size_t>(node)].quarter[q];
    if (next == kNone) {
      next = make();
      nodes_[static_cast<std::size_t>(node)].quarter[q] = next;
    }
    node = next;
  }
  return node;
}

BoxMesh& BoxCells::add(const MeshPosition& at, const LinearIrradiance* plane) {
  if (meshes_.size() == count_) meshes_.emplace_back();
  nodes_[static_cast<std::size_t>(node_at(at))].mesh = static_cast<int>(count_);
  BoxMesh& mesh = meshes_[count_++];
  mesh.start_with(at, plane);
  return mesh;
}

BoxCells::Area BoxCells::area_of(int node, const MeshPosition& position) const {
  if (node == kNone) return {};
  const Node& of = nodes_[static_cast<std::size_t>(node)];
  const bool is_quartered = std::ranges::any_of(of.quarter, [](int quarter) { return quarter != kNone; });
  return {is_quartered ? node : kNone, of.mesh, position};
}

// A quarter without a node of its own may be covered by the area's mesh.
BoxCells::Area BoxCells::quarter_of(const Area& area, std::size_t q) const {
  const int node = area.node != kNone ? nodes_[static_cast<std::size_t>(area.node)].quarter[q] : kNone;
  if (node != kNone) return area_of(node, area.position.quarter(q));
  return {kNone, area.mesh, area.position.quarter(q)};
}

void BoxCells::make_conforming() {
  if (count_ <= 1) return;
  for (std::size_t box = 0; box < roots_.size(); ++box)
    if (roots_[box] != kNone) make_conforming_within(roots_[box], {static_cast<int>(box), static_cast<int>(box)});
  for (std::size_t k = 0; k < count_; ++k) {
    auto& corners = meshes_[k].hanging_vertices_;
    if (corners.size() < 2) continue;
    std::ranges::stable_sort(corners, {}, &BoxMesh::HangingVertex::order);
    const auto [first, last] = std::ranges::unique(corners, {}, &BoxMesh::HangingVertex::order);
    corners.erase(first, last);
  }
}

// Inner borders come first, so that the meshes that meet at a corner of an outer border agree already.
void BoxCells::make_conforming_within(int node, const MeshPosition& position) {
  const Area area = area_of(node, position);
  if (area.node == kNone) return;
  std::array<Area, 4> part;
  for (std::size_t q = 0; q < 4; ++q) {
    const int finer = nodes_[static_cast<std::size_t>(node)].quarter[q];
    if (finer != kNone) make_conforming_within(finer, position.quarter(q));
    part[q] = quarter_of(area, q);
  }
  make_conforming(part[0], part[1], false);
  make_conforming(part[2], part[3], false);
  make_conforming(part[0], part[2], true);
  make_conforming(part[1], part[3], true);
}

// Joins two squares of equal size that lie side by side.
void BoxCells::make_conforming(const Area& low, const Area& high, bool along_rows) {
  if (low.is_empty() || high.is_empty()) return;
  if (low.node == kNone && high.node == kNone) {
    if (low.mesh != high.mesh) exchange(low, high, along_rows);
    return;
  }
  const std::array<std::size_t, 2> last{along_rows ? 2U : 1U, 3U}, first{0U, along_rows ? 1U : 2U};
  for (std::size_t k = 0; k < 2; ++k) make_conforming(quarter_of(low, last[k]), quarter_of(high, first[k]), along_rows);
}

// Gives two meshes that meet each other's corners on their common border.
void BoxCells::exchange(const Area& low, const Area& high, bool along_rows) {
  BoxMesh& of_low = meshes_[static_cast<std::size_t>(low.mesh)];
  BoxMesh& of_high = meshes_[static_cast<std::size_t>(high.mesh)];
  const bool low_is_coarser = of_low.position.step >= of_high.position.step;
  BoxMesh& coarse = low_is_coarser ? of_low : of_high;
  BoxMesh& fine = low_is_coarser ? of_high : of_low;
  const int line = along_rows ? high.position.y : high.position.x;
  const int begin = along_rows ? high.position.x : high.position.y;
  for (int position = begin; position <= begin + high.position.size(); position += fine.position.step) {
    const int x = along_rows ? position : line, y = along_rows ? line : position;
    const auto vertex_of = [&](const MeshPosition& at) { return Mesh::at((x - at.x) / at.step, (y - at.y) / at.step); };
    const std::size_t of_fine = vertex_of(fine.position), of_coarse = vertex_of(coarse.position);
    const int along = position - (along_rows ? coarse.position.x : coarse.position.y);
    const bool both = along % coarse.position.step == 0;
    const bool is_corner = fine.corners.has(of_fine);
    if (both && (is_corner || coarse.corners.has(of_coarse))) {
      merge_vertices(coarse, of_coarse, fine, of_fine);
    } else if (is_corner) {
      const int of_line = (line - (along_rows ? coarse.position.y : coarse.position.x)) / coarse.position.step;
      coarse.hanging_vertices_.push_back({along_rows, of_line, along, &fine.mesh, of_fine});
    }
  }
}

// Gives a corner of both meshes bit-identical positions. They are rounded to a grid of 2^-13 pixels, since meshes of
// other patches count positions from another origin. The smaller of the two rounded positions is taken, so that up to
// four meshes that meet in a corner agree, whatever the order.
void BoxCells::merge_vertices(BoxMesh& first, std::size_t vertex, BoxMesh& other, std::size_t others_vertex) {
  constexpr double kPerPixel = 8192.0;
  const auto position_of = [](const BoxMesh& of, std::size_t at) {
    const Vec2 p = of.mesh.position(at) + of.mesh.origin_px;
    return std::pair(std::round(p.x * kPerPixel), std::round(p.y * kPerPixel));
  };
  const auto [x, y] = std::min(position_of(first, vertex), position_of(other, others_vertex));
  const auto put = [&](BoxMesh& to, std::size_t at) {
    to.mesh.fields[PatchLayout::kX][at] = static_cast<float>(x / kPerPixel - to.mesh.origin_px.x);
    to.mesh.fields[PatchLayout::kY][at] = static_cast<float>(y / kPerPixel - to.mesh.origin_px.y);
    to.corners.add(at);
  };
  put(first, vertex);
  put(other, others_vertex);
}

void BoxCells::outline(const BoxMesh& of, const Cell& cell, std::vector<CellCorner>& out) const {
  out.clear();
  const double size = cell.size;
  int x = 0, y = 0;
  for (std::size_t side = 0; side < 4; ++side) {
    const auto finer = of.hanging_vertices_.empty() ? HangingVertices{} : hanging_vertices(of, cell, side);
    std::size_t done = 0;
    const int along = kAlong[side][0] + kAlong[side][1];
    for (int step = 0; step < cell.size; ++step, x += kAlong[side][0], y += kAlong[side][1]) {
      const std::size_t vertex = Mesh::at(cell.ix + x, cell.iy + y);
      if (of.corners.has(vertex)) out.push_back(CellCorner::at_vertex(of.mesh, vertex, {x / size, y / size}));
      const int next = side % 2 == 0 ? cell.ix + x + along : cell.iy + y + along;
      for (; done < finer.size(); ++done) {
        const auto& corner = along > 0 ? finer[done] : finer[finer.size() - 1 - done];
        if ((corner.position - next * of.position.step) * along > 0) break;
        out.push_back(corner_at(of, cell, side, corner));
      }
    }
  }
}

// The corners of finer meshes that lie within one of a cell's sides.
BoxCells::HangingVertices BoxCells::hanging_vertices(const BoxMesh& of, const Cell& cell, std::size_t side) {
  const bool along_rows = side % 2 == 0;
  const int line = (along_rows ? cell.iy : cell.ix) + (side == 1 || side == 2 ? cell.size : 0);
  const int begin = along_rows ? cell.ix : cell.iy;
  const auto from = [&](int vertex) {
    const std::tuple order(along_rows, line, vertex * of.position.step);
    return std::ranges::lower_bound(of.hanging_vertices_, order, {}, &BoxMesh::HangingVertex::order);
  };
  return {from(begin), from(begin + cell.size)};
}

CellCorner BoxCells::corner_at(const BoxMesh& of, const Cell& cell, std::size_t side,
                               const BoxMesh::HangingVertex& corner) {
  const int step = of.position.step;
  const double fraction = static_cast<double>(corner.position) / step;
  const int before = corner.position / step;
  const auto vertex = [&](int k) { return corner.along_rows ? Mesh::at(k, corner.line) : Mesh::at(corner.line, k); };
  const double along = (fraction - (corner.along_rows ? cell.ix : cell.iy)) / cell.size;
  const double across = side == 1 || side == 2 ? 1.0 : 0.0;
  return {corner.mesh->position(corner.vertex) + corner.mesh->origin_px - of.mesh.origin_px,
          corner.along_rows ? Vec2{along, across} : Vec2{across, along}, vertex(before), vertex(before + 1),
          static_cast<float>(fraction - before)};
}

}  // namespace contrejour::inline internal::adaptive
