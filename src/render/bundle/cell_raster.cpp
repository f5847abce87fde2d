// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/cell_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "aperture/iris_blades.h"
#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal::bundle {
namespace {

// The map is not smooth where the areas of the cells around a vertex differ by more than this factor.
constexpr float kSmoothRatio = 1.5F;
// Changes of irradiance within a cell smaller than this, in pixels of area, are not visible.
constexpr double kShadedCell_px = 4.0;
// If a polygon's area is below this fraction of its extent squared, it is mostly rounding error: the polygon is drawn
// as a line.
constexpr double kSliver = 1e-7;
constexpr double kInvisibleDetail_px = 0.3;
constexpr double kUniform = 1e-3;  // a stop pattern this close to 1 all over a cell is drawn as 1

double signed_area(Vec2 a, Vec2 b, Vec2 c) { return 0.5 * cross(b - a, c - a); }

bool in_one_pixel(std::span<const Vec2> p) {
  const double x = std::floor(p[0].x);
  const double y = std::floor(p[0].y);
  return std::all_of(p.begin(), p.end(), [&](Vec2 q) { return std::floor(q.x) == x && std::floor(q.y) == y; });
}

// The two points of a polygon that are farthest apart.
std::array<Vec2, 2> ends_of(std::span<const Vec2> p) {
  std::array<Vec2, 2> ends{p[0], p[0]};
  double longest = 0.0;
  for (const Vec2 a : p) {
    for (const Vec2 b : p) {
      if (dot(b - a, b - a) > longest) {
        longest = dot(b - a, b - a);
        ends = {a, b};
      }
    }
  }
  return ends;
}

Vec2 mean_of(std::span<const Vec2> p) {
  Vec2 sum{};
  for (const Vec2 q : p) sum = sum + q;
  return sum * (1.0 / static_cast<double>(p.size()));
}

// The position of a pixel in a triangle, (u, v) from its first corner; for a pixel outside, the nearest point in these
// coordinates.
Vec2 pixel_in_triangle(const std::array<Vec2, 3>& p, Vec2 pixel) {
  const Vec2 u = p[1] - p[0], v = p[2] - p[0], q = pixel - p[0];
  const double determinant = cross(u, v);
  if (determinant == 0.0) return {1.0 / 3.0, 1.0 / 3.0};
  const double s = std::max(cross(q, v) / determinant, 0.0), t = std::max(cross(u, q) / determinant, 0.0);
  const double beyond = std::max(s + t, 1.0);
  return {s / beyond, t / beyond};
}

bool is_convex(std::span<const Vec2> q, double orientation) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (signed_area(q[k], q[(k + 1) % 4], q[(k + 2) % 4]) * orientation <= 0.0) return false;
  }
  return true;
}

}  // namespace

CellRaster::CellRaster(const RayGrid& grid, const IrisShape& iris, const Frame& frame, double shared_flux,
                       CellStyle style, GridStop stop)
    : grid_(grid), frame_(frame), style_(style), stop_(std::move(stop)), clipper_(iris) {
  const Vec2 step = grid.step_mm();
  triangle_weight_mm2_ = 0.5 * step.x * step.y * shared_flux;
  place_vertices();
  find_states();
  find_irradiance();
}

void CellRaster::place_vertices() {
  const std::size_t count = grid_.sensor_x_mm.size();
  pixel_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    pixel_[k] = frame_.pixel_from_sensor({grid_.sensor_x_mm[k], grid_.sensor_y_mm[k]});
  }
}

// A cell is certainly closed only if a single rim or a single crossing of the iris blocks all its corners.
CellRaster::CellState CellRaster::state_of(const std::array<std::size_t, 4>& corners) const {
  const auto all = [&](auto test) { return std::all_of(corners.begin(), corners.end(), test); };
  const float slack = grid_.slack(corners);
  if (all([&](std::size_t k) { return grid_.blocked[k] <= -slack; })) return CellState::Open;
  if (all([&](std::size_t k) { return grid_.relative_height[k] > 1.0F; })) return CellState::Closed;
  for (std::size_t c = 0; c < static_cast<std::size_t>(grid_.stop_crossings()); ++c) {
    if (all([&](std::size_t k) { return !(grid_.iris_distance[c][k] <= slack); })) return CellState::Closed;
  }
  return CellState::Cut;
}

void CellRaster::find_states() {
  const int n = grid_.cells();
  state_.resize(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  area_.resize(state_.size());
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      const auto v = grid_.corners(ix, iy);
      const std::size_t cell = cell_index(ix, iy);
      state_[cell] = state_of(v);
      area_[cell] = failed(v)
                        ? std::numeric_limits<float>::quiet_NaN()
                        : static_cast<float>(0.5 * cross(pixel_[v[2]] - pixel_[v[0]], pixel_[v[3]] - pixel_[v[1]]));
    }
  }
}

// hullin2011 4.1 and 4.3: the flux of the cells around a vertex over their area. 0 where one of them is folded, has a
// failed ray or is much larger than another.
void CellRaster::find_irradiance() {
  const int n = grid_.cells();
  irradiance_.resize(pixel_.size());
  for (int iy = 0; iy <= n; ++iy) {
    for (int ix = 0; ix <= n; ++ix) {
      float smallest = kFailed;
      float largest = -kFailed;
      float sum = 0.0F;
      float cells = 0.0F;
      for (int cy = std::max(iy - 1, 0); cy <= std::min(iy, n - 1); ++cy) {
        for (int cx = std::max(ix - 1, 0); cx <= std::min(ix, n - 1); ++cx) {
          const float area = area_[cell_index(cx, cy)];
          smallest = std::min(smallest, area);
          largest = std::max(largest, area);
          sum += area;
          cells += 1.0F;
        }
      }
      const float ratio = largest < 0.0F ? smallest / largest : largest / smallest;
      const bool smooth = sum == sum && smallest * largest > 0.0F && ratio < kSmoothRatio;
      const std::size_t k = grid_.at(ix, iy);
      irradiance_[k] = smooth ? grid_.transmission[k] * cells / std::abs(sum) : 0.0F;
    }
  }
}

bool CellRaster::outside(const PixelBox& box, const std::array<std::size_t, 4>& corners) const {
  const auto all = [&](auto test) { return std::all_of(corners.begin(), corners.end(), test); };
  return all([&](std::size_t k) { return pixel_[k].x < box.x0; }) ||
         all([&](std::size_t k) { return pixel_[k].x >= box.x1; }) ||
         all([&](std::size_t k) { return pixel_[k].y < box.y0; }) ||
         all([&](std::size_t k) { return pixel_[k].y >= box.y1; });
}

// The frame's pixels within the bounds of all cells that are not closed.
PixelBox CellRaster::drawn_box() const {
  constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();
  Vec2 low{kInfinitelyFar, kInfinitelyFar};
  Vec2 high{-kInfinitelyFar, -kInfinitelyFar};
  const int n = grid_.cells();
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      if (state_[cell_index(ix, iy)] == CellState::Closed) continue;
      for (const std::size_t k : grid_.corners(ix, iy)) {
        if (grid_.relative_height[k] == kFailed) continue;
        low = {std::min(low.x, pixel_[k].x), std::min(low.y, pixel_[k].y)};
        high = {std::max(high.x, pixel_[k].x), std::max(high.y, pixel_[k].y)};
      }
    }
  }
  if (!(low.x < frame_.width && low.y < frame_.height && high.x >= 0.0 && high.y >= 0.0)) return {};
  return {static_cast<int>(std::max(low.x, 0.0)), static_cast<int>(std::max(low.y, 0.0)),
          static_cast<int>(std::min(high.x, frame_.width - 1.0)) + 1,
          static_cast<int>(std::min(high.y, frame_.height - 1.0)) + 1};
}

CellRaster::Cell CellRaster::cell_at(int ix, int iy) const {
  Cell cell;
  cell.vertex = grid_.corners(ix, iy);
  cell.signed_area_px = area_[cell_index(ix, iy)];
  const auto e = [&](std::size_t k) { return irradiance_[cell.vertex[k]]; };
  cell.smooth = e(0) > 0.0F && e(1) > 0.0F && e(2) > 0.0F && e(3) > 0.0F;
  if (!style_.smooth_shading || !cell.smooth || std::abs(cell.signed_area_px) < kShadedCell_px) return cell;
  // The plane whose differences along both diagonals are those of the vertices' irradiances.
  const Vec2 d = pixel_[cell.vertex[2]] - pixel_[cell.vertex[0]];
  const Vec2 f = pixel_[cell.vertex[3]] - pixel_[cell.vertex[1]];
  const double mean = 0.25 * (e(0) + e(1) + e(2) + e(3));
  const double along_d = (e(2) - e(0)) / mean;
  const double along_f = (e(3) - e(1)) / mean;
  cell.gradient = Vec2{along_d * f.y - along_f * d.y, along_f * d.x - along_d * f.x} * (1.0 / cross(d, f));
  return cell;
}

double CellRaster::triangle_flux(const Triangle& t) const {
  return triangle_weight_mm2_ * (grid_.transmission[t[0]] + grid_.transmission[t[1]] + grid_.transmission[t[2]]) / 3.0;
}

StopCrossings CellRaster::crossings_of(std::size_t vertex) const {
  const auto in_lens = [&](Vec2 p) { return stop_.rotation_rad != 0.0 ? rotated(p, stop_.rotation_rad) : p; };
  StopCrossings out;
  for (std::size_t c = 0; c < static_cast<std::size_t>(grid_.stop_crossings()); ++c)
    out.stop[c] = in_lens(Vec2{grid_.stop_x[c][vertex], grid_.stop_y[c][vertex]}) * stop_.transmittance.outer_radius();
  if (!stop_.transmittance.has_front()) return out;
  const auto side = static_cast<std::size_t>(grid_.side());
  const Vec2 step = grid_.step_mm();
  const Vec2 entrance =
      grid_.box().low + Vec2{step.x * static_cast<double>(vertex % side), step.y * static_cast<double>(vertex / side)};
  out.front_mm = in_lens(stop_.transmittance.dirt->site().front_point(entrance, stop_.entrance_z_mm, stop_.light));
  return out;
}

// Finds what the stop transmits of a cell. If a ray has failed, the pattern counts as varying, and the cell as dirty.
void CellRaster::sample_stop_pattern(const std::array<std::size_t, 4>& corners) {
  const StopTransmittance& stop = stop_.transmittance;
  const auto crossings = static_cast<std::size_t>(grid_.stop_crossings());
  region_ = PatternRegion::Uniform;
  dirty_ = false;
  if (!stop.pattern && !stop.dirt) return;
  if (failed(corners)) {
    if (stop.pattern && crossings > 0) region_ = PatternRegion::Varying;
    dirty_ = stop.dirt != nullptr;
    return;
  }
  std::array<StopCrossings, 4> rays;
  for (std::size_t k = 0; k < 4; ++k) rays[k] = crossings_of(corners[k]);
  StopTransmittance::Cell cell{rays, {}, crossings};
  const auto mean = [&](const auto& of) { return (of(rays[0]) + of(rays[1]) + of(rays[2]) + of(rays[3])) * 0.25; };
  for (std::size_t c = 0; c < crossings; ++c)
    cell.middle.stop[c] = mean([&](const StopCrossings& ray) { return ray.stop[c]; });
  cell.middle.front_mm = mean([](const StopCrossings& ray) { return ray.front_mm; });
  region_ = stop.region(cell, kUniform);
  dirty_ = region_ != PatternRegion::Dark && !stop.is_clean(cell);
}

// What the stop pattern and, if requested, dirt transmit about a point in a triangle, as the mean over a pixel or, if
// that is smaller, the triangle; pixels: the triangle's area.
double CellRaster::transmittance(const std::array<StopCrossings, 3>& triangle, Vec2 uv, double pixels,
                                 bool with_dirt) const {
  const StopTransmittance::Sample at{triangle, static_cast<std::size_t>(grid_.stop_crossings()), uv,
                                     std::max(pixels, 1.0)};
  const double transmitted = region_ == PatternRegion::Varying ? stop_.transmittance.pattern_transmittance(at) : 1.0;
  return with_dirt ? transmitted * stop_.transmittance.dirt_transmittance(at) : transmitted;
}

// Subtracts the shadows of dirt from a polygon that was drawn without them: they are drawn as negative light.
void CellRaster::draw_shadows(FluxBox& out, std::span<const Vec2> polygon, const Triangle& t, const Density& density) {
  const std::array<Vec2, 3> p{pixel_[t[0]], pixel_[t[1]], pixel_[t[2]]};
  std::array<stop_patterns::PlaneView, kMaxStopCrossings> views;
  double finest_mm = std::numeric_limits<double>::infinity();
  const StopTransmittance& stop = stop_.transmittance;
  const std::array<StopCrossings, 3> rays = crossings_of(t);
  const std::size_t crossings = stop.dirt_crossings(static_cast<std::size_t>(grid_.stop_crossings()));
  for (std::size_t c = 0; c < crossings; ++c) {
    const auto point = [&](std::size_t k) { return stop.dirt_point_mm(rays[k], c); };
    views[c] = stop_patterns::PlaneView::through(p, std::array<Vec2, 3>{point(0), point(1), point(2)});
    finest_mm = std::min(finest_mm, std::sqrt(std::abs(cross(views[c].along_x, views[c].along_y))));
  }
  const double area = std::abs(signed_area(p[0], p[1], p[2]));
  const auto transmitted_at = [&](Vec2 pixel) { return transmittance(rays, pixel_in_triangle(p, pixel), area, false); };
  shadows_.for_each(*stop.dirt->outlines(), {views.data(), crossings}, polygon, finest_mm,
                    [&](std::span<const Vec2> shadow, double blocked) {
                      const Density lost{density.point, -blocked * density.value, density.gradient * -blocked};
                      ++primitives_;
                      if (region_ == PatternRegion::Varying)
                        out.add_polygon(shadow, lost, transmitted_at);
                      else
                        out.add_polygon(shadow, lost);
                    });
}

void CellRaster::draw_open(FluxBox& out, const Cell& cell) {
  const auto& v = cell.vertex;
  const std::array<Vec2, 4> quad{pixel_[v[0]], pixel_[v[1]], pixel_[v[2]], pixel_[v[3]]};
  const double flux = triangle_flux({v[0], v[1], v[2]}) + triangle_flux({v[0], v[2], v[3]});
  if (in_one_pixel(quad)) {
    ++primitives_;
    out.add_point(quad[0], flux);
    return;
  }
  if (cell.smooth && is_convex(quad, cell.signed_area_px)) {
    const Vec2 middle = (quad[0] + quad[1] + quad[2] + quad[3]) * 0.25;
    const double value = flux / std::abs(0.5 * cross(quad[2] - quad[0], quad[3] - quad[1]));
    ++primitives_;
    out.add_polygon(quad, {middle, value, cell.gradient * value});
    return;
  }
  draw_triangle(out, cell, {v[0], v[1], v[2]}, false);
  draw_triangle(out, cell, {v[0], v[2], v[3]}, false);
}

void CellRaster::draw_triangle(FluxBox& out, const Cell& cell, const Triangle& t, bool cut) {
  if (failed(t)) return;
  const std::array<Vec2, 3> p{pixel_[t[0]], pixel_[t[1]], pixel_[t[2]]};
  if (!cut) return draw_polygon(out, cell, t, p, 1.0, 1.0);
  clipper_.for_each_open_part(grid_, t, finest(p), [&](std::span<const Vec2> uv, double open) {
    corner_scratch_.clear();
    for (const Vec2 q : uv) corner_scratch_.push_back(p[0] + (p[1] - p[0]) * q.x + (p[2] - p[0]) * q.y);
    draw_polygon(out, cell, t, corner_scratch_, fraction_of_triangle(uv), open);
  });
}

// The fraction of a triangle below which details of an opening are not resolved.
double CellRaster::finest(const std::array<Vec2, 3>& p) {
  const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
  return std::min(1.0, kInvisibleDetail_px / std::max(longest, kInvisibleDetail_px));
}

// Draws a part of a triangle's image. fraction: the part's fraction of the triangle's flux; open: its transmittance.
void CellRaster::draw_polygon(FluxBox& out, const Cell& cell, const Triangle& t, std::span<const Vec2> polygon,
                              double fraction, double open) {
  const std::array<Vec2, 3> p{pixel_[t[0]], pixel_[t[1]], pixel_[t[2]]};
  const double area = std::abs(signed_area(p[0], p[1], p[2]));
  const bool dirt_by_pixels = dirty_ && !has_outlines();
  const bool by_pixels = region_ == PatternRegion::Varying || dirt_by_pixels;
  const auto rays = by_pixels || dirty_ ? crossings_of(t) : std::array<StopCrossings, 3>{};
  const auto transmitted_at = [&](Vec2 pixel) {
    return transmittance(rays, pixel_in_triangle(p, pixel), area, dirt_by_pixels);
  };
  ++primitives_;
  const double flux = triangle_flux(t) * open;
  const auto mean_transmittance = [&] {
    return transmittance(rays, pixel_in_triangle(p, mean_of(polygon)), area, dirty_);
  };
  if (in_one_pixel(polygon)) {
    out.add_point(polygon[0], flux * fraction * mean_transmittance());
    return;
  }
  const auto ends = ends_of(polygon);
  if (area < kSliver * dot(ends[1] - ends[0], ends[1] - ends[0])) {
    out.add_line(ends[0], ends[1], flux * fraction * mean_transmittance());
    return;
  }
  const double value = flux / area;
  const Vec2 middle = (p[0] + p[1] + p[2]) * (1.0 / 3.0);
  const Density density{middle, value, cell.gradient * value};
  if (by_pixels)
    out.add_polygon(polygon, density, transmitted_at);
  else
    out.add_polygon(polygon, density);
  if (has_outlines()) draw_shadows(out, polygon, t, density);
}

bool CellRaster::failed(std::span<const std::size_t> vertices) const {
  return std::any_of(vertices.begin(), vertices.end(),
                     [&](std::size_t k) { return grid_.relative_height[k] == kFailed; });
}

double CellRaster::open_flux(const Triangle& t, CellState state) {
  if (failed(t)) return 0.0;
  if (state == CellState::Open) return triangle_flux(t);
  double fraction = 0.0;
  const double detail = finest({pixel_[t[0]], pixel_[t[1]], pixel_[t[2]]});
  clipper_.for_each_open_part(
      grid_, t, detail, [&](std::span<const Vec2> uv, double open) { fraction += fraction_of_triangle(uv) * open; });
  return fraction * triangle_flux(t);
}

void CellRaster::draw_point(FluxBox& out, const Cell& cell, CellState state) {
  const auto& v = cell.vertex;
  if (failed(v)) return;
  double flux = open_flux({v[0], v[1], v[2]}, state) + open_flux({v[0], v[2], v[3]}, state);
  flux *=
      transmittance(crossings_of(Triangle{v[0], v[1], v[3]}), {0.5, 0.5}, std::abs(cell.signed_area_px) * 0.5, dirty_);
  ++primitives_;
  out.add_point((pixel_[v[0]] + pixel_[v[1]] + pixel_[v[2]] + pixel_[v[3]]) * 0.25, flux);
}

void CellRaster::draw_cell(FluxBox& out, const Cell& cell, CellState state) {
  const auto& v = cell.vertex;
  if (style_.points) {
    draw_point(out, cell, state);
  } else if (state == CellState::Open && region_ == PatternRegion::Uniform && !dirty_) {
    draw_open(out, cell);
  } else {
    draw_triangle(out, cell, {v[0], v[1], v[2]}, true);
    draw_triangle(out, cell, {v[0], v[2], v[3]}, true);
  }
}

FluxBox CellRaster::draw(const std::function<bool()>& stop) {
  FluxBox out(drawn_box());
  if (out.box().empty()) return out;
  const int n = grid_.cells();
  for (int iy = 0; iy < n; ++iy) {
    if (stop()) break;  // a row of a large ghost may take milliseconds
    for (int ix = 0; ix < n; ++ix) {
      const CellState state = state_[cell_index(ix, iy)];
      if (state == CellState::Closed) continue;
      if (outside(out.box(), grid_.corners(ix, iy))) continue;
      sample_stop_pattern(grid_.corners(ix, iy));
      if (region_ == PatternRegion::Dark) continue;
      draw_cell(out, cell_at(ix, iy), state);
    }
  }
  return out;
}

}  // namespace contrejour::inline internal::bundle
