// Which cells a box of the pupil is drawn as: squares of the vertices of meshes, where what is finer than a mesh's
// vertices is a mesh of its own, of a quarter of it. Where meshes meet they have the same corners, so that nothing is
// left between cells and the edges that they share are drawn once.
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

#include "render/adaptive/cells/cell_plane.h"
#include "render/adaptive/cells/mesh.h"
#include "render/screens/band_screen.h"

namespace contrejour::adaptive {

enum class CellState : std::uint8_t { Open, Cut, Closed };
enum class Sides : std::uint8_t { Straight, Bent };  // bent ones have a corner in their middle

// Vertices of a square of mesh cells: corners in turn, middles of the sides, the middle.
struct Cell {
  int ix = 0, iy = 0, size = 0;
  std::array<std::size_t, 4> corner{}, side{};
  std::size_t middle = 0;
  std::array<bool, 4> shared{};  // sides that have cells of the same box beyond
  screens::ScreenView screen{ScreenPart::Level, 1.0};  // all that is seen of it
};

struct ChosenCell {
  Cell cell;
  CellState state = CellState::Open;
  Sides sides = Sides::Straight;
  const Shade* plane = nullptr;  // its irradiance is this, not its own
};

// Where a mesh lies in its box, of which there may be many: its first vertex and the length of its cells, in parts of
// the box that nothing is finer than.
struct MeshPlace {
  static constexpr int kDeepest = 11;  // quarterings of a box
  static constexpr int kWhole = Mesh::kCells << kDeepest;
  int box = 0, mirrored_box = 0;  // its own if the box is its own mirror image
  int x = 0, y = 0, step = 1 << kDeepest;

  [[nodiscard]] int size() const { return Mesh::kCells * step; }
  [[nodiscard]] MeshPlace quarter(std::size_t q) const;
  // Of its mirror image: what is first along y comes last.
  [[nodiscard]] MeshPlace mirrored() const { return {mirrored_box, box, x, kWhole - y - size(), step}; }
};

// Of the vertices of a mesh.
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

// A mesh and what is drawn of it. Cells have for corners all vertices on their sides that any of them has, whatever
// their sizes.
struct BoxMesh {
  Mesh mesh;
  MeshPlace place;
  std::array<const Shade*, 4> plane{};  // of quarters, or null
  std::forward_list<Shade> planes;
  std::vector<ChosenCell> cells;
  VertexSet corners;

  void start_with(const MeshPlace& at, const Shade* given);
  void add(const ChosenCell& chosen);
  const Shade* keep(const std::optional<Shade>& some);

 private:
  friend class BoxCells;
  // A corner of a finer mesh on a line of this one, between its vertices.
  struct FinerCorner {
    bool along_rows;
    int line, place;  // which of this mesh's lines, and how far along it, in parts of the box
    const Mesh* mesh;
    std::size_t vertex;  // of that mesh
    [[nodiscard]] auto order() const { return std::tuple(along_rows, line, place); }
  };
  std::vector<FinerCorner> finer_corners_;  // in order
};

// A corner of what is drawn of a mesh: one of its vertices, or of a finer mesh's between two of them.
struct CellCorner {
  Vec2 position;  // as the mesh's
  Vec2 uv;        // in the cell
  std::size_t vertex = 0, next = 0;
  float way = 0.0F;  // from vertex to next

  static CellCorner at_vertex(const Mesh& mesh, std::size_t vertex, Vec2 uv) {
    return {mesh.position(vertex), uv, vertex, vertex};
  }
  [[nodiscard]] float value_of(const Mesh::Field& field) const {
    return field[vertex] + (field[next] - field[vertex]) * way;
  }
};

class BoxCells {
 public:
  // Another mesh, of what no other one is. Its memory is used again, what is in `mesh` is left as it was.
  [[nodiscard]] BoxMesh& add(const MeshPlace& at, const Shade* plane);
  // Once all cells of all boxes are chosen: where meshes meet, each has the corners of the other, in the same places.
  void join();
  // All corners of a cell's polygon in turn.
  void outline(const BoxMesh& of, const Cell& cell, std::vector<CellCorner>& out) const;

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const BoxMesh& operator[](std::size_t k) const { return meshes_[k]; }
  void clear();

 private:
  static constexpr int kNone = -1;
  // A box, or a quarter of a quarter of it: of one mesh, which then holds those of its finer quarters, or of quarters
  // alone.
  struct Node {
    int mesh = kNone;
    std::array<int, 4> quarter{kNone, kNone, kNone, kNone};
  };
  // A node, or if that is quartered no farther a square of its mesh; or nothing.
  struct Area {
    int node = kNone, mesh = kNone;
    MeshPlace place;
    [[nodiscard]] bool is_empty() const { return node == kNone && mesh == kNone; }
  };
  [[nodiscard]] int node_at(const MeshPlace& place);
  [[nodiscard]] Area area_of(int node, const MeshPlace& place) const;
  [[nodiscard]] Area quarter_of(const Area& area, std::size_t q) const;
  void join_within(int node, const MeshPlace& place);
  void join(const Area& low, const Area& high, bool along_rows);
  void exchange(const Area& low, const Area& high, bool along_rows);
  static void unite(BoxMesh& first, std::size_t vertex, BoxMesh& other, std::size_t others_vertex);

  using FinerCorners = std::span<const BoxMesh::FinerCorner>;
  [[nodiscard]] static FinerCorners finer_corners(const BoxMesh& of, const Cell& cell, std::size_t side);
  [[nodiscard]] static CellCorner corner_at(const BoxMesh& of, const Cell& cell, std::size_t side,
                                            const BoxMesh::FinerCorner& corner);

  std::deque<BoxMesh> meshes_;
  std::size_t count_ = 0;  // in use
  std::vector<Node> nodes_;
  std::vector<int> roots_;  // by box
};

}  // namespace contrejour::adaptive
