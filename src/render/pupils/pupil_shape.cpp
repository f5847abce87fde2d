// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/pupil_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "render/pupils/clearance_rays.h"
#include "render/pupils/open_polygon.h"
#include "render/pupils/pupil_search.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr std::size_t kSide = 13;  // rays along a side of a grid: odd, so that one row runs along the middle
constexpr std::size_t kFineSide = 25;  // the same for a pupil so narrow that few rays get through
constexpr std::size_t kFineRays = kFineSide * kFineSide;
constexpr std::size_t kBounds = kMaxStopCrossings + 1;  // kRims is the last
constexpr int kEnough = 30;  // rays that get through, enough to know the shape of the open region
constexpr int kNarrow = 60;  // rays that get through: with fewer the shape is measured with a fine grid
constexpr double kBeside = 0.5;  // of the coarse grid's box: where the fine grid looks for more light on each side
constexpr int kFew = 4;  // of the first grid's: so few may be those of a small opening beside the pupil
constexpr int kMinGrids = 2, kMaxGrids = 4;
// A bound counts at a border if the excess over it is less than the largest one by no more than this part of the
// change of the excess over the triangle.
constexpr double kClose = 0.1;
constexpr std::size_t kBlocks = 4;  // along a side of the grid: each gives a point of the interior, and of each border

float length(std::array<float, 2> p) { return std::sqrt(p[0] * p[0] + p[1] * p[1]); }

// A grid of rays in the light's own frame. If that and the box are symmetric, half of the rays determine the others.
class HalvedGrid {
 public:
  HalvedGrid(const LensSteps& steps, const Ghost& ghost, const LightFrame& light, const EntranceWindow& window)
      : rays_(PacketPath(steps, ghost, {{0.0, 0.0, window.z_mm}, light.source})), symmetric_(light.symmetric),
        box_{window.min_mm, window.max_mm} {}

  // side: rays along a side, kSide or kFineSide.
  void trace(const Rectangle& box, std::size_t side) {
    box_ = box;
    side_ = side;
    cell_ = (box.high - box.low) * (1.0 / (static_cast<double>(side) - 1.0));
    first_ = symmetric_ && box.low.y == -box.high.y ? side / 2 * side : 0;  // that of the middle row
    rays_.resize(count() - first_);
    const std::span<float> x_mm = rays_.x_mm(), y_mm = rays_.y_mm();
    for (std::size_t k = 0; k < rays_.count(); ++k) {
      const Vec2 from = start(first_ + k) - box.low;
      x_mm[k] = static_cast<float>(from.x);
      y_mm[k] = static_cast<float>(from.y);
    }
    rays_.trace(box.low, search_precision(std::min(cell_.x, cell_.y)));
    for (std::size_t k = 0; k < rays_.count(); ++k) {
      outside_[k] = std::numeric_limits<float>::infinity();
      outside_by_[k].fill(outside_[k]);
      if (rays_.fails(k)) continue;
      outside_by_[k].fill(-1.0F);
      for (int c = 0; c < rays_.crossings(); ++c)
        outside_by_[k][static_cast<std::size_t>(c)] = length(stop(c, k)) - 1.0F;
      outside_by_[k][kRims] = length(rays_.in_circle(0, k)) - 1.0F;
      outside_[k] = *std::ranges::max_element(outside_by_[k]);
    }
  }

  [[nodiscard]] const Rectangle& box() const { return box_; }
  [[nodiscard]] std::size_t side() const { return side_; }
  [[nodiscard]] std::size_t count() const { return side_ * side_; }
  [[nodiscard]] int open_rays() const {
    int open = 0;
    for (std::size_t k = 0; k < count(); ++k) open += is_open(k) ? 1 : 0;
    return open;
  }
  [[nodiscard]] std::size_t least_blocked() const {
    std::size_t least = 0;
    for (std::size_t k = 1; k < count(); ++k)
      if (outside(k) < outside(least)) least = k;
    return least;
  }
  [[nodiscard]] Vec2 cell() const { return cell_; }
  [[nodiscard]] Vec2 start(std::size_t k) const {
    const std::size_t column = k % side_, row = k / side_;
    return box_.low + Vec2{static_cast<double>(column) * cell_.x, static_cast<double>(row) * cell_.y};
  }
  // The excess of a ray over the bound that it comes closest to or is blocked by, relative to that bound's radius.
  [[nodiscard]] float outside(std::size_t k) const { return outside_[traced(k)]; }
  [[nodiscard]] bool is_open(std::size_t k) const { return outside(k) <= 0.0F; }
  // The same for linear interpolation, and over one bound: rays that fail, and those far outside, do not count more
  // than others.
  [[nodiscard]] double excess(std::size_t k) const { return std::min(static_cast<double>(outside(k)), 1.0); }
  [[nodiscard]] double excess_over(std::size_t bound, std::size_t k) const {
    return std::min(static_cast<double>(outside_by_[traced(k)][bound]), 1.0);
  }
  // The box, made symmetric where the grid is, in spite of rounding: then half of the next grid determines the other.
  [[nodiscard]] Rectangle balanced(Rectangle box) const {
    if (first_ > 0) {
      box.high.y = std::max(-box.low.y, box.high.y);
      box.low.y = -box.high.y;
    }
    return box;
  }

 private:
  // The index of the results for a ray, or for its mirror image.
  [[nodiscard]] std::size_t traced(std::size_t k) const {
    return k >= first_ ? k - first_ : (side_ - 1 - k / side_) * side_ + k % side_ - first_;
  }
  [[nodiscard]] std::array<float, 2> stop(int crossing, std::size_t ray) const {
    return rays_.in_circle(static_cast<std::size_t>(1 + crossing), ray);
  }

  ClearanceRays rays_;
  bool symmetric_;
  Rectangle box_;
  Vec2 cell_;
  std::size_t side_ = kSide;
  std::size_t first_ = 0;  // index of the first ray that is traced
  std::array<float, kFineRays> outside_{};
  std::array<std::array<float, kBounds>, kFineRays> outside_by_{};
};

// A box around the open parts of all lines of the grid, or else around the ray that is blocked least; empty where all
// fail.
std::optional<Rectangle> next_box(const HalvedGrid& grid) {
  std::optional<Rectangle> hull;
  const auto include = [&](Vec2 at) {
    if (!hull) hull = Rectangle{at, at};
    hull->low = {std::min(hull->low.x, at.x), std::min(hull->low.y, at.y)};
    hull->high = {std::max(hull->high.x, at.x), std::max(hull->high.y, at.y)};
  };
  const auto include_crossing = [&](std::size_t a, std::size_t b) {
    if (grid.is_open(a) == grid.is_open(b)) return;
    const double from = grid.excess(a), to = grid.excess(b);
    include(grid.start(a) + (grid.start(b) - grid.start(a)) * (from / (from - to)));
  };
  for (std::size_t k = 0; k < grid.count(); ++k) {
    if (grid.is_open(k)) include(grid.start(k));
    if (k % grid.side() + 1 < grid.side()) include_crossing(k, k + 1);
    if (k + grid.side() < grid.count()) include_crossing(k, k + grid.side());
  }
  const std::size_t least_blocked = grid.least_blocked();
  if (!hull && std::isfinite(grid.outside(least_blocked))) include(grid.start(least_blocked));
  if (!hull) return hull;
  *hull = {hull->low - grid.cell(), hull->high + grid.cell()};
  return grid.balanced(*hull);
}

// A box around all light, for a pupil that is smaller than the cells of a grid over the window. The ray that is blocked
// least may lie far from it, beside an opening that is smaller still. Empty where nothing gets through, and without
// symmetry, for which such a search takes too long.
std::optional<Rectangle> searched_box(const LensSteps& steps, const Ghost& ghost, const LightFrame& light,
                                      const EntranceWindow& window) {
  if (!light.symmetric) return std::nullopt;
  const LightRays rays{{0.0, 0.0, window.z_mm}, light.source};
  const Pupil found = find_pupil(PupilRays(PacketPath(steps, ghost, rays), window), {.along_meridian = true});
  std::optional<Rectangle> hull;
  for (const Rectangle& box : found.boxes) {
    const double beside_mm = std::max(std::abs(box.low.y), std::abs(box.high.y));  // and its mirror image
    const Rectangle both{{box.low.x, -beside_mm}, {box.high.x, beside_mm}};
    hull = hull ? Rectangle{{std::min(hull->low.x, both.low.x), std::min(hull->low.y, both.low.y)},
                            {std::max(hull->high.x, both.high.x), std::max(hull->high.y, both.high.y)}}
                : both;
  }
  return hull;
}

// The rays that get through, of the first grid and of the last one.
struct Traced {
  int first_open = 0, open = 0;
};

// Grids over this box, then each over the open part of the one before.
Traced trace_grids(HalvedGrid& grid, std::optional<Rectangle> box) {
  Traced traced;
  for (int k = 0; k < kMaxGrids && box && (k < kMinGrids || traced.open < kEnough); ++k) {
    grid.trace(*box, kSide);
    traced.open = grid.open_rays();
    if (k == 0) traced.first_open = traced.open;
    box = next_box(grid);
  }
  return traced;
}

// Whether light gets through at a border of the grid inside the window: there may be more beyond.
bool is_cut(const HalvedGrid& grid, const EntranceWindow& window) {
  const Vec2 low = grid.box().low - window.min_mm, high = window.max_mm - grid.box().high;
  const std::size_t side = grid.side(), last = side - 1;
  for (std::size_t k = 0; k < side; ++k) {
    if (low.x > grid.cell().x && grid.is_open(k * side)) return true;
    if (high.x > grid.cell().x && grid.is_open(k * side + last)) return true;
    if (low.y > grid.cell().y && grid.is_open(k)) return true;
    if (high.y > grid.cell().y && grid.is_open(last * side + k)) return true;
  }
  return false;
}

// A coarse grid misses the ends of parts that are thinner than its cells, and its box does not contain them: a first
// fine grid, with cells no larger than the coarse one's, finds the box that the second one measures.
void trace_finely(HalvedGrid& grid, const EntranceWindow& window) {
  const Rectangle coarse = grid.box();
  const Vec2 beside = (coarse.high - coarse.low) * kBeside, low = coarse.low - beside, high = coarse.high + beside;
  grid.trace({{std::max(low.x, window.min_mm.x), std::max(low.y, window.min_mm.y)},
              {std::min(high.x, window.max_mm.x), std::min(high.y, window.max_mm.y)}},
             kFineSide);
  if (const auto open = next_box(grid)) grid.trace(*open, kFineSide);
  if (grid.open_rays() == 0) grid.trace(coarse, kFineSide);  // whose rays include the coarse grid's
}

// Collects the open parts of a grid's triangles by blocks of cells.
class PupilSum {
 public:
  explicit PupilSum(const HalvedGrid& grid) : grid_(grid) {
    const std::size_t cells = grid.side() - 1, in_block = cells / kBlocks;
    for (std::size_t row = 0; row < cells; ++row)
      for (std::size_t column = 0; column < cells; ++column)
        add_cell(row * grid.side() + column, (row / in_block) * kBlocks + column / in_block);
  }

  [[nodiscard]] PupilShape pupil() const {
    PupilShape pupil;
    pupil.is_open = true;
    AreaMoments all;
    for (const Block& block : blocks_) {
      all.add(block.open, 1.0);
      for (const Border& border : block.borders) pupil.border_mm += border.length_mm;
    }
    pupil.area_mm2 = all.area_mm2;
    if (!(all.area_mm2 > 0.0)) return pupil;
    pupil.middle_mm = all.centroid();
    pupil.covariance = all.covariance();
    for (const Block& block : blocks_) {
      if (block.open.area_mm2 > 0.0)
        pupil.inside.push_back({block.open.centroid(), block.open.area_mm2 / all.area_mm2, block.open.covariance()});
      for (std::size_t bound = 0; bound < block.borders.size(); ++bound) {
        const Border& border = block.borders[bound];
        if (!(border.length_mm > 0.0)) continue;
        pupil.bound_fractions[bound] += border.length_mm / pupil.border_mm;
        pupil.border.push_back({border.sum * (1.0 / border.length_mm), static_cast<int>(bound), border.length_mm});
      }
    }
    return pupil;
  }

 private:
  struct Border {
    double length_mm = 0.0;
    Vec2 sum;  // of the positions, by length
  };
  struct Block {
    AreaMoments open;
    std::array<Border, kBounds> borders{};  // by what bounds them
  };

  // A cell is halved along both diagonals, so that a pupil and its mirror image measure the same.
  void add_cell(std::size_t first, std::size_t block) {
    const std::array<std::size_t, 4> corner{first, first + 1, first + grid_.side() + 1, first + grid_.side()};
    const auto open = std::ranges::count_if(corner, [&](std::size_t k) { return grid_.is_open(k); });
    for (std::size_t k = 0; open > 0 && k < 4; ++k)
      add_triangle({corner[k], corner[(k + 1) % 4], corner[(k + 2) % 4]}, blocks_[block]);
  }

  void add_triangle(const std::array<std::size_t, 3>& vertex, Block& block) {
    constexpr double kWeight = 0.5;  // each point of a cell lies in two triangles
    std::array<Vec2, 3> at;
    std::array<double, 3> outside{};
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = grid_.start(vertex[k]);
      outside[k] = grid_.excess(vertex[k]);
    }
    const OpenPolygon open = open_polygon(at, outside);
    block.open.add(open.moments, kWeight);
    if (open.has_border) add_border(open, vertex, kWeight, block);
  }

  // A border belongs to the bound over which the excess is largest at the border itself, which need not be the one that
  // blocks a ray beyond it most. Where several bounds are nearly as close, they share it.
  void add_border(const OpenPolygon& open, const std::array<std::size_t, 3>& vertex, double weight, Block& block) {
    const std::array<double, 3> at = weights_at(vertex, (open.border[0] + open.border[1]) * 0.5);
    const auto blocked = [&](std::size_t k) { return !grid_.is_open(k) && std::isfinite(grid_.outside(k)); };
    if (std::ranges::none_of(vertex, blocked)) return;  // the rays beyond it fail
    std::array<double, kBounds> excess{}, part{};
    for (std::size_t bound = 0; bound < kBounds; ++bound)
      for (std::size_t k = 0; k < 3; ++k) excess[bound] += at[k] * grid_.excess_over(bound, vertex[k]);
    const auto [least, most] = std::ranges::minmax(vertex, {}, [&](std::size_t k) { return grid_.excess(k); });
    const double close = kClose * (grid_.excess(most) - grid_.excess(least));
    const double largest = *std::ranges::max_element(excess);
    double all = 0.0;
    for (std::size_t bound = 0; bound < kBounds; ++bound)
      all += part[bound] = std::max(1.0 - (largest - excess[bound]) / std::max(close, 1e-12), 0.0);
    const double length_mm = weight * length(open.border[1] - open.border[0]);
    for (std::size_t bound = 0; bound < kBounds; ++bound) {
      if (!(part[bound] > 0.0)) continue;
      Border& border = block.borders[bound];
      const double own_mm = length_mm * part[bound] / all;
      border.length_mm += own_mm;
      border.sum = border.sum + (open.border[0] + open.border[1]) * (0.5 * own_mm);
    }
  }

  // The barycentric coordinates of a point in a triangle.
  [[nodiscard]] std::array<double, 3> weights_at(const std::array<std::size_t, 3>& vertex, Vec2 p) const {
    const Vec2 a = grid_.start(vertex[0]), b = grid_.start(vertex[1]), c = grid_.start(vertex[2]);
    const double area = cross(b - a, c - a);
    const double of_b = cross(p - a, c - a) / area, of_c = cross(b - a, p - a) / area;
    return {1.0 - of_b - of_c, of_b, of_c};
  }

  const HalvedGrid& grid_;
  std::array<Block, kBlocks * kBlocks> blocks_{};
};

PupilShape in_lens_frame(PupilShape pupil, const LightFrame& light) {
  const LinearMap rotation{light.to_lens_frame({1.0, 0.0}), light.to_lens_frame({0.0, 1.0})};
  pupil.middle_mm = rotation(pupil.middle_mm);
  pupil.covariance = mapped_covariance(rotation, pupil.covariance);
  for (InnerPoint& point : pupil.inside) {
    point.start_mm = rotation(point.start_mm);
    point.covariance = mapped_covariance(rotation, point.covariance);
  }
  for (BorderPoint& point : pupil.border) point.start_mm = rotation(point.start_mm);
  return pupil;
}

}  // namespace

std::optional<PupilShape> find_pupil_shape(const LensSteps& steps, const Ghost& ghost, const LightFrame& light,
                                           const EntranceWindow& window) {
  HalvedGrid grid(steps, ghost, light, window);
  Traced traced = trace_grids(grid, grid.box());
  if (traced.first_open < kFew) {
    const auto searched = searched_box(steps, ghost, light, window);
    // The grids may have closed in on a part of the pupil only.
    if (searched && (traced.open == 0 || area_of(grid.box()) < area_of(*searched)))
      traced = trace_grids(grid, *searched);
  }
  if (traced.open > 0 && (traced.open < kNarrow || is_cut(grid, window))) trace_finely(grid, window);
  if (traced.open > 0) return in_lens_frame(PupilSum(grid).pupil(), light);
  const std::size_t least_blocked = grid.least_blocked();
  if (!std::isfinite(grid.outside(least_blocked))) return std::nullopt;
  PupilShape pupil;
  pupil.outside = grid.outside(least_blocked);
  pupil.area_mm2 = grid.cell().x * grid.cell().y;
  pupil.middle_mm = light.to_lens_frame(grid.start(least_blocked));
  return pupil;
}

}  // namespace contrejour::inline internal::pupils
