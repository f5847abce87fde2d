// SPDX-License-Identifier: Apache-2.0
#include "render/tiled/primitive_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::inline internal::tiled {
namespace {

// The map is not smooth where the areas of the cells around a vertex differ by more than this factor.
constexpr float kSmoothRatio = 1.5F;
// If a primitive's area is below this fraction of its extent squared, it is mostly rounding error and contains no
// pixel's middle.
constexpr double kSliver = 1e-7;

// Pixels are sampled at their middles. An uniform streak narrower than kNarrow_px may lie between all middles, or
// have all of its light counted several times: it is widened to kWidened_px with its flux unchanged.
constexpr double kNarrow_px = 0.25, kWidened_px = 3.0;
constexpr double kMaxWidening = 1e6;  // limits the factor where a width is mere rounding error

// The square of the diagonal of the bounds.
double extent_squared(const Primitive& p) {
  const auto [x0, x1] = std::minmax_element(p.x.begin(), p.x.end());
  const auto [y0, y1] = std::minmax_element(p.y.begin(), p.y.end());
  const double dx = static_cast<double>(*x1) - *x0;
  const double dy = static_cast<double>(*y1) - *y0;
  return dx * dx + dy * dy;
}

// The unit of gamma: half the frame's width, that of a GPU's screen coordinates. The paper names none; with this one
// its light and heavy thresholds leave about as many primitives as its table 5 lists.
double merge_unit_px(const Frame& frame) { return 0.5 * frame.full_width; }

}  // namespace

PrimitiveBuilder::PrimitiveBuilder(const Frame& frame, const TiledOptions& options)
    : frame_(frame), merge_steps_(options.merge_steps),
      merge_threshold_px_(static_cast<float>(options.merge_threshold * merge_unit_px(frame))) {}

void PrimitiveBuilder::place_vertices(const RayGrid& grid, Vec2 shift_mm) {
  const std::size_t count = grid.sensor_x_mm.size();
  x_.resize(count);
  y_.resize(count);
  const double scale = 1.0 / frame_.pixel_pitch_mm;
  const Vec2 axis = frame_.pixel_from_sensor(shift_mm);
  for (std::size_t k = 0; k < count; ++k) {
    x_[k] = static_cast<float>(axis.x - grid.sensor_x_mm[k] * scale);
    y_[k] = static_cast<float>(axis.y + grid.sensor_y_mm[k] * scale);
  }
}

// Widens the ghost along each principal axis of its visible vertices along which it is too narrow for sampling at
// pixels' middles.
void PrimitiveBuilder::widen(const RayGrid& grid) {
  double count = 0.0, mx = 0.0, my = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t k = 0; k < x_.size(); ++k) {
    if (!(grid.blocked[k] <= 0.0F)) continue;
    const double x = x_[k], y = y_[k];
    count += 1.0, mx += x, my += y;
  }
  if (count < 3.0) return;
  mx /= count, my /= count;
  for (std::size_t k = 0; k < x_.size(); ++k) {
    if (!(grid.blocked[k] <= 0.0F)) continue;
    const double x = x_[k] - mx, y = y_[k] - my;
    xx += x * x, xy += x * y, yy += y * y;
  }
  const double axis_angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const Vec2 along{std::cos(axis_angle), std::sin(axis_angle)};
  const double mean = 0.5 * (xx + yy), half_difference = std::hypot(0.5 * (xx - yy), xy);
  // The variance of a uniform distribution is a twelfth of its width squared.
  const auto times = [&](double squares) {
    const double width_px = std::sqrt(12.0 * std::max(squares, 0.0) / count);
    return width_px < kNarrow_px ? std::min(kWidened_px / std::max(width_px, 1e-12), kMaxWidening) : 1.0;
  };
  const double by_along = times(mean + half_difference), by_across = times(mean - half_difference);
  if (by_along == 1.0 && by_across == 1.0) return;
  for (std::size_t k = 0; k < x_.size(); ++k) {
    const Vec2 from{x_[k] - mx, y_[k] - my};
    const double a = by_along * dot(from, along), b = by_across * (along.x * from.y - along.y * from.x);
    x_[k] = static_cast<float>(mx + a * along.x - b * along.y);
    y_[k] = static_cast<float>(my + a * along.y + b * along.x);
  }
}

double PrimitiveBuilder::twice_area(std::size_t i, std::size_t j, std::size_t k) const {
  const double ax = static_cast<double>(x_[j]) - x_[i];
  const double ay = static_cast<double>(y_[j]) - y_[i];
  const double bx = static_cast<double>(x_[k]) - x_[i];
  const double by = static_cast<double>(y_[k]) - y_[i];
  return ax * by - bx * ay;
}

bool PrimitiveBuilder::is_convex(const std::array<std::size_t, 4>& corners) const {
  bool left = true;
  bool right = true;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t a = corners[k];
    const std::size_t b = corners[(k + 1) % 4];
    const std::size_t c = corners[(k + 2) % 4];
    const float cross_product = (x_[b] - x_[a]) * (y_[c] - y_[b]) - (x_[c] - x_[b]) * (y_[b] - y_[a]);
    left = left && cross_product > 0.0F;
    right = right && cross_product < 0.0F;
  }
  return left || right;
}

void PrimitiveBuilder::find_cells(const RayGrid& grid) {
  const int n = grid.cells();
  const auto pitch = static_cast<std::size_t>(n) + 2;
  area_.resize(pitch * pitch);
  state_.resize(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  levels_[0].is_whole.resize(state_.size());
  levels_[0].flux.resize(state_.size());
  levels_[0].side = n;
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      const auto v = grid.corners(ix, iy);
      const std::size_t cell = levels_[0].at(ix, iy);
      const auto any = [&](auto test) { return test(v[0]) || test(v[1]) || test(v[2]) || test(v[3]); };
      const bool failed = any([&](std::size_t k) { return !std::isfinite(grid.relative_height[k]); });
      const float slack = grid.slack(v);
      const bool lit = any([&](std::size_t k) { return grid.blocked[k] <= slack; });
      area_[(static_cast<std::size_t>(iy) + 1) * pitch + static_cast<std::size_t>(ix) + 1] =
          failed
              ? std::numeric_limits<float>::quiet_NaN()
              : 0.5F * ((x_[v[2]] - x_[v[0]]) * (y_[v[3]] - y_[v[1]]) - (x_[v[3]] - x_[v[1]]) * (y_[v[2]] - y_[v[0]]));
      state_[cell] = !lit ? CellState::Dark : !failed && is_convex(v) ? CellState::Whole : CellState::InTriangles;
      levels_[0].is_whole[cell] = state_[cell] == CellState::Whole ? 1 : 0;
      const auto& t = grid.transmission;
      levels_[0].flux[cell] =
          static_cast<float>(triangle_weight_mm2_ / 3.0) * (2.0F * (t[v[0]] + t[v[2]]) + t[v[1]] + t[v[3]]);
    }
  }
}

// hullin2011 4.3: the flux of the cells around a vertex over their area. 0 where one of them is folded, has a failed
// ray or is much larger than another. Cells beyond the grid's border count as those inside it.
void PrimitiveBuilder::find_irradiance(const RayGrid& grid) {
  const int n = grid.cells();
  const auto pitch = static_cast<std::size_t>(n) + 2;
  const auto last = static_cast<std::size_t>(n);
  for (std::size_t iy = 1; iy <= last; ++iy) {
    area_[iy * pitch] = area_[iy * pitch + 1];
    area_[iy * pitch + last + 1] = area_[iy * pitch + last];
  }
  std::copy_n(area_.begin() + static_cast<std::ptrdiff_t>(pitch), pitch, area_.begin());
  std::copy_n(area_.begin() + static_cast<std::ptrdiff_t>(last * pitch), pitch,
              area_.begin() + static_cast<std::ptrdiff_t>((last + 1) * pitch));
  irradiance_.resize(x_.size());
  for (std::size_t iy = 0; iy <= last; ++iy) {
    const float* above = area_.data() + iy * pitch;
    const float* below = above + pitch;
    const float* transmission = grid.transmission.data() + grid.at(0, static_cast<int>(iy));
    float* out = irradiance_.data() + grid.at(0, static_cast<int>(iy));
    for (std::size_t ix = 0; ix <= last; ++ix) {
      const float a = above[ix];
      const float b = above[ix + 1];
      const float c = below[ix];
      const float d = below[ix + 1];
      const float sum = (a + b) + (c + d);
      const float low = std::min(std::min(a, b), std::min(c, d));
      const float high = std::max(std::max(a, b), std::max(c, d));
      const float smallest = std::min(std::abs(low), std::abs(high));
      const float largest = std::max(std::abs(low), std::abs(high));
      const bool smooth = sum == sum && low * high > 0.0F && largest < kSmoothRatio * smallest;
      out[ix] = smooth ? 4.0F * transmission[ix] / std::abs(sum) : 0.0F;
    }
  }
}

// bodonyi2023 eq. 11 and 12 for a block of 2 x 2 primitives that a primitive of level `step` would replace. Among the
// edges between its nine vertices, each is compared with the next in its line and with the next parallel to it; the
// differences of parallel edges are the same for both directions, so one is computed.
// Differs: the printed sum is signed, so that any change to the left or down would pass; absolute values are meant.
bool PrimitiveBuilder::is_flat(const RayGrid& grid, int step, int ix, int iy) const {
  const int half = 1 << (step - 1);
  const auto x = [&](int column, int row) { return x_[grid.at((2 * ix + column) * half, (2 * iy + row) * half)]; };
  const auto y = [&](int column, int row) { return y_[grid.at((2 * ix + column) * half, (2 * iy + row) * half)]; };
  const auto same = [&](float dx, float dy) { return std::abs(dx) + std::abs(dy) < merge_threshold_px_; };
  for (int k = 0; k < 3; ++k) {
    if (!same(x(0, k) - 2.0F * x(1, k) + x(2, k), y(0, k) - 2.0F * y(1, k) + y(2, k))) return false;
    if (!same(x(k, 0) - 2.0F * x(k, 1) + x(k, 2), y(k, 0) - 2.0F * y(k, 1) + y(k, 2))) return false;
  }
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      const float dx = (x(column + 1, row) - x(column, row)) - (x(column + 1, row + 1) - x(column, row + 1));
      const float dy = (y(column + 1, row) - y(column, row)) - (y(column + 1, row + 1) - y(column, row + 1));
      if (!same(dx, dy)) return false;
    }
  }
  return true;
}

// Whether the block's nine vertices pass all rims and obscurations: a merged primitive interpolates between the four
// corners alone.
bool PrimitiveBuilder::is_open(const RayGrid& grid, int step, int ix, int iy) const {
  const int half = 1 << (step - 1);
  for (int k = 0; k < 9; ++k)
    if (grid.relative_height[grid.at((2 * ix + k % 3) * half, (2 * iy + k / 3) * half)] > 1.0F) return false;
  return true;
}

void PrimitiveBuilder::merge(const RayGrid& grid) {
  for (int step = 1; step <= merge_steps_; ++step) {
    const Level& finer = levels_[static_cast<std::size_t>(step) - 1];
    Level& level = levels_[static_cast<std::size_t>(step)];
    level.side = finer.side / 2;
    level.is_whole.assign(static_cast<std::size_t>(level.side) * static_cast<std::size_t>(level.side), 0);
    level.flux.resize(level.is_whole.size());
    const int size = 1 << step;
    for (int iy = 0; iy < level.side; ++iy) {
      for (int ix = 0; ix < level.side; ++ix) {
        const std::array<std::size_t, 4> parts{finer.at(2 * ix, 2 * iy), finer.at(2 * ix + 1, 2 * iy),
                                               finer.at(2 * ix, 2 * iy + 1), finer.at(2 * ix + 1, 2 * iy + 1)};
        const auto is_whole = [&](std::size_t k) { return finer.is_whole[k] != 0; };
        if (!std::all_of(parts.begin(), parts.end(), is_whole) || !is_flat(grid, step, ix, iy)) continue;
        const std::array<std::size_t, 4> corners{grid.at(ix * size, iy * size), grid.at((ix + 1) * size, iy * size),
                                                 grid.at((ix + 1) * size, (iy + 1) * size),
                                                 grid.at(ix * size, (iy + 1) * size)};
        if (!is_convex(corners) || (grid.is_obscured() && !is_open(grid, step, ix, iy))) continue;
        level.is_whole[level.at(ix, iy)] = 1;
        level.flux[level.at(ix, iy)] =
            (finer.flux[parts[0]] + finer.flux[parts[1]]) + (finer.flux[parts[2]] + finer.flux[parts[3]]);
      }
    }
  }
}

void PrimitiveBuilder::fill(const RayGrid& grid, std::array<std::size_t, 4> corners, Primitive& p) {
  p.pass = traced_.pass;
  p.crossings = static_cast<std::uint16_t>(grid.stop_crossings());
  bool open = true;
  const float slack = grid.slack(corners);
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t v = corners[k];
    p.x[k] = x_[v];
    p.y[k] = y_[v];
    p.relative_height[k] = grid.relative_height[v];
    p.stop_x[k] = p.crossings > 0 ? grid.stop_x[0][v] : 0.0F;
    p.stop_y[k] = p.crossings > 0 ? grid.stop_y[0][v] : 0.0F;
    open = open && grid.blocked[v] <= -slack;
  }
  if (open) p.flags |= kOpen;
  p.more_crossings = static_cast<std::uint32_t>(out_->more_crossings.size());
  for (std::size_t c = 1; c < p.crossings; ++c) {
    StopPoints points{};
    for (std::size_t k = 0; k < 4; ++k) {
      points.x[k] = grid.stop_x[c][corners[k]];
      points.y[k] = grid.stop_y[c][corners[k]];
    }
    out_->more_crossings.push_back(points);
  }
  if (traced_.front_dirt == nullptr) return;
  p.flags |= kFront;
  StopPoints front{};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto side = static_cast<std::size_t>(grid.side());
    const Vec2 step = grid.step_mm();
    const Vec2 entrance = grid.box().low + Vec2{step.x * static_cast<double>(corners[k] % side),
                                                step.y * static_cast<double>(corners[k] / side)};
    const Vec2 at = traced_.front_dirt->front_point(entrance, traced_.entrance_z_mm, traced_.light);
    front.x[k] = static_cast<float>(at.x);
    front.y[k] = static_cast<float>(at.y);
  }
  out_->more_crossings.push_back(front);
}

// The corners' irradiances are proportional to the vertices', scaled so that the primitive's two triangles have its
// flux.
void PrimitiveBuilder::emit_quad(const RayGrid& grid, std::array<std::size_t, 4> corners, double flux) {
  double first = twice_area(corners[0], corners[1], corners[2]);
  double second = twice_area(corners[0], corners[2], corners[3]);
  if (first + second < 0.0) {
    std::swap(corners[1], corners[3]);
    std::swap(first, second);
    first = -first;
    second = -second;
  }
  Primitive p;
  fill(grid, corners, p);
  if (first + second > kSliver * extent_squared(p)) {
    std::array<double, 4> e{};
    for (std::size_t k = 0; k < 4; ++k) e[k] = irradiance_[corners[k]];
    const bool smooth = e[0] > 0.0 && e[1] > 0.0 && e[2] > 0.0 && e[3] > 0.0;
    if (!smooth) e = {1.0, 1.0, 1.0, 1.0};
    const double held = (first * (e[0] + e[1] + e[2]) + second * (e[0] + e[2] + e[3])) / 6.0;
    for (std::size_t k = 0; k < 4; ++k) p.irradiance[k] = static_cast<float>(e[k] * (flux / held));
    p.pixels = pixels_within(p.x, p.y, frame_);
  }
  out_->primitives.push_back(p);
}

void PrimitiveBuilder::emit_triangle(const RayGrid& grid, std::array<std::size_t, 3> corners) {
  for (const std::size_t k : corners) {
    if (!std::isfinite(grid.relative_height[k])) return;
  }
  const auto& t = grid.transmission;
  const double flux = triangle_weight_mm2_ * (t[corners[0]] + t[corners[1]] + t[corners[2]]) / 3.0;
  double twice = twice_area(corners[0], corners[1], corners[2]);
  if (twice < 0.0) {
    std::swap(corners[1], corners[2]);
    twice = -twice;
  }
  Primitive p;
  p.flags = kTriangle;
  fill(grid, {corners[0], corners[1], corners[2], corners[0]}, p);
  if (twice > kSliver * extent_squared(p)) {
    p.irradiance.fill(static_cast<float>(flux / (0.5 * twice)));
    p.pixels = pixels_within(p.x, p.y, frame_);
  }
  out_->primitives.push_back(p);
}

void PrimitiveBuilder::emit(const RayGrid& grid, int step, int ix, int iy) {
  const Level& level = levels_[static_cast<std::size_t>(step)];
  const int size = 1 << step;
  const bool whole = ix < level.side && iy < level.side && level.is_whole[level.at(ix, iy)] != 0;
  if (whole) {
    emit_quad(grid,
              {grid.at(ix * size, iy * size), grid.at((ix + 1) * size, iy * size),
               grid.at((ix + 1) * size, (iy + 1) * size), grid.at(ix * size, (iy + 1) * size)},
              level.flux[level.at(ix, iy)]);
    return;
  }
  if (step == 0) {
    if (ix >= level.side || iy >= level.side || state_[level.at(ix, iy)] != CellState::InTriangles) return;
    const auto v = grid.corners(ix, iy);
    emit_triangle(grid, {v[0], v[1], v[2]});
    emit_triangle(grid, {v[0], v[2], v[3]});
    return;
  }
  for (int k = 0; k < 4; ++k) emit(grid, step - 1, 2 * ix + k % 2, 2 * iy + k / 2);
}

std::uint64_t PrimitiveBuilder::build(const RayGrid& grid, const TracedPass& traced, PrimitiveBuffer& out) {
  const Vec2 step_mm = grid.step_mm();
  triangle_weight_mm2_ = 0.5 * step_mm.x * step_mm.y * traced.shared_flux;
  traced_ = traced;
  out_ = &out;
  levels_.resize(static_cast<std::size_t>(merge_steps_) + 1);
  place_vertices(grid, traced.shift_mm);
  widen(grid);
  find_cells(grid);
  find_irradiance(grid);
  merge(grid);
  const int block = 1 << merge_steps_;
  const int blocks = (grid.cells() + block - 1) / block;
  for (int iy = 0; iy < blocks; ++iy) {
    for (int ix = 0; ix < blocks; ++ix) emit(grid, merge_steps_, ix, iy);
  }
  std::uint64_t count = 0;
  for (const CellState state : state_) count += state == CellState::Dark ? 0 : state == CellState::Whole ? 1 : 2;
  return count;
}

}  // namespace contrejour::inline internal::tiled
