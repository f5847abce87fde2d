// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/shadow_clipper.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal::stop_patterns {
namespace {

constexpr double kOff = 0.02;        // of the finest detail: error of outlines
constexpr int kMaxSteps = 48;       // of half a round end, or along a curved line
constexpr double kNothing = 1e-12;   // relative to a polygon's area
constexpr std::size_t kManyParts = 48;  // over a polygon: it is halved then, as each part is clipped by all before it
constexpr int kMaxDepth = 10;

double twice_area(std::span<const Vec2> p) {
  double sum = 0.0;
  for (std::size_t k = 2; k < p.size(); ++k) sum += cross(p[k - 1] - p[0], p[k] - p[0]);
  return sum;
}

void make_counter_clockwise(std::vector<Vec2>& p) {
  if (twice_area(p) < 0.0) std::reverse(p.begin(), p.end());
}

// Keeps what is left of the line from a to b, or right of it for side = -1 (Sutherland & Hodgman 1974).
void keep_outside(std::span<const Vec2> polygon, Vec2 a, Vec2 b, double side, std::vector<Vec2>& kept) {
  kept.clear();
  const Vec2 along = b - a;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 p = polygon[k], q = polygon[k + 1 == polygon.size() ? 0 : k + 1];
    const double from_p = side * cross(along, p - a), from_q = side * cross(along, q - a);
    if (from_p >= 0.0) kept.push_back(p);
    if ((from_p >= 0.0) != (from_q >= 0.0)) kept.push_back(p + (q - p) * (from_p / (from_p - from_q)));
  }
}

// The number of steps of an arc around half a circle, for a radius in units of `finest`.
int steps_of_end(double radius_over_finest) {
  // A chord over pi / n deviates by r (1 - cos(pi / 2 n)), about r (pi / 2 n)^2 / 2, of which half lies on either side.
  const double steps = 0.5 * std::numbers::pi * std::sqrt(0.25 * radius_over_finest / kOff);
  return static_cast<int>(std::clamp(std::ceil(steps), 2.0, static_cast<double>(kMaxSteps)));
}

// The radius of a round end's corners for which it has the right area; the first and the last keep the line's width.
double end_radius(int steps) {
  const double k = steps - 2.0, whole = std::numbers::pi / std::sin(std::numbers::pi / steps);
  return k > 0.0 ? (std::sqrt(1.0 + k * whole) - 1.0) / k : 0.5 * whole;
}

}  // namespace

PlaneView PlaneView::through(std::span<const Vec2, 3> p, std::span<const Vec2, 3> points_mm) {
  const Vec2 u = p[1] - p[0], v = p[2] - p[0];
  const Vec2 to_u = points_mm[1] - points_mm[0], to_v = points_mm[2] - points_mm[0];
  const double scale = 1.0 / cross(u, v);
  PlaneView view;
  view.along_x = (to_u * v.y - to_v * u.y) * scale;
  view.along_y = (to_v * u.x - to_u * v.x) * scale;
  view.origin = points_mm[0] - view.along_x * p[0].x - view.along_y * p[0].y;
  return view;
}

ShadowClipper::Box ShadowClipper::box_of(std::span<const Vec2> polygon) {
  Box box{polygon[0], polygon[0]};
  for (const Vec2 p : polygon) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

// Adds outline_, which is in mm, clipped to the region.
void ShadowClipper::add_part(const DirtStroke& stroke, std::uint64_t shape, const PlaneView& view) {
  const double determinant = cross(view.along_x, view.along_y);
  inside_.clear();
  for (const Vec2 p : outline_) {
    const Vec2 q = p - view.origin;
    inside_.push_back({cross(q, view.along_y) / determinant, cross(view.along_x, q) / determinant});
  }
  make_counter_clockwise(inside_);
  for (std::size_t k = 0; k < region_.size() && inside_.size() > 2; ++k) {
    keep_outside(inside_, region_[k], region_[k + 1 == region_.size() ? 0 : k + 1], 1.0, scratch_);
    inside_.swap(scratch_);
  }
  if (inside_.size() < 3 || !(twice_area(inside_) > kNothing * twice_area(region_))) return;
  parts_.push_back({shape, stroke.opacity, inside_, box_of(inside_)});
}

// A straight stroke is convex; a curved one is divided along its line into parts with straight sides.
void ShadowClipper::add_parts(const DirtStroke& stroke, std::uint64_t shape, const PlaneView& view, double finest_mm) {
  const double half = 0.5 * stroke.width_mm;
  const double sagitta = 0.125 * stroke.length_mm * std::abs(stroke.bend_rad) / finest_mm;
  const int along =
      static_cast<int>(std::clamp(std::ceil(std::sqrt(sagitta / kOff)), 1.0, static_cast<double>(kMaxSteps)));
  const int around = steps_of_end(half / finest_mm);
  const double out = end_radius(around);
  const Vec2 step{std::cos(std::numbers::pi / around), std::sin(std::numbers::pi / around)};
  const auto add_end = [&](Vec2 middle, Vec2 from) {  // a left turn about `middle`, without its first and last corner
    Vec2 to = from * out;
    for (int k = 1; k < around; ++k) {
      to = {to.x * step.x - to.y * step.y, to.x * step.y + to.y * step.x};
      outline_.push_back(middle + to);
    }
  };
  // Chords lie on both sides of the line, since on one side their mean deviation would be 2/3 of their sagitta.
  const double sagitta_mm = 2.0 / 3.0 * 0.125 * stroke.length_mm * stroke.bend_rad / (along * along);
  const auto at = [&](double fraction) { return stroke.at(fraction) - stroke.normal_at(fraction) * sagitta_mm; };
  Vec2 low = at(-0.5), to_low = stroke.normal_at(-0.5) * half;
  for (int k = 1; k <= along; ++k) {
    const double fraction = static_cast<double>(k) / along - 0.5;
    const Vec2 high = at(fraction), to_high = stroke.normal_at(fraction) * half;
    outline_.assign({low - to_low, high - to_high});
    if (k == along) add_end(high, to_high * -1.0);
    outline_.push_back(high + to_high);
    outline_.push_back(low + to_low);
    if (k == 1) add_end(low, to_low);
    add_part(stroke, shape, view);
    low = high;
    to_low = to_high;
  }
}

// Divides a piece into what another part does not cover, and the covered rest, which the other part dims. Returns false
// if they do not meet.
bool ShadowClipper::clip_by(const Part& other, Piece piece, std::vector<Piece>& out) {
  const std::size_t before = out.size();
  const double nothing = kNothing * twice_area(region_);
  const double blocked = piece.blocked;
  for (std::size_t k = 0; k < other.outline.size(); ++k) {
    const Vec2 a = other.outline[k], b = other.outline[k + 1 == other.outline.size() ? 0 : k + 1];
    keep_outside(piece.outline, a, b, -1.0, scratch_);
    if (scratch_.size() > 2 && twice_area(scratch_) > nothing) out.push_back({scratch_, blocked});
    keep_outside(piece.outline, a, b, 1.0, scratch_);
    piece.outline.swap(scratch_);
    if (piece.outline.size() < 3 || !(twice_area(piece.outline) > nothing)) {
      out.resize(before);
      return false;
    }
  }
  piece.blocked *= 1.0 - other.opacity;
  if (piece.blocked > 0.0) out.push_back(std::move(piece));
  return true;
}

// Sets pieces_ to what a part blocks of the light that the parts before it transmit.
void ShadowClipper::subtract_earlier_shapes(std::size_t part) {
  const Part& own = parts_[part];
  pieces_.clear();
  pieces_.push_back({own.outline, own.opacity});
  for (std::size_t k = 0; k < part && !pieces_.empty(); ++k) {
    const Part& other = parts_[k];
    if (other.shape == own.shape || !other.box.meets(own.box)) continue;
    next_.clear();
    for (Piece& piece : pieces_)
      if (!box_of(piece.outline).meets(other.box) || !clip_by(other, piece, next_)) next_.push_back(std::move(piece));
    pieces_.swap(next_);
  }
}

void ShadowClipper::for_each(const DirtField& dirt, std::span<const PlaneView> crossings, std::span<const Vec2> polygon,
                             double finest_mm, const Shadow& visit) {
  if (polygon.size() < 3 || !(finest_mm > 0.0)) return;
  region_.assign(polygon.begin(), polygon.end());
  make_counter_clockwise(region_);
  cut(dirt, crossings, finest_mm, 0, visit);
}

// Visits the shadows on region_.
void ShadowClipper::cut(const DirtField& dirt, std::span<const PlaneView> crossings, double finest_mm, int depth,
                        const Shadow& visit) {
  find_parts(dirt, crossings, finest_mm);
  if (parts_.size() > kManyParts && depth < kMaxDepth) {
    const Polygon whole = region_;
    const Box box = box_of(whole);
    const Vec2 middle = (box.low + box.high) * 0.5, size = box.high - box.low;
    const Vec2 beyond = middle + (size.x > size.y ? Vec2{0.0, 1.0} : Vec2{1.0, 0.0});
    for (const double side : {1.0, -1.0}) {
      keep_outside(whole, middle, beyond, side, region_);
      if (region_.size() > 2 && twice_area(region_) > 0.0) cut(dirt, crossings, finest_mm, depth + 1, visit);
    }
    return;
  }
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    subtract_earlier_shapes(k);
    for (const Piece& piece : pieces_) visit(piece.outline, piece.blocked);
  }
}

void ShadowClipper::find_parts(const DirtField& dirt, std::span<const PlaneView> crossings, double finest_mm) {
  parts_.clear();
  for (std::size_t c = 0; c < crossings.size(); ++c) {
    const PlaneView& view = crossings[c];
    if (!(std::abs(cross(view.along_x, view.along_y)) > 0.0)) continue;
    scratch_.clear();
    for (const Vec2 p : region_) scratch_.push_back(view.at(p));
    const Box box = box_of(scratch_);
    dirt.find_within(box.low, box.high, found_);
    const Vec2 middle = (box.low + box.high) * 0.5;
    const double radius = 0.5 * length(box.high - box.low);
    for (const std::uint32_t k : found_) {
      const DirtStroke& stroke = dirt.shapes()[k];
      if (stroke.distance_mm(middle) < radius) add_parts(stroke, k * crossings.size() + c, view, finest_mm);
    }
  }
}

}  // namespace contrejour::inline internal::stop_patterns
