// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/open_mesh.h"

#include <cmath>
#include <limits>
#include <optional>

#include "render/pupils/open_cells.h"
#include "render/pupils/open_halves.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kMaxShrinkings = 3;
constexpr double kWorthShrinking = 0.5;  // of the area
constexpr double kFull = 0.4;            // fraction of open rays above which a box is not shrunk
constexpr int kMaxRefinement = 5;              // levels of finer meshes, each with cells of half the size
constexpr std::size_t kMaxFiner = 400;  // blocks of a box that are refined
constexpr std::array<std::size_t, 4> kWholeBlock{0, 2, 8, 6};
constexpr std::uint32_t kFinerSide = 5;  // vertices along a side of a refined block

// Integrals over the open part of a block of a mesh, as weights of its vertices. Functions are integrated as linear
// over triangles, with a straight edge of the open part in each: the error is of second order in the size of cells.
// Taking the four cells as one gives four times the error, so the two results give an extrapolated value and an error
// estimate (Richardson 1911).
class BlockWeights {
 public:
  BlockWeights(const OpenMesh& mesh, const Block& block) : mesh_(mesh), block_(block) {
    for (std::size_t k = 0; k < blocked_.size(); ++k) {
      blocked_[k] = mesh.blocked[block.vertex[k]];
      lowest_ = std::min(lowest_, blocked_[k]);
      highest_ = std::max(highest_, blocked_[k]);
    }
  }

  [[nodiscard]] bool is_dark() const { return lowest_ > 0.0F; }

  void find() {
    const double cell_mm2 = mesh_.cell_mm2();
    if (highest_ <= 0.0F) return find_open(cell_mm2);
    for (const auto& cell : kCellsOfBlock) add_cell(cell, cell_mm2, fine_);
    if (highest_ < kFailed) add_cell(kWholeBlock, 4.0 * cell_mm2, coarse_);
  }
  [[nodiscard]] double light() const { return light_of(fine_); }
  // The estimated error of the integral.
  [[nodiscard]] double uncertain() const {
    return highest_ < kFailed ? std::abs(light() - light_of(coarse_)) : partly_open_;
  }
  void add_to(std::vector<double>& weight) const {
    const double extrapolated = highest_ < kFailed ? 1.0 / 3.0 : 0.0;
    for (std::size_t k = 0; k < blocked_.size(); ++k)
      weight[block_.vertex[k]] += fine_[k] + extrapolated * (fine_[k] - coarse_[k]);
  }

 private:
  using Nine = std::array<double, 9>;

  [[nodiscard]] double light_of(const Nine& weight) const {
    double light = 0.0;
    for (std::size_t k = 0; k < blocked_.size(); ++k) light += weight[k] * mesh_.transmission[block_.vertex[k]];
    return light;
  }
  void find_open(double cell_mm2) {
    constexpr Nine kFine{1.0 / 3.0, 0.5, 1.0 / 6.0, 0.5, 1.0, 0.5, 1.0 / 6.0, 0.5, 1.0 / 3.0};
    constexpr Nine kCoarse{4.0 / 3.0, 0.0, 2.0 / 3.0, 0.0, 0.0, 0.0, 2.0 / 3.0, 0.0, 4.0 / 3.0};
    for (std::size_t k = 0; k < blocked_.size(); ++k) {
      fine_[k] = cell_mm2 * kFine[k];
      coarse_[k] = cell_mm2 * kCoarse[k];
    }
  }
  void add_cell(const std::array<std::size_t, 4>& v, double mm2, Nine& weight) {
    add_triangle({v[0], v[1], v[2]}, 0.5 * mm2, weight);
    add_triangle({v[0], v[2], v[3]}, 0.5 * mm2, weight);
  }
  // In a triangle with failing rays the edge's position is unknown: each ray that gets through counts for a third of
  // the area, which is right on average over positions of the edge.
  void add_triangle(const std::array<std::size_t, 3>& v, double mm2, Nine& weight) {
    const std::array<float, 3> blocked{blocked_[v[0]], blocked_[v[1]], blocked_[v[2]]};
    if (*std::ranges::max_element(blocked) < kFailed) {
      const double open = mm2 / 3.0 * fraction_below_zero(blocked[0], blocked[1], blocked[2]);
      for (const std::size_t k : v) weight[k] += open;
      if (*std::ranges::max_element(blocked) > 0.0F)
        for (const std::size_t k : v) partly_open_ += mm2 / 3.0 * mesh_.transmission[block_.vertex[k]];
      return;
    }
    for (const std::size_t k : v) {
      if (blocked_[k] > 0.0F) continue;
      weight[k] += mm2 / 3.0;
      partly_open_ += mm2 / 3.0 * mesh_.transmission[block_.vertex[k]];
    }
  }

  const OpenMesh& mesh_;
  const Block& block_;
  std::array<float, 9> blocked_;
  float lowest_ = kFailed, highest_ = -kFailed;
  Nine fine_{}, coarse_{};
  double partly_open_ = 0.0;  // light in partly open triangles
};

std::ptrdiff_t count_open(const RayGrid& grid) {
  return std::ranges::count_if(grid.blocked, [](float blocked) { return blocked <= 0.0F; });
}

// The smallest rectangle symmetric about y = 0 that contains r.
Rectangle symmetric(const Rectangle& r) {
  const double y = std::max(r.high.y, -r.low.y);
  return {{r.low.x, -y}, {r.high.x, y}};
}

// The bounds of the cells that may transmit light; the iris counts as its circumscribed circle.
std::optional<Rectangle> bounds_of_light(const RayGrid& grid) {
  const auto from_circle = [&](std::size_t c, std::size_t k) {
    return std::hypot(grid.stop_x[c][k], grid.stop_y[c][k]) - 1.0F;
  };
  return bounds_of_cells(grid, [&](int ix, int iy, bool is_within) {
    return !is_within && may_transmit(grid, grid.corners(ix, iy), from_circle);
  });
}

// Fills a mesh's weights, except for up to `max_blocks` blocks whose error exceeds `allowed`: these are removed and
// returned.
std::vector<Block> weigh(OpenMesh& mesh, double allowed, std::size_t max_blocks) {
  mesh.weight.assign(mesh.blocked.size(), 0.0);
  std::vector<Block> certain, uncertain;
  for (const Block& block : mesh.blocks) {
    BlockWeights weights(mesh, block);
    if (weights.is_dark()) continue;
    weights.find();
    if (weights.uncertain() > allowed && uncertain.size() < max_blocks) {
      uncertain.push_back(block);
    } else {
      certain.push_back(block);
      weights.add_to(mesh.weight);
    }
  }
  mesh.blocks = std::move(certain);
  return uncertain;
}

double light_of(const OpenMesh& mesh) {
  double light = 0.0;
  for (const Block& block : mesh.blocks) {
    BlockWeights weights(mesh, block);
    if (weights.is_dark()) continue;
    weights.find();
    light += weights.light();
  }
  return light;
}

// The vertices are those of a grid that begins at one vertex and has the same number of vertices in every row.
void add_blocks(std::uint32_t first, std::uint32_t side, Vec2 low_mm, Vec2 step_mm, std::vector<Block>& blocks) {
  for (std::uint32_t row = 0; row + 2 < side; row += 2) {
    for (std::uint32_t column = 0; column + 2 < side; column += 2) {
      const std::uint32_t k = first + row * side + column;
      blocks.push_back(
          {{k, k + 1, k + 2, k + side, k + side + 1, k + side + 2, k + 2 * side, k + 2 * side + 1, k + 2 * side + 2},
           low_mm + Vec2{column * step_mm.x, row * step_mm.y}});
    }
  }
}

}  // namespace

void MeshTracer::trace_grid(const Rectangle& box, int side) {
  const Vec2 size = box.high - box.low;
  rays_.trace(path_, iris_, light_, box, side, search_precision(std::min(size.x, size.y) / (side - 1)));
}

std::optional<OpenMesh> MeshTracer::coarse_mesh(Rectangle box) {
  trace_grid(box, density_.side);
  const auto is_full = [&] { return count_open(rays_) >= kFull * density_.side * density_.side; };
  for (int k = 0; k < kMaxShrinkings && !is_full(); ++k) {
    const auto lit = bounds_of_light(rays_);
    if (!lit) return std::nullopt;
    if (area_of(*lit) >= kWorthShrinking * area_of(box)) break;
    box = box.low.y == -box.high.y ? symmetric(*lit) : *lit;
    trace_grid(box, density_.side);
  }
  if (count_open(rays_) < density_.enough_open) trace_grid(box, 2 * density_.side - 1);
  OpenMesh mesh{box.low, rays_.step_mm(), rays_.sensor_x_mm, rays_.sensor_y_mm, rays_.transmission, rays_.blocked, {},
                {}};
  add_blocks(0, static_cast<std::uint32_t>(rays_.side()), {}, mesh.step_mm, mesh.blocks);
  return mesh;
}

// A finer mesh over blocks of a coarser one, whose rays are reused.
OpenMesh MeshTracer::finer_mesh(const OpenMesh& coarse, const std::vector<Block>& blocks) {
  constexpr std::uint32_t kCount = kFinerSide * kFinerSide;
  const Vec2 step = coarse.step_mm * 0.5;
  x_mm_.clear();
  y_mm_.clear();
  const auto is_coarse = [](std::uint32_t k) { return k % kFinerSide % 2 == 0 && k / kFinerSide % 2 == 0; };
  for (const Block& block : blocks) {
    for (std::uint32_t k = 0; k < kCount; ++k) {
      if (is_coarse(k)) continue;
      x_mm_.push_back(static_cast<float>(block.low_mm.x + k % kFinerSide * step.x));
      y_mm_.push_back(static_cast<float>(block.low_mm.y + k / kFinerSide * step.y));
    }
  }
  rays_.trace_points(path_, iris_, light_, coarse.origin_mm, x_mm_, y_mm_, search_precision(std::min(step.x, step.y)));
  OpenMesh mesh{coarse.origin_mm, step, {}, {}, {}, {}, {}, {}};
  const auto fill = [&](const std::vector<float>& from, const std::vector<float>& traced, std::vector<float>& to) {
    to.reserve(kCount * blocks.size());
    std::size_t next = 0;
    for (const Block& block : blocks)
      for (std::uint32_t k = 0; k < kCount; ++k)
        to.push_back(is_coarse(k) ? from[block.vertex[k / kFinerSide / 2 * 3 + k % kFinerSide / 2]] : traced[next++]);
  };
  fill(coarse.x_mm, rays_.sensor_x_mm, mesh.x_mm);
  fill(coarse.y_mm, rays_.sensor_y_mm, mesh.y_mm);
  fill(coarse.transmission, rays_.transmission, mesh.transmission);
  fill(coarse.blocked, rays_.blocked, mesh.blocked);
  std::uint32_t first = 0;
  for (const Block& block : blocks) {
    add_blocks(first, kFinerSide, block.low_mm, step, mesh.blocks);
    first += kCount;
  }
  return mesh;
}

std::vector<OpenMesh> MeshTracer::trace(const std::vector<Rectangle>& boxes) {
  std::vector<OpenMesh> meshes;
  for (const Rectangle& box : boxes)
    if (auto mesh = coarse_mesh(box)) meshes.push_back(std::move(*mesh));
  double whole = 0.0;
  for (const OpenMesh& mesh : meshes) whole += light_of(mesh);
  const std::size_t coarse = meshes.size();
  for (std::size_t k = 0; k < coarse; ++k) {
    std::size_t left = kMaxFiner;
    std::size_t at = k;
    for (int depth = 0; depth <= kMaxRefinement; ++depth) {
      const std::vector<Block> uncertain =
          weigh(meshes[at], density_.uncertain * whole, depth < kMaxRefinement ? left : 0);
      if (uncertain.empty()) break;
      left -= uncertain.size();
      meshes.push_back(finer_mesh(meshes[at], uncertain));
      at = meshes.size() - 1;
    }
  }
  return meshes;
}

}  // namespace contrejour::inline internal::pupils
