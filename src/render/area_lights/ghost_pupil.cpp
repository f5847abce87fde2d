// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/ghost_pupil.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>

#include "ghosts/open_halves.h"
#include "optics/trace/clearance.h"

namespace contrejour::inline internal::area {
namespace {

constexpr int kSide = 13;  // rays along a side of a grid: odd, so that one row runs along the middle
constexpr std::size_t kRays = static_cast<std::size_t>(kSide) * kSide;
constexpr std::size_t kPadded = clearance_padded(kRays);
constexpr std::size_t kToMiddle = static_cast<std::size_t>(kSide / 2) * kSide;  // rays before the middle row
constexpr int kEnough = 30;  // rays that get through, enough to know the shape of the open region
constexpr int kMostGrids = 4;
constexpr std::size_t kMostInside = 12;  // rays of the interior that are kept,
constexpr std::size_t kMostBorder = 12;  // and rays of the border
constexpr double kRowsPerLength = 0.25 * std::numbers::pi;  // border length for each pair of neighbours across it

struct Box {
  Vec2 low, high;
};

float length(float x, float y) { return std::sqrt(x * x + y * y); }

// A grid of rays in the light's own frame. If that and the box are symmetric, half of the rays determine the others.
class Grid {
 public:
  Grid(const LensSteps& steps, const Ghost& ghost, const LightFrame& light, const EntranceWindow& window)
      : path_(steps, ghost, {{0.0, 0.0, window.z_mm}, light.source}), symmetric_(light.symmetric),
        box_{window.min_mm, window.max_mm} {}

  void trace(const Box& box) {
    box_ = box;
    cell_ = (box.high - box.low) * (1.0 / (kSide - 1));
    first_ = symmetric_ && box.low.y == -box.high.y ? kToMiddle : 0;
    const std::size_t count = kRays - first_;
    for (std::size_t k = 0; k < clearance_padded(count); ++k) {
      const Vec2 from = start(first_ + std::min(k, count - 1)) - box.low;
      x_mm_[k] = static_cast<float>(from.x);
      y_mm_[k] = static_cast<float>(from.y);
    }
    ClearanceArrays out{field(0), field(1), field(2), field(3), {}, {}};
    const auto crossings = static_cast<std::size_t>(path_.stop_crossings());
    for (std::size_t c = 0; c < crossings; ++c) {
      out.stop_x[c] = field(4 + 2 * c);
      out.stop_y[c] = field(5 + 2 * c);
    }
    path_.start_from(box.low);
    trace_clearance(path_, search_precision(std::min(cell_.x, cell_.y)), x_mm_.data(), y_mm_.data(), count, out);
    for (std::size_t k = 0; k < count; ++k) {
      outside_[k] = std::numeric_limits<float>::infinity();
      if (field(0)[k] != 0.0F) continue;
      outside_[k] = length(field(2)[k], field(3)[k]) - 1.0F;
      by_[k] = kRims;
      for (std::size_t c = 0; c < crossings; ++c) {
        const float at_stop = length(field(4 + 2 * c)[k], field(5 + 2 * c)[k]) - 1.0F;
        if (!(at_stop > outside_[k])) continue;
        outside_[k] = at_stop;
        by_[k] = static_cast<int>(c);
      }
    }
  }

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] Vec2 cell() const { return cell_; }
  [[nodiscard]] Vec2 start(std::size_t k) const {
    const std::size_t column = k % kSide, row = k / kSide;
    return box_.low + Vec2{static_cast<double>(column) * cell_.x, static_cast<double>(row) * cell_.y};
  }
  // The excess of a ray over the bound that it comes closest to or is blocked by, relative to that bound's radius; and
  // the bound.
  [[nodiscard]] float outside(std::size_t k) const { return outside_[traced(k)]; }
  [[nodiscard]] bool is_open(std::size_t k) const { return outside(k) <= 0.0F; }
  [[nodiscard]] int by(std::size_t k) const { return by_[traced(k)]; }
  // The distance from the middle of the stop.
  [[nodiscard]] float at_stop(int crossing, std::size_t k) const {
    const auto c = static_cast<std::size_t>(crossing);
    const std::size_t at = traced(k);
    return length(fields_[(4 + 2 * c) * kPadded + at], fields_[(5 + 2 * c) * kPadded + at]);
  }

 private:
  // The index of the results for a ray, or for its mirror image.
  [[nodiscard]] std::size_t traced(std::size_t k) const {
    return k >= first_ ? k - first_ : (kSide - 1 - k / kSide) * kSide + k % kSide - first_;
  }
  [[nodiscard]] float* field(std::size_t k) { return fields_.data() + k * kPadded; }

  PacketPath path_;
  bool symmetric_;
  Box box_;
  Vec2 cell_;
  std::size_t first_ = 0;  // index of the first ray that is traced
  std::array<float, kPadded> x_mm_{}, y_mm_{};
  std::array<float, (4 + 2 * kMaxStopCrossings) * kPadded> fields_{};
  std::array<float, kRays> outside_{};
  std::array<int, kRays> by_{};
};

// A box around the rays that get through, or else around the one that is blocked least; empty where all fail.
std::optional<Box> next_box(const Grid& grid) {
  std::optional<Box> hull;
  std::size_t least = 0;
  for (std::size_t k = 0; k < kRays; ++k) {
    if (grid.outside(k) < grid.outside(least)) least = k;
    if (!grid.is_open(k)) continue;
    const Vec2 at = grid.start(k);
    if (!hull) hull = Box{at, at};
    hull->low = {std::min(hull->low.x, at.x), std::min(hull->low.y, at.y)};
    hull->high = {std::max(hull->high.x, at.x), std::max(hull->high.y, at.y)};
  }
  if (!hull && std::isfinite(grid.outside(least))) hull = Box{grid.start(least), grid.start(least)};
  if (hull) *hull = {hull->low - grid.cell(), hull->high + grid.cell()};
  return hull;
}

// At most that number of elements, evenly spaced in their order.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<T> some;
  for (std::size_t k = 0; k < most; ++k) some.push_back(all[(2 * k + 1) * all.size() / (2 * most)]);
  return some;
}

// Finds pairs of neighbours of which one gets through and the other does not, and counts them by what blocks the other.
void find_border(const Grid& grid, GhostPupil& pupil) {
  std::array<int, kMaxStopCrossings + 1> pairs{};
  std::vector<BorderRay> border;
  const auto count = [&](std::size_t a, std::size_t b) {
    if (grid.is_open(a) == grid.is_open(b)) return;
    const std::size_t open = grid.is_open(a) ? a : b, blocked = grid.is_open(a) ? b : a;
    if (!std::isfinite(grid.outside(blocked))) return;
    ++pairs[static_cast<std::size_t>(grid.by(blocked))];
    border.push_back({grid.start(open), grid.by(blocked)});
  };
  for (std::size_t k = 0; k < kRays; ++k) {
    if (k % kSide + 1 < kSide) count(k, k + 1);
    if (k + kSide < kRays) count(k, k + kSide);
  }
  const auto most = std::ranges::max_element(pairs);
  pupil.bound = static_cast<int>(most - pairs.begin());
  pupil.bound_share = static_cast<double>(*most) / std::max(std::accumulate(pairs.begin(), pairs.end(), 0), 1);
  pupil.border_mm = kRowsPerLength * static_cast<double>(border.size()) * std::sqrt(grid.cell().x * grid.cell().y);
  pupil.border = thinned(border, kMostBorder);
}

// The open area in halves of cells, where linear interpolation between rays says which part of each half is blocked.
double open_area(const Grid& grid) {
  const auto blocked = [&](std::size_t k) { return std::min(static_cast<double>(grid.outside(k)), 1.0); };
  double halves = 0.0;
  for (std::size_t k = 0; k + kSide < kRays; ++k) {
    if (k % kSide + 1 == kSide) continue;
    const double a = blocked(k), b = blocked(k + 1), c = blocked(k + kSide), d = blocked(k + kSide + 1);
    halves += fraction_below_zero(a, b, d) + fraction_below_zero(a, d, c);
  }
  return 0.5 * halves * grid.cell().x * grid.cell().y;
}

GhostPupil pupil_of(const Grid& grid, int open) {
  GhostPupil pupil;
  pupil.is_open = true;
  Vec2 mean;
  std::vector<Vec2> inside_mm;
  for (std::size_t k = 0; k < kRays; ++k) {
    if (!grid.is_open(k)) continue;
    mean = mean + grid.start(k) * (1.0 / open);
    inside_mm.push_back(grid.start(k));
  }
  pupil.inside_mm = thinned(inside_mm, kMostInside);
  const Vec2 cell = grid.cell();
  pupil.covariance = {{cell.x * cell.x / 12.0, 0.0}, {0.0, cell.y * cell.y / 12.0}};
  pupil.area_mm2 = open_area(grid);
  find_border(grid, pupil);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < kRays; ++k) {
    if (!grid.is_open(k)) continue;
    const Vec2 d = grid.start(k) - mean;
    pupil.covariance = pupil.covariance + LinearMap{d * (d.x / open), d * (d.y / open)};
    const double from_middle = pupil.is_whole() ? grid.at_stop(pupil.bound, k) : length(d);
    if (!(from_middle < nearest)) continue;
    nearest = from_middle;
    pupil.at_mm = grid.start(k);
  }
  return pupil;
}

GhostPupil in_place(GhostPupil pupil, const LightFrame& light) {
  const LinearMap turn{light.into_place({1.0, 0.0}), light.into_place({0.0, 1.0})};
  pupil.at_mm = turn(pupil.at_mm);
  pupil.covariance = turn * pupil.covariance * transposed(turn);
  for (Vec2& inside_mm : pupil.inside_mm) inside_mm = turn(inside_mm);
  for (BorderRay& ray : pupil.border) ray.start_mm = turn(ray.start_mm);
  return pupil;
}

}  // namespace

std::optional<GhostPupil> find_ghost_pupil(const LensSteps& steps, const Ghost& ghost, const LightFrame& light,
                                           const EntranceWindow& window) {
  Grid grid(steps, ghost, light, window);
  std::optional<Box> box = grid.box();
  int open = 0;
  for (int k = 0; k < kMostGrids && box && open < kEnough; ++k) {
    grid.trace(*box);
    open = 0;
    for (std::size_t ray = 0; ray < kRays; ++ray) open += grid.is_open(ray) ? 1 : 0;
    box = next_box(grid);
  }
  if (open > 0) return in_place(pupil_of(grid, open), light);
  std::size_t least = 0;
  for (std::size_t k = 0; k < kRays; ++k)
    if (grid.outside(k) < grid.outside(least)) least = k;
  if (!std::isfinite(grid.outside(least))) return std::nullopt;
  GhostPupil pupil;
  pupil.outside = grid.outside(least);
  pupil.area_mm2 = grid.cell().x * grid.cell().y;
  pupil.at_mm = light.into_place(grid.start(least));
  return pupil;
}

}  // namespace contrejour::inline internal::area
