// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/pupil_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

#include "render/pupils/clearance_rays.h"
#include "render/pupils/open_halves.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kSide = 13;  // rays along a side of a grid: odd, so that one row runs along the middle
constexpr std::size_t kRays = static_cast<std::size_t>(kSide) * kSide;
constexpr std::size_t kToMiddle = static_cast<std::size_t>(kSide / 2) * kSide;  // rays before the middle row
constexpr int kEnough = 30;  // rays that get through, enough to know the shape of the open region
constexpr int kMaxGrids = 4;
constexpr std::size_t kMaxInside = 12;  // rays of the interior that are kept,
constexpr std::size_t kMaxBorder = 12;  // and rays of the border
constexpr double kRowsPerLength = 0.25 * std::numbers::pi;  // border length for each pair of neighbours across it

float length(std::array<float, 2> p) { return std::sqrt(p[0] * p[0] + p[1] * p[1]); }

// A grid of rays in the light's own frame. If that and the box are symmetric, half of the rays determine the others.
class HalvedGrid {
 public:
  HalvedGrid(const LensSteps& steps, const Ghost& ghost, const LightFrame& light, const EntranceWindow& window)
      : rays_(PacketPath(steps, ghost, {{0.0, 0.0, window.z_mm}, light.source})), symmetric_(light.symmetric),
        box_{window.min_mm, window.max_mm} {}

  void trace(const Rectangle& box) {
    box_ = box;
    cell_ = (box.high - box.low) * (1.0 / (kSide - 1));
    first_ = symmetric_ && box.low.y == -box.high.y ? kToMiddle : 0;
    rays_.resize(kRays - first_);
    const std::span<float> x_mm = rays_.x_mm(), y_mm = rays_.y_mm();
    for (std::size_t k = 0; k < rays_.count(); ++k) {
      const Vec2 from = start(first_ + k) - box.low;
      x_mm[k] = static_cast<float>(from.x);
      y_mm[k] = static_cast<float>(from.y);
    }
    rays_.trace(box.low, search_precision(std::min(cell_.x, cell_.y)));
    for (std::size_t k = 0; k < rays_.count(); ++k) {
      outside_[k] = std::numeric_limits<float>::infinity();
      if (rays_.fails(k)) continue;
      outside_[k] = length(rays_.in_circle(0, k)) - 1.0F;
      by_[k] = kRims;
      for (int c = 0; c < rays_.crossings(); ++c) {
        const float at_stop = length(stop(c, k)) - 1.0F;
        if (!(at_stop > outside_[k])) continue;
        outside_[k] = at_stop;
        by_[k] = c;
      }
    }
  }

  [[nodiscard]] const Rectangle& box() const { return box_; }
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
  [[nodiscard]] float at_stop(int crossing, std::size_t k) const { return length(stop(crossing, traced(k))); }

 private:
  // The index of the results for a ray, or for its mirror image.
  [[nodiscard]] std::size_t traced(std::size_t k) const {
    return k >= first_ ? k - first_ : (kSide - 1 - k / kSide) * kSide + k % kSide - first_;
  }
  [[nodiscard]] std::array<float, 2> stop(int crossing, std::size_t ray) const {
    return rays_.in_circle(static_cast<std::size_t>(1 + crossing), ray);
  }

  ClearanceRays rays_;
  bool symmetric_;
  Rectangle box_;
  Vec2 cell_;
  std::size_t first_ = 0;  // index of the first ray that is traced
  std::array<float, kRays> outside_{};
  std::array<int, kRays> by_{};
};

// A box around the rays that get through, or else around the one that is blocked least; empty where all fail.
std::optional<Rectangle> next_box(const HalvedGrid& grid) {
  std::optional<Rectangle> hull;
  std::size_t least_blocked = 0;
  for (std::size_t k = 0; k < kRays; ++k) {
    if (grid.outside(k) < grid.outside(least_blocked)) least_blocked = k;
    if (!grid.is_open(k)) continue;
    const Vec2 at = grid.start(k);
    if (!hull) hull = Rectangle{at, at};
    hull->low = {std::min(hull->low.x, at.x), std::min(hull->low.y, at.y)};
    hull->high = {std::max(hull->high.x, at.x), std::max(hull->high.y, at.y)};
  }
  if (!hull && std::isfinite(grid.outside(least_blocked)))
    hull = Rectangle{grid.start(least_blocked), grid.start(least_blocked)};
  if (hull) *hull = {hull->low - grid.cell(), hull->high + grid.cell()};
  return hull;
}

// At most that number of elements, evenly spaced in their order.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t max_count) {
  if (all.size() <= max_count) return all;
  std::vector<T> some;
  for (std::size_t k = 0; k < max_count; ++k) some.push_back(all[(2 * k + 1) * all.size() / (2 * max_count)]);
  return some;
}

// Finds pairs of neighbours of which one gets through and the other does not, and counts them by what blocks the other.
void find_border(const HalvedGrid& grid, PupilShape& pupil) {
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
  const auto commonest = std::ranges::max_element(pairs);
  pupil.bound = static_cast<int>(commonest - pairs.begin());
  pupil.bound_fraction = static_cast<double>(*commonest) / std::max(std::accumulate(pairs.begin(), pairs.end(), 0), 1);
  pupil.border_mm = kRowsPerLength * static_cast<double>(border.size()) * std::sqrt(grid.cell().x * grid.cell().y);
  pupil.border = thinned(border, kMaxBorder);
}

// The open area in halves of cells, where linear interpolation between rays says which part of each half is blocked.
double open_area(const HalvedGrid& grid) {
  const auto blocked = [&](std::size_t k) { return std::min(static_cast<double>(grid.outside(k)), 1.0); };
  double halves = 0.0;
  for (std::size_t k = 0; k + kSide < kRays; ++k) {
    if (k % kSide + 1 == kSide) continue;
    const double a = blocked(k), b = blocked(k + 1), c = blocked(k + kSide), d = blocked(k + kSide + 1);
    halves += fraction_below_zero(a, b, d) + fraction_below_zero(a, d, c);
  }
  return 0.5 * halves * grid.cell().x * grid.cell().y;
}

PupilShape pupil_of(const HalvedGrid& grid, int open) {
  PupilShape pupil;
  pupil.is_open = true;
  Vec2 mean;
  std::vector<Vec2> inside_mm;
  for (std::size_t k = 0; k < kRays; ++k) {
    if (!grid.is_open(k)) continue;
    mean = mean + grid.start(k) * (1.0 / open);
    inside_mm.push_back(grid.start(k));
  }
  pupil.inside_mm = thinned(inside_mm, kMaxInside);
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
    pupil.middle_mm = grid.start(k);
  }
  return pupil;
}

PupilShape in_lens_frame(PupilShape pupil, const LightFrame& light) {
  const LinearMap rotation{light.to_lens_frame({1.0, 0.0}), light.to_lens_frame({0.0, 1.0})};
  pupil.middle_mm = rotation(pupil.middle_mm);
  pupil.covariance = rotation * pupil.covariance * transposed(rotation);
  for (Vec2& inside_mm : pupil.inside_mm) inside_mm = rotation(inside_mm);
  for (BorderRay& ray : pupil.border) ray.start_mm = rotation(ray.start_mm);
  return pupil;
}

}  // namespace

std::optional<PupilShape> find_pupil_shape(const LensSteps& steps, const Ghost& ghost, const LightFrame& light,
                                           const EntranceWindow& window) {
  HalvedGrid grid(steps, ghost, light, window);
  std::optional<Rectangle> box = grid.box();
  int open = 0;
  for (int k = 0; k < kMaxGrids && box && open < kEnough; ++k) {
    grid.trace(*box);
    open = 0;
    for (std::size_t ray = 0; ray < kRays; ++ray) open += grid.is_open(ray) ? 1 : 0;
    box = next_box(grid);
  }
  if (open > 0) return in_lens_frame(pupil_of(grid, open), light);
  std::size_t least_blocked = 0;
  for (std::size_t k = 0; k < kRays; ++k)
    if (grid.outside(k) < grid.outside(least_blocked)) least_blocked = k;
  if (!std::isfinite(grid.outside(least_blocked))) return std::nullopt;
  PupilShape pupil;
  pupil.outside = grid.outside(least_blocked);
  pupil.area_mm2 = grid.cell().x * grid.cell().y;
  pupil.middle_mm = light.to_lens_frame(grid.start(least_blocked));
  return pupil;
}

}  // namespace contrejour::inline internal::pupils
