// SPDX-License-Identifier: Apache-2.0
// The cells that a box of the pupil is drawn as. Cells are squares of the vertices of meshes; where a mesh is too
// coarse, a quarter of it has a mesh of its own. Meshes that meet have the same corners on their border, so that cells
// leave no gaps and the edges that they share are drawn once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <forward_list>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "render/adaptive/cells/cell.h"
#include "render/adaptive/cells/mesh.h"

namespace contrejour::inline internal::adaptive {

// The position of a mesh in its box, of which there may be many: its first vertex and the length of its cells, in units
// of the finest subdivision (the box's side is kWhole of them).
struct MeshPosition {
  // The most times that a box may be quartered: while its patches are fitted, then while their meshes are chosen
  // (patch_fitter.cpp checks the sum).
  static constexpr int kMaxDepth = 12;
  static constexpr int kWhole = Mesh::kCells << kMaxDepth;
  int box = 0, mirrored_box = 0;  // the same index if the box is its own mirror image
  int x = 0, y = 0, step = 1 << kMaxDepth;

  [[nodiscard]] int size() const { return Mesh::kCells * step; }
  [[nodiscard]] MeshPosition quarter(std::size_t q) const;
  // The position of the mirror image, in which the order along y is reversed.
  [[nodiscard]] MeshPosition mirrored() const { return {mirrored_box, box, x, kWhole - y - size(), step}; }
};

// A set of vertices of a mesh.
class VertexSet {
 public:
  void clear() { rows_.fill(0); }
  void add(std::size_t vertex) { rows_[vertex / Mesh::kStride] |= static_cast<Row>(1U << vertex % Mesh::kStride); }
  [[nodiscard]] bool has(std::size_t vertex) const {
    return (rows_[vertex / Mesh::kStride] >> vertex % Mesh::kStride & 1U) != 0;
  }

 private:
  using Row = std::uint16_t;
  static_assert(Mesh::kSide <= 16);
  std::array<Row, Mesh::kSide> rows_{};
};

// A mesh and the cells that are drawn of it. If a vertex is a corner of any cell, it is a corner of every cell on whose
// side it lies, whatever their sizes.
struct BoxMesh {
  Mesh mesh;
  MeshPosition position;
  std::array<const LinearIrradiance*, 4> plane{};  // one per quarter, or null
  std::forward_list<LinearIrradiance> planes;
  std::vector<ChosenCell> cells;
  VertexSet corners;

  void start_with(const MeshPosition& at, const LinearIrradiance* given);
  void add(const ChosenCell& chosen);
  const LinearIrradiance* keep(const std::optional<LinearIrradiance>& some);

 private:
  friend class BoxCells;
  // A corner of a finer mesh that lies on a line of this one, between two of its vertices.
  struct HangingVertex {
    bool along_rows;
    int line, position;  // the line of this mesh, and the position along it as in MeshPosition
    const Mesh* mesh;
    std::size_t vertex;  // of that mesh
    [[nodiscard]] auto order() const { return std::tuple(along_rows, line, position); }
  };
  std::vector<HangingVertex> hanging_vertices_;  // sorted by order()
};

// A corner of a cell's polygon: a vertex of its mesh, or a corner of a finer mesh between two of its vertices.
struct CellCorner {
  Vec2 position;  // relative to the mesh's origin
  Vec2 uv;  // in the cell
  std::size_t vertex = 0, next = 0;
  float fraction = 0.0F;  // fraction of the distance from `vertex` to `next`

  static CellCorner at_vertex(const Mesh& mesh, std::size_t vertex, Vec2 uv) {
    return {mesh.position(vertex), uv, vertex, vertex};
  }
  [[nodiscard]] float value_of(const Mesh::Field& field) const {
    return field[vertex] + (field[next] - field[vertex]) * fraction;
  }
};

class BoxCells {
 public:
  // Adds a mesh that covers a part of a box which no other mesh covers. The memory of an earlier one is used again:
  // `mesh` keeps its old contents until it is made.
  [[nodiscard]] BoxMesh& add(const MeshPosition& at, const LinearIrradiance* plane);
  // Call this once all cells of all boxes are chosen: meshes that meet receive each other's corners, at identical
  // positions.
  void make_conforming();
  // Writes all corners of a cell's polygon to `out`, in order.
  void outline(const BoxMesh& of, const Cell& cell, std::vector<CellCorner>& out) const;

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const BoxMesh& operator[](std::size_t k) const { return meshes_[k]; }
  void clear();
  [[nodiscard]] std::size_t bytes() const;

 private:
  static constexpr int kNone = -1;
  // A box, or a quarter of another node. Either it has a mesh, which also covers those of its quarters that have no
  // node, or its quarters alone cover it.
  struct Node {
    int mesh = kNone;
    std::array<int, 4> quarter{kNone, kNone, kNone, kNone};
  };
  // A node, or, where the node is not quartered further, a square of its mesh; or nothing.
  struct Area {
    int node = kNone, mesh = kNone;
    MeshPosition position;
    [[nodiscard]] bool is_empty() const { return node == kNone && mesh == kNone; }
  };
  [[nodiscard]] int node_at(const MeshPosition& position);
  [[nodiscard]] Area area_of(int node, const MeshPosition& position) const;
  [[nodiscard]] Area quarter_of(const Area& area, std::size_t q) const;
  void make_conforming_within(int node, const MeshPosition& position);
  void make_conforming(const Area& low, const Area& high, bool along_rows);
  void exchange(const Area& low, const Area& high, bool along_rows);
  static void merge_vertices(BoxMesh& first, std::size_t vertex, BoxMesh& other, std::size_t others_vertex);

  using HangingVertices = std::span<const BoxMesh::HangingVertex>;
  [[nodiscard]] static HangingVertices hanging_vertices(const BoxMesh& of, const Cell& cell, std::size_t side);
  [[nodiscard]] static CellCorner corner_at(const BoxMesh& of, const Cell& cell, std::size_t side,
                                            const BoxMesh::HangingVertex& corner);

  std::deque<BoxMesh> meshes_;
  std::size_t count_ = 0;  // in use
  std::vector<Node> nodes_;
  std::vector<int> roots_;  // by box
};

}  // namespace contrejour::inline internal::adaptive
