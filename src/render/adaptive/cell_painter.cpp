#include "render/adaptive/cell_painter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace contrejour::adaptive {
namespace {

constexpr int kDeepest = 7;          // quarterings of a patch
constexpr double kSliver = 1e-3;     // pixels: mean width below which a polygon is a line
constexpr double kSpeck = 0.05;      // pixels: a polygon no longer than this is a point
constexpr double kSmallAngle = 1e-3; // radians: smaller ones may be rounding
constexpr int kMostPoints = 256;     // that stand for a line
constexpr double kPixel = 1.0;       // area below which a cell is not seen but for its flux
constexpr double kMostBend = 0.04;   // of a cell, that what cuts it may be off
constexpr double kPeaks = 64.0;      // brightness over the peak where errors begin to count as relative ones
// Half the cell, a fourth of the deviation of a curve from its chord: a sixteenth of the squared error.
constexpr double kGainOfHalving = 16.0;

struct Bounds {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  [[nodiscard]] Vec2 size() const { return high - low; }
};

double quad_area(Vec2 a, Vec2 b, Vec2 c, Vec2 d) { return 0.5 * cross(c - a, d - b); }

}  // namespace

CellPainter::Cell CellPainter::cell_at(int ix, int iy, int size) {
  Cell cell{ix, iy, size, {}, {}, 0};
  const int half = size / 2;
  cell.corner = {Mesh::at(ix, iy), Mesh::at(ix + size, iy), Mesh::at(ix + size, iy + size), Mesh::at(ix, iy + size)};
  cell.side = {Mesh::at(ix + half, iy), Mesh::at(ix + size, iy + half), Mesh::at(ix + half, iy + size),
               Mesh::at(ix, iy + half)};
  cell.middle = Mesh::at(ix + half, iy + half);
  return cell;
}

// Closed for certain only where one rim or one crossing of the iris blocks all of it.
CellPainter::State CellPainter::state_of(const Mesh& mesh, const Cell& cell) {
  std::uint32_t any = 0;
  std::uint32_t all = ~0U;
  for (int y = cell.iy; y <= cell.iy + cell.size; ++y) {
    for (int x = cell.ix; x <= cell.ix + cell.size; ++x) {
      any |= mesh.outside[Mesh::at(x, y)];
      all &= mesh.outside[Mesh::at(x, y)];
    }
  }
  if (any == 0) return State::Open;
  return all != 0 ? State::Closed : State::Cut;
}

bool CellPainter::off_frame(const Mesh& mesh, const Cell& cell) const {
  Bounds b;
  for (const std::size_t v : cell.corner) b.add(mesh.position(v));
  for (const std::size_t v : cell.side) b.add(mesh.position(v));
  const Vec2 low = b.low + mesh.origin_px;
  const Vec2 high = b.high + mesh.origin_px;
  return !(high.x > 0.0 && high.y > 0.0 && low.x < width_ && low.y < height_);
}

// What drawing the cell as one polygon with a linear irradiance would get wrong, squared, over its pixels.
double CellPainter::squared_error(const Mesh& mesh, const Cell& cell, State state) const {
  const std::array<std::size_t, 9> v{cell.corner[0], cell.side[0],   cell.corner[1], cell.side[3],  cell.middle,
                                     cell.side[1],   cell.corner[3], cell.side[2],   cell.corner[2]};
  Bounds b;
  bool folded = false;
  double sum = 0.0;
  for (const std::size_t k : v) {
    b.add(mesh.position(k));
    folded = folded || mesh.area[k] * mesh.area[cell.middle] <= 0.0F;
    sum += mesh.brightness[k];
  }
  const double mean = sum / 9.0;
  const Vec2 extent = b.size();
  const double box = std::max(extent.x, kPixel) * std::max(extent.y, kPixel);
  // Its whole flux out of place within its bounds: no cell can do worse.
  const double flux = std::abs(mesh.brightness[cell.middle] * mesh.area[cell.middle]) * cell.size * cell.size;
  const double worst = flux * flux / box;
  if (folded) {
    const double seen = 1.0 / (1.0 + flux / box / (kPeaks * peak_));
    return worst * seen * seen;
  }

  const auto e = [&](std::size_t k) { return static_cast<double>(mesh.brightness[v[k]]); };
  const double along_u = (e(2) + e(5) + e(8) - e(0) - e(3) - e(6)) / 6.0;
  const double along_v = (e(6) + e(7) + e(8) - e(0) - e(1) - e(2)) / 6.0;
  double residual = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    const double plane =
        mean + along_u * (static_cast<double>(k % 3) - 1.0) + along_v * (static_cast<double>(k / 3) - 1.0);
    residual += (e(k) - plane) * (e(k) - plane) / 9.0;
  }
  const double longest = std::max(extent.x, extent.y);
  const double area = std::abs(mesh.area[cell.middle]) * cell.size * cell.size;
  const double width = std::min(1.0, area / std::max(longest, 1e-6));  // a sliver's flux is seen spread over a pixel
  // Far above the frame's peak only the relative error counts.
  const double dimmed = 1.0 / (1.0 + mean / (kPeaks * peak_));
  double error = residual * area * width;

  // Sides drawn straight.
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = mesh.position(cell.corner[k]);
    const Vec2 c = mesh.position(cell.corner[(k + 1) % 4]);
    const double off = length(mesh.position(cell.side[k]) - (a + c) * 0.5);
    error += mean * mean * std::min(off * off, off) * length(c - a) * width * width;
  }
  if (state == State::Cut) {
    const double share = limit_error(mesh, cell);
    if (share > kMostBend) return std::numeric_limits<double>::infinity();  // or light would be lost unseen
    const double off = share * longest;
    error += mean * mean * std::min(off * off, off) * longest * width * width;
  }
  return std::min(error, 4.0 * worst) * dimmed * dimmed;
}

// How far the lines that cut the cell are off when stop coordinates and rims are taken as linear along its sides, as
// a share of the cell.
double CellPainter::limit_error(const Mesh& mesh, const Cell& cell) {
  double largest = 0.0;
  const int first_rim = mesh.layout.rim(0);
  for (int f = PatchLayout::kStop; f < mesh.layout.fields(); ++f) {
    const Mesh::Field& v = mesh.field(f);
    float low = v[cell.corner[0]];
    float high = low;
    for (const std::size_t k : cell.corner) {
      low = std::min(low, v[k]);
      high = std::max(high, v[k]);
    }
    float lowest = std::min(low, v[cell.middle]);  // a rim may pass inside a cell whose corners are all beyond it
    for (const std::size_t k : cell.side) lowest = std::min(lowest, v[k]);
    if (f >= first_rim && (high <= 1.0F || lowest > 1.0F)) continue;
    double off = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      off = std::max(off, std::abs(static_cast<double>(v[cell.side[k]]) -
                                   0.5 * (v[cell.corner[k]] + v[cell.corner[(k + 1) % 4]])));
    }
    // Neighbouring stop fields are one point's coordinates: the larger change is the scale of both.
    double change = high - low;
    if (f < first_rim) {
      const Mesh::Field& w = mesh.field((f - PatchLayout::kStop) % 2 == 0 ? f + 1 : f - 1);
      for (const std::size_t k : cell.corner)
        change = std::max(change, 2.0 * std::abs(static_cast<double>(w[k]) - w[cell.middle]));
    }
    if (change > 0.0) largest = std::max(largest, off / change);
  }
  return largest;
}

bool CellPainter::wants_finer_mesh(const Mesh& mesh, int ix, int iy) const {
  for (int y = iy; y < iy + Mesh::kCells / 2; y += 2) {
    for (int x = ix; x < ix + Mesh::kCells / 2; x += 2) {
      const Cell cell = cell_at(x, y, 2);
      const State state = state_of(mesh, cell);
      if (state == State::Closed || off_frame(mesh, cell)) continue;
      if (squared_error(mesh, cell, state) > kGainOfHalving * budget_) return true;
    }
  }
  return false;
}

void CellPainter::paint(const Patch& patch, int depth) {
  const Mesh mesh = make_mesh(patch, iris_);
  constexpr int kHalf = Mesh::kCells / 2;
  if (depth == 0 && patch.nodes <= 5 && !wants_finer_mesh(mesh, 0, 0) && !wants_finer_mesh(mesh, kHalf, 0) &&
      !wants_finer_mesh(mesh, 0, kHalf) && !wants_finer_mesh(mesh, kHalf, kHalf)) {
    paint_cell(mesh, 0, 0, Mesh::kCells);  // what so few nodes tell, nine vertices tell too
    return;
  }
  const int first = patch.nodes <= 9 ? kHalf : kHalf / 2;  // 9 nodes: 3 x 3 vertices tell a quarter
  for (int qy = 0; qy < 2; ++qy) {
    for (int qx = 0; qx < 2; ++qx) {
      if (depth < kDeepest && wants_finer_mesh(mesh, qx * kHalf, qy * kHalf)) {
        paint(quarter(patch, qx, qy), depth + 1);
        continue;
      }
      for (int y = qy * kHalf; y < (qy + 1) * kHalf; y += first) {
        for (int x = qx * kHalf; x < (qx + 1) * kHalf; x += first) paint_cell(mesh, x, y, first);
      }
    }
  }
}

void CellPainter::paint_cell(const Mesh& mesh, int ix, int iy, int size) {
  const Cell cell = cell_at(ix, iy, size);
  const State state = state_of(mesh, cell);
  if (state == State::Closed || off_frame(mesh, cell)) return;
  if (size > 1 && squared_error(mesh, cell, state) > budget_) {
    const int half = size / 2;
    for (int k = 0; k < 4; ++k) paint_cell(mesh, ix + (k % 2) * half, iy + (k / 2) * half, half);
    return;
  }
  draw(mesh, cell, state);
}

void CellPainter::draw(const Mesh& mesh, const Cell& cell, State state) {
  const std::array<Vec2, 4> p{mesh.position(cell.corner[0]), mesh.position(cell.corner[1]),
                              mesh.position(cell.corner[2]), mesh.position(cell.corner[3])};
  const double area = quad_area(p[0], p[1], p[2], p[3]);
  bool convex = true;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = p[k];
    convex =
        convex && cross(p[(k + 1) % 4] - a, p[(k + 2) % 4] - a) * area > 0.0 && mesh.area[cell.corner[k]] * area > 0.0;
  }
  if (!convex) return draw_folded(mesh, cell, state);

  Shade shade;
  Flux flux{};
  const Vec2 middle = (p[0] + p[1] + p[2] + p[3]) * 0.25 + mesh.origin_px;
  shade.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)};
  const Vec2 d = p[2] - p[0];
  const Vec2 f = p[3] - p[1];
  const double flux_area = mesh.cell_flux_area_mm2 * cell.size * cell.size;
  // Pixels see the irradiance at their centres, which may lie well outside a cell smaller than they are.
  const double width = std::abs(area) / std::max(length(d), length(f));
  const double sloped = std::clamp(width - 1.0, 0.0, 1.0);
  for (int c = 0; c < 3; ++c) {
    const auto& w = mesh.field(PatchLayout::kWeight + c);
    double weight = 0.25 * (w[cell.corner[0]] + w[cell.corner[1]] + w[cell.corner[2]] + w[cell.corner[3]]);
    if (cell.size > 1) {  // Simpson's rule both ways
      const double sides = 0.25 * (w[cell.side[0]] + w[cell.side[1]] + w[cell.side[2]] + w[cell.side[3]]);
      weight = (weight + 4.0 * sides + 4.0 * w[cell.middle]) / 9.0;
    }
    const double value = weight * flux_area / std::abs(area);
    flux[static_cast<std::size_t>(c)] = weight * flux_area;
    std::array<double, 4> e{};
    double mean = 0.0;
    double most = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      e[k] = mesh.irradiance(c, cell.corner[k]);
      mean += 0.25 * e[k];
      most = std::max(most, std::abs(e[k]));
    }
    const auto channel = static_cast<std::size_t>(c);
    shade.value[channel] = static_cast<float>(value);
    // Where the irradiance rises steeply a plane through the corners would go below zero: level then.
    if (!(std::abs(mean) > 0.0) || most > 2.0 * std::abs(mean)) continue;
    const double along_d = (e[2] - e[0]) / mean;
    const double along_f = (e[3] - e[1]) / mean;
    const double scale = sloped * value / cross(d, f);
    shade.along_x[channel] = static_cast<float>((along_d * f.y - along_f * d.y) * scale);
    shade.along_y[channel] = static_cast<float>((along_f * d.x - along_d * f.x) * scale);
  }
  draw_polygon(mesh, state, shade, flux, cell.corner);
}

// Two triangles, each with its own flux spread evenly.
void CellPainter::draw_folded(const Mesh& mesh, const Cell& cell, State state) {
  const double flux_area = 0.5 * mesh.cell_flux_area_mm2 * cell.size * cell.size;
  for (const auto& t : {std::array{cell.corner[0], cell.corner[1], cell.corner[2]},
                        std::array{cell.corner[0], cell.corner[2], cell.corner[3]}}) {
    const std::array<Vec2, 3> p{mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])};
    const double area = 0.5 * std::abs(cross(p[1] - p[0], p[2] - p[0]));
    const Vec2 middle = (p[0] + p[1] + p[2]) * (1.0 / 3.0) + mesh.origin_px;
    Shade shade;
    Flux flux{};
    shade.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)};
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const auto& w = mesh.field(PatchLayout::kWeight + c);
      flux[channel] = (w[t[0]] + w[t[1]] + w[t[2]]) / 3.0 * flux_area;
      shade.value[channel] = static_cast<float>(flux[channel] / std::max(area, 1e-12));
    }
    draw_polygon(mesh, state, shade, flux, t);
  }
}

// Chords of an arc that miss it by no more pixels than the budget allows; half as many either way would do.
void CellPainter::set_arc_step(const Mesh& mesh, std::span<const std::size_t> corners, const Shade& shade) {
  double reach = 0.0;
  Bounds b;
  for (const std::size_t v : corners) {
    b.add(mesh.position(v));
    for (int f = PatchLayout::kStop; f < mesh.layout.rim(0); ++f) {
      reach = std::max(reach, std::abs(static_cast<double>(mesh.field(f)[v]) - mesh.field(f)[corners[0]]));
    }
  }
  const double longest = std::max(b.size().x, b.size().y);
  const double level = std::max({std::abs(shade.value[0]), std::abs(shade.value[1]), std::abs(shade.value[2])});
  const double seen = level / (1.0 + level / (kPeaks * peak_));
  const double off_px =
      std::clamp(0.5 * std::sqrt(budget_ / std::max(longest, 1.0)) / std::max(seen, 1e-300), 0.02, 0.5);
  const double pixels_per_radius = longest / std::max(reach, 1e-9);
  arc_step_ = std::clamp(std::sqrt(8.0 * off_px / pixels_per_radius), 0.02, 0.8);
}

void CellPainter::draw_polygon(const Mesh& mesh, State state, const Shade& shade, const Flux& flux,
                               std::span<const std::size_t> corners) {
  constexpr std::array<Vec2, 4> kUv{Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}};
  polygon_.clear();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    Corner corner{mesh.position(corners[k]) + mesh.origin_px, kUv[k], {}};
    for (int f = PatchLayout::kStop; state == State::Cut && f < mesh.layout.fields(); ++f) {
      corner.limit[static_cast<std::size_t>(f - PatchLayout::kStop)] = mesh.field(f)[corners[k]];
    }
    polygon_.push_back(corner);
  }
  if (state == State::Cut) {
    set_arc_step(mesh, corners, shade);
    whole_ = polygon_;
    cut(mesh);
  }
  if (polygon_.size() < 3) return;

  points_.clear();
  Bounds b;
  double twice_area = 0.0;
  double twice_share = 0.0;
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Corner& c = polygon_[k];
    b.add(c.position);
    points_.push_back({static_cast<float>(c.position.x), static_cast<float>(c.position.y)});
    if (k < 2) continue;
    twice_area += cross(polygon_[k - 1].position - polygon_[0].position, c.position - polygon_[0].position);
    twice_share += cross(polygon_[k - 1].uv - polygon_[0].uv, c.uv - polygon_[0].uv);
  }
  const double longest = std::max(b.size().x, b.size().y);
  const bool one_pixel = std::floor(b.low.x) == std::floor(b.high.x) && std::floor(b.low.y) == std::floor(b.high.y);
  const bool sliver = std::abs(twice_area) < kSliver * longest;
  if (!one_pixel && !sliver && longest > kSpeck) {
    out_.add(points_, shade);
    return;
  }
  const double share = 0.5 * std::abs(twice_share) * (corners.size() == 3 ? 2.0 : 1.0);
  draw_line(polygon_, {flux[0] * share, flux[1] * share, flux[2] * share});
}

// The flux at points between the ends of a polygon that is thinner than can be told.
void CellPainter::draw_line(std::span<const Corner> polygon, const Flux& flux) {
  std::array<Vec2, 2> ends{polygon[0].position, polygon[0].position};
  for (const Corner& a : polygon) {
    for (const Corner& b : polygon) {
      if (length(b.position - a.position) > length(ends[1] - ends[0])) ends = {a.position, b.position};
    }
  }
  const Vec2 along = ends[1] - ends[0];
  const int count = std::clamp(static_cast<int>(std::ceil(2.0 * length(along))), 1, kMostPoints);
  Shade point;
  for (std::size_t c = 0; c < 3; ++c) point.value[c] = static_cast<float>(flux[c] / count);
  for (int k = 0; k < count; ++k) {
    const Vec2 p = ends[0] + along * ((k + 0.5) / count);
    point.at = {static_cast<float>(p.x), static_cast<float>(p.y)};
    out_.add({&point.at, 1}, point);
  }
}

// Keeps where value(corner), linear along the sides, is <= 0. Sutherland-Hodgman.
template <class Value>
void CellPainter::cut_where_positive(Value value) {
  next_.clear();
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Corner& a = polygon_[k];
    const Corner& b = polygon_[k + 1 == polygon_.size() ? 0 : k + 1];
    const double fa = value(a);
    const double fb = value(b);
    if (fa <= 0.0) next_.push_back(a);
    if ((fa <= 0.0) == (fb <= 0.0)) continue;
    next_.push_back(between(a, b, fa / (fa - fb)));
  }
  polygon_.swap(next_);
}

// The stop coordinates are linear along each side, which then meets the circle exactly; where the outline leaves the
// circle an arc takes it to where it comes back.
void CellPainter::cut_by_circle(std::size_t limit) {
  const auto stop = [limit](const Corner& c) { return Vec2{c.limit[limit], c.limit[limit + 1]}; };
  next_.clear();
  std::vector<std::size_t>& exits = exits_;
  exits.clear();
  double twice_area = 0.0;
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Corner& a = polygon_[k];
    const Corner& b = polygon_[k + 1 == polygon_.size() ? 0 : k + 1];
    const Vec2 s = stop(a);
    const Vec2 along = stop(b) - s;
    twice_area += cross(s, stop(b));
    const bool starts_inside = dot(s, s) <= 1.0;
    const bool ends_inside = dot(stop(b), stop(b)) <= 1.0;
    if (starts_inside) next_.push_back(a);
    if (starts_inside && ends_inside) continue;
    // Where the side meets the circle; corners were judged above, and rounding must not judge otherwise.
    const double aa = dot(along, along);
    const double half_b = dot(s, along);
    const double under = half_b * half_b - aa * (dot(s, s) - 1.0);
    const bool meets = under > 0.0 && aa > 0.0;
    const double enters = meets ? (-half_b - std::sqrt(under)) / aa : 1.0;  // a tangent side is met at its end
    const double leaves = meets ? (-half_b + std::sqrt(under)) / aa : 0.0;
    const bool passes_through = !starts_inside && !ends_inside;
    if (passes_through && !(meets && enters > 0.0 && leaves < 1.0)) continue;
    if (!starts_inside) next_.push_back(between(a, b, std::clamp(enters, 0.0, 1.0)));
    if (!ends_inside) {
      exits.push_back(next_.size());
      next_.push_back(between(a, b, std::clamp(leaves, 0.0, 1.0)));
    }
  }
  if (next_.empty() && !surrounds_origin(limit)) {
    polygon_.clear();
    return;
  }
  const double turn = twice_area > 0.0 ? 1.0 : -1.0;
  polygon_.clear();
  if (next_.empty()) {
    add_circle(limit, turn);
    return;
  }
  std::size_t exit = 0;
  for (std::size_t k = 0; k < next_.size(); ++k) {
    polygon_.push_back(next_[k]);
    if (exit == exits.size() || exits[exit] != k) continue;
    ++exit;
    const Vec2 from = stop(next_[k]);
    const Vec2 to = stop(next_[k + 1 == next_.size() ? 0 : k + 1]);
    double angle = std::atan2(cross(from, to), dot(from, to));
    // Only where a single side cuts the circle is a small angle backwards nearly a whole turn, not rounding.
    if (angle * turn < 0.0 && (std::abs(angle) > kSmallAngle || next_.size() == 2))
      angle += turn * 2.0 * std::numbers::pi;
    if (angle * turn > 0.0) add_arc(limit, std::atan2(from.y, from.x), angle);
  }
}

// All corners lie outside the unit circle: whether it lies inside them.
bool CellPainter::surrounds_origin(std::size_t limit) const {
  bool left = false;
  bool right = false;
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Corner& a = polygon_[k];
    const Corner& b = polygon_[k + 1 == polygon_.size() ? 0 : k + 1];
    const double side = cross(Vec2{a.limit[limit], a.limit[limit + 1]}, Vec2{b.limit[limit], b.limit[limit + 1]});
    (side > 0.0 ? left : right) = true;
  }
  return left != right;
}

// Corners along an arc of the unit circle of the stop; its ends lie on the circle and are not among them. The others
// lie a little outside, so that the chords enclose the arc's area: (n - 2) r^2 + 2 r = n step / sin(step).
void CellPainter::add_arc(std::size_t limit, double from, double angle) {
  const int steps = static_cast<int>(std::ceil(std::abs(angle) / arc_step_));
  if (steps < 2) return;
  const double step = angle / steps;
  const double excess = steps * step / std::sin(step);
  const double radius = steps == 2 ? 0.5 * excess : (std::sqrt(1.0 + (steps - 2) * excess) - 1.0) / (steps - 2);
  for (int k = 1; k < steps; ++k) {
    const double a = from + step * k;
    polygon_.push_back(corner_at_stop(limit, Vec2{std::cos(a), std::sin(a)} * radius));
  }
}

// The whole circle as a regular polygon of its area.
void CellPainter::add_circle(std::size_t limit, double turn) {
  const int steps = std::max(3, static_cast<int>(std::ceil(2.0 * std::numbers::pi / arc_step_)));
  const double step = 2.0 * std::numbers::pi / steps;
  const double radius = std::sqrt(step / std::sin(step));
  for (int k = 0; k < steps; ++k) {
    polygon_.push_back(corner_at_stop(limit, Vec2{std::cos(turn * step * k), std::sin(turn * step * k)} * radius));
  }
}

CellPainter::Corner CellPainter::between(const Corner& a, const Corner& b, double t) {
  Corner c;
  c.position = a.position + (b.position - a.position) * t;
  c.uv = a.uv + (b.uv - a.uv) * t;
  for (std::size_t l = 0; l < c.limit.size(); ++l)
    c.limit[l] = a.limit[l] + static_cast<float>(t) * (b.limit[l] - a.limit[l]);
  return c;
}

// Everything is bilinear in the cell, or linear in a triangle of corners 0, 1 and 2.
CellPainter::Corner CellPainter::corner_at(Vec2 uv) const {
  const bool triangle = whole_.size() == 3;
  const std::array<double, 4> share =
      triangle ? std::array{1.0 - uv.x, uv.x - uv.y, uv.y, 0.0}
               : std::array{(1.0 - uv.x) * (1.0 - uv.y), uv.x * (1.0 - uv.y), uv.x * uv.y, (1.0 - uv.x) * uv.y};
  Corner out;
  out.uv = uv;
  for (std::size_t k = 0; k < whole_.size(); ++k) {
    out.position = out.position + whole_[k].position * share[k];
    for (std::size_t l = 0; l < out.limit.size(); ++l)
      out.limit[l] += static_cast<float>(share[k]) * whole_[k].limit[l];
  }
  return out;
}

// The point of the cell whose ray crosses the stop there: two steps of Newton's method, the map being nearly linear.
CellPainter::Corner CellPainter::corner_at_stop(std::size_t limit, Vec2 target) const {
  constexpr double kStep = 1e-2;
  Vec2 uv{0.5, 0.5};
  Corner at = corner_at(uv);
  for (int step = 0; step < 2; ++step) {
    const Corner right = corner_at(uv + Vec2{kStep, 0.0});
    const Corner up = corner_at(uv + Vec2{0.0, kStep});
    const Vec2 s{at.limit[limit], at.limit[limit + 1]};
    const Vec2 du = (Vec2{right.limit[limit], right.limit[limit + 1]} - s) * (1.0 / kStep);
    const Vec2 dv = (Vec2{up.limit[limit], up.limit[limit + 1]} - s) * (1.0 / kStep);
    const double determinant = cross(du, dv);
    if (determinant == 0.0) break;
    const Vec2 off = target - s;
    uv = uv + Vec2{cross(off, dv) / determinant, cross(du, off) / determinant};
    at = corner_at(uv);
  }
  return at;
}

void CellPainter::cut(const Mesh& mesh) {
  for (int c = 0; c < mesh.layout.crossings && !polygon_.empty(); ++c) {
    const auto limit = static_cast<std::size_t>(2 * c);
    if (iris_.is_circle()) {
      cut_by_circle(limit);
      continue;
    }
    for (const IrisShape::Edge& edge : iris_.edges()) {
      cut_where_positive([&](const Corner& p) {
        return edge.normal.x * p.limit[limit] + edge.normal.y * p.limit[limit + 1] - iris_.apothem();
      });
    }
  }
  for (int r = 0; r < mesh.layout.rims && !polygon_.empty(); ++r) {
    const auto limit = static_cast<std::size_t>(2 * mesh.layout.crossings + r);
    cut_where_positive([&](const Corner& p) { return static_cast<double>(p.limit[limit]) - 1.0; });
  }
}

}  // namespace contrejour::adaptive
