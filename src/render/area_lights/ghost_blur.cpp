// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/ghost_blur.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <utility>

namespace contrejour::inline internal::area {
namespace {

constexpr double kLargestBlur = 3.0;  // diagonals of the frame: a larger blur makes no visible difference
constexpr int kPeakCells = 40;        // across the frame: cells in which overlapping ghosts are summed
constexpr double kBrightest = 4.0;    // level of a blurred ghost's brightest lines over its mean, at most
constexpr double kGathered = 2.0;     // times the mean level: light brighter than this is near a caustic
constexpr int kFits = 3;              // rounds; each weights lines by the errors that the one before leaves
constexpr double kOfMiddle = 0.02;    // weight relative to all lines, for directions that none constrains
constexpr double kLeast = 0.08;  // the least weight of lines and middle in any direction: few lines there come and go

// Converts sensor mm to pixels: x is mirrored.
Vec2 mirrored(Vec2 v) { return {-v.x, v.y}; }
LinearMap pixels_from(const LinearMap& mm, double pitch_mm) {
  const double s = 1.0 / pitch_mm;
  return {mirrored(mm.x) * s, mirrored(mm.y) * s};
}

double variance(Vec2 row, const LinearMap& covariance) { return dot(row, covariance(row)); }

bool touches(const Frame& frame, Vec2 px, double radius_px) {
  return px.x > -radius_px && px.y > -radius_px && px.x < frame.width + radius_px && px.y < frame.height + radius_px;
}

// The distance from the frame's border; negative outside.
double inside_px(const Frame& frame, Vec2 px) {
  return std::min({px.x, px.y, frame.width - px.x, frame.height - px.y});
}

// The error of a line's blur, as a radius.
double displacement_px(const BlurredLine& f, const LinearMap& px, const LightPiece& piece) {
  const Vec2 made = along(f.normal, px);
  if (!piece.is_symmetric) return 2.0 * std::sqrt(std::max(variance(f.shift_px - made, piece.covariance), 0.0));
  return 2.0 * std::abs(std::sqrt(std::max(variance(f.shift_px, piece.covariance), 0.0)) -
                        std::sqrt(std::max(variance(made, piece.covariance), 0.0)));
}

double edge_width_px(const GhostBlur& ghost, const BlurredLine& f, const LightPiece& piece) {
  const double radius = 2.0 * std::sqrt(std::max(variance(f.shift_px, piece.covariance), 0.0));
  return std::max(std::min(radius, ghost.size_px.x), 1e-3);
}

double weight_of(const GhostBlur& ghost, const BlurredLine& f, const LightPiece& piece) {
  return f.height * f.height * f.length_px / edge_width_px(ghost, f, piece);
}

// How much weight the direction that weighted normals constrain least lacks for kLeast of all. squares: the sum of
// their squares, with weights that sum to `all`.
struct Lack {
  Vec2 direction;
  double weight = 0.0;
};
Lack lack_of(const LinearMap& squares, double all) {
  const double angle = 0.5 * std::atan2(2.0 * squares.x.y, squares.x.x - squares.y.y);
  return {{-std::sin(angle), std::cos(angle)}, std::max(kLeast * all - eigenvalues(squares).x, 0.0)};
}

LinearMap square_of(Vec2 v, double weight) { return {v * (weight * v.x), v * (weight * v.y)}; }

// The map whose rows along all normals are closest to the lines' own: least squares, with weights for which large
// errors grow only linearly in displacement_px.
LinearMap map_through(const GhostBlur& ghost, const LightPiece& piece, const LinearMap& middle) {
  LinearMap best = middle;
  for (int fit = 0; fit < kFits; ++fit) {
    LinearMap squares = kZeroMap, sums = kZeroMap;  // sums: columns by the tangent
    double all = 0.0;
    for (const BlurredLine& f : ghost.lines) {
      const double off = displacement_px(f, best, piece), width = edge_width_px(ghost, f, piece);
      const double w = weight_of(ghost, f, piece) / (1.0 + off / width);
      all += w;
      squares = squares + square_of(f.normal, w);
      sums = sums + LinearMap{f.normal * (w * f.shift_px.x), f.normal * (w * f.shift_px.y)};
    }
    if (!(all > 0.0)) return middle;
    const Lack lack = lack_of(squares, all);
    const LinearMap by_middle = LinearMap{} * (kOfMiddle * all) + square_of(lack.direction, lack.weight);
    best = inverse(squares + by_middle) * (sums + by_middle * middle);
  }
  return best;
}

// A covariance's xx, xy and yy.
using Covariance = std::array<double, 3>;

double variance(Vec2 n, const Covariance& c) { return n.x * n.x * c[0] + 2.0 * n.x * n.y * c[1] + n.y * n.y * c[2]; }

// Weighted equations for a covariance's variances along normals, solved by least squares.
class CovarianceFit {
 public:
  void add(Vec2 n, double wanted, double weight) {
    const std::array<double, 3> row{n.x * n.x, 2.0 * n.x * n.y, n.y * n.y};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) m_[i][j] += weight * row[i] * row[j];
      m_[i][3] += weight * row[i] * wanted;
    }
  }

  [[nodiscard]] Covariance solved() && {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t r = i + 1; r < 3; ++r) {
        const double by = m_[r][i] / m_[i][i];
        for (std::size_t j = i; j < 4; ++j) m_[r][j] -= by * m_[i][j];
      }
    const double yy = m_[2][3] / m_[2][2], xy = (m_[1][3] - m_[1][2] * yy) / m_[1][1];
    return {(m_[0][3] - m_[0][1] * xy - m_[0][2] * yy) / m_[0][0], xy, yy};
  }

 private:
  std::array<std::array<double, 4>, 3> m_{};  // of the unknowns, and the right side
};

// For lights that are the same from both sides only the width of the blur counts, which would be lost in a mean of
// opposite motions. This fits the covariance that has the lines' variances along their normals, and returns a map
// that produces it. As in map_through, large errors of a radius grow only linearly: else a line that comes into the
// frame and moves otherwise than those beside it would change the blur of all at once.
LinearMap map_as_wide(const GhostBlur& ghost, const LightPiece& piece, const LinearMap& through) {
  const LinearMap first = mapped_covariance(through, piece.covariance);
  Covariance best{first.x.x, first.x.y, first.y.y};
  for (int fit = 0; fit < kFits; ++fit) {
    CovarianceFit equations;
    LinearMap squares = kZeroMap;
    double all = 0.0;
    for (const BlurredLine& f : ghost.lines) {
      const double wanted = variance(f.shift_px, piece.covariance);
      const double radius = 2.0 * std::sqrt(std::max(wanted, 0.0)),
                   made = 2.0 * std::sqrt(std::max(variance(f.normal, best), 0.0));
      const double off = std::abs(radius - made) / edge_width_px(ghost, f, piece);
      // The difference of squared radii is that of the radii times their sum.
      const double w = weight_of(ghost, f, piece) / (1.0 + off) / std::max((radius + made) * (radius + made), 1e-6);
      equations.add(f.normal, wanted, w);
      squares = squares + square_of(f.normal, w);
      all += w;
    }
    if (!(all > 0.0)) return through;
    const Lack lack = lack_of(squares, all);
    equations.add(lack.direction, dot(lack.direction, first(lack.direction)), lack.weight);
    for (const Vec2 n : {Vec2{1.0, 0.0}, Vec2{std::sqrt(0.5), std::sqrt(0.5)}, Vec2{0.0, 1.0}})
      equations.add(n, dot(n, first(n)), kOfMiddle * all);
    best = std::move(equations).solved();
  }
  const LinearMap root = square_root({{best[0], best[1]}, {best[1], best[2]}});
  const LinearMap light = square_root(piece.covariance);
  if (!(light.determinant() > 0.0) || !std::isfinite(root.x.x + root.x.y + root.y.y)) return through;
  // Rotated as the other map rotates the light: the rotation, or reflection, nearest to that map.
  const LinearMap map = through * light, stretch = square_root(transposed(map) * map);
  const bool can_rotate = std::abs(stretch.determinant()) > 1e-9 * trace_of(stretch) * trace_of(stretch);
  return (can_rotate ? root * map * inverse(stretch) : root) * inverse(light);
}

// Sets the lines that reach the frame.
void set_lines(GhostBlur& ghost, const GhostMotion& motion, const Frame& frame, Vec2 shift_mm, double value) {
  const double outline_px = std::numbers::pi * (ghost.blur_px.x + ghost.blur_px.y + ghost.size_px.x + ghost.size_px.y);
  const double ghost_px = std::numbers::pi * ghost.size_px.x * ghost.size_px.y;
  const double mean = ghost.flux / std::max(ghost_px, 1.0), largest = kBrightest * ghost.flux / ghost.area_px;
  for (const GhostLine& f : motion.lines) {
    const double own_px = std::max(f.fraction * outline_px, 1e-3);
    const double within_px = inside_px(frame, frame.pixel_from_sensor(f.at_mm + shift_mm)) + ghost.blur_px.x;
    const double inside = std::clamp(0.5 + within_px / own_px, 0.0, 1.0);
    const double visible = inside * inside * (3.0 - 2.0 * inside);
    if (visible == 0.0) continue;
    BlurredLine px;
    px.normal = mirrored(f.normal);
    px.at_px = frame.pixel_from_sensor(f.at_mm + shift_mm);
    px.shift_px = f.shift_mm * (1.0 / frame.pixel_pitch_mm);
    const double density = f.density * value;
    px.height = std::min(f.is_border ? density : std::max(density - kGathered * mean, 0.0), largest);
    px.length_px = visible * own_px;
    ghost.lines.push_back(px);
  }
}

// The area over which the light of a blurred ghost is spread: its flux over the mean level, weighted by light. Most of
// a ghost's light may be in a small part of its extent. Each part of the pupil alone would make a ghost of the area
// flux / density, which the blur enlarges; where the ghost is folded, its parts overlap, and the extent is smaller.
double area_of(const GhostBlur& ghost, const GhostMotion& motion, double value) {
  const double blurred_px = std::numbers::pi * ghost.blur_px.x * ghost.blur_px.y + 1.0;
  const double extent_px = std::numbers::pi * ghost.size_px.x * ghost.size_px.y + blurred_px;
  double level = 0.0, all = 0.0;
  for (const GhostLine& f : motion.lines) {
    if (f.is_border || !(f.density > 0.0)) continue;
    level += f.fraction / (ghost.flux / (f.density * value) + blurred_px);
    all += f.fraction;
  }
  return level > 0.0 ? std::min(all / level, extent_px) : extent_px;
}

// Sets the radii of the blur that a map produces.
void set_blur(GhostBlur& ghost, const LightPiece& piece, const Frame& frame) {
  ghost.blur_px = radii_of(mapped_covariance(ghost.px, piece.covariance));
  const double largest = kLargestBlur * std::hypot(frame.width, frame.height);
  if (ghost.blur_px.y > largest) {
    ghost.px = ghost.px * (largest / ghost.blur_px.y);
    ghost.blur_px = ghost.blur_px * (largest / ghost.blur_px.y);
  }
}

// Nothing in a blurred ghost is brighter than if all its light came from one point: its flux times the peak of the
// blur's kernel. In a spot much smaller than its blur, the sharp ghost's lines are far brighter than that.
void limit_lines(GhostBlur& ghost, const LightPiece& piece) {
  const double over_disc = piece.is_disc ? 1.0 : 2.0;  // a kernel's peak over that of a disc as wide; soft pieces' is 2
  const double blurred_px = std::numbers::pi * ghost.blur_px.x * ghost.blur_px.y;
  if (!(blurred_px > 0.0)) return;
  for (BlurredLine& f : ghost.lines) f.height = std::min(f.height, over_disc * ghost.flux / blurred_px);
}

}  // namespace

Vec2 radii_of(const LinearMap& covariance) {
  const Vec2 e = eigenvalues(covariance);
  return {2.0 * std::sqrt(std::max(e.x, 0.0)), 2.0 * std::sqrt(std::max(e.y, 0.0))};
}

GhostBlur blur_of(const GhostMotion& motion, const LightPiece& piece, const Frame& frame, Vec2 shift_mm, double value) {
  GhostBlur ghost;
  if (!(motion.flux_mm2 > 0.0)) return ghost;
  const LinearMap middle = pixels_from(motion.shift_mm, frame.pixel_pitch_mm);
  const LinearMap spread = pixels_from(motion.spread_mm, frame.pixel_pitch_mm);
  ghost.size_px = radii_of(spread * transposed(spread) * 0.25);
  ghost.at_px = frame.pixel_from_sensor(motion.centroid_mm + shift_mm);
  ghost.flux = motion.flux_mm2 * value / (frame.pixel_pitch_mm * frame.pixel_pitch_mm);
  ghost.px = middle;
  set_blur(ghost, piece, frame);
  ghost.area_px = area_of(ghost, motion, value);
  set_lines(ghost, motion, frame, shift_mm, value);
  ghost.px = map_through(ghost, piece, middle);
  ghost.motion_px = ghost.px;
  if (piece.is_symmetric) ghost.px = map_as_wide(ghost, piece, ghost.px);
  // A disc is the same rotated and mirrored, so that the map's symmetric factor is sufficient.
  if (piece.is_disc) ghost.px = square_root(ghost.px * transposed(ghost.px));
  set_blur(ghost, piece, frame);
  ghost.area_px = area_of(ghost, motion, value);
  limit_lines(ghost, piece);
  // Twice the distance that first derivatives predict, since ghosts are larger than that where they are not sharp.
  if (touches(frame, ghost.at_px, 2.0 * (ghost.size_px.y + ghost.blur_px.y))) ghost.level = ghost.flux / ghost.area_px;
  return ghost;
}

GhostBlur dimmed(GhostBlur ghost, double factor) {
  ghost.level *= factor;
  ghost.flux *= factor;
  for (BlurredLine& f : ghost.lines) f.height *= factor;
  return ghost;
}

GhostBlur softened(GhostBlur ghost, const LightPiece& piece) {
  const LinearMap root = square_root(piece.covariance);
  ghost.px = ghost.px * root;
  ghost.px = square_root(ghost.px * transposed(ghost.px));
  for (BlurredLine& f : ghost.lines) f.shift_px = root(f.shift_px);
  return ghost;
}

double map_error(const GhostBlur& ghost, const LinearMap& px, const LightPiece& piece, double peak, double enough) {
  if (!(ghost.level > 0.0) || !(peak > 0.0)) return 0.0;
  double squares = 0.0;
  for (const BlurredLine& f : ghost.lines) {
    squares +=
        f.length_px * misfit_error(f.height / peak, edge_width_px(ghost, f, piece), displacement_px(f, px, piece));
    if (squares > enough) break;
  }
  return squares;
}

GhostBlur as_drawn(GhostBlur ghost) {
  for (BlurredLine& f : ghost.lines) f.shift_px = along(f.normal, ghost.px);
  return ghost;
}

namespace {

// A ghost's mean level in a cell at some distance of its middle, over its own level; lengths in cells. It fades over a
// cell's width, so that the sums change steadily as the ghost moves.
double coverage(double distance, double radius) {
  return std::clamp(radius - distance + 0.5, 0.0, 1.0) * std::min(std::numbers::pi * radius * radius, 1.0);
}

// The value that this fraction of all values reaches, or a little less: by linear interpolation between neighbours in
// their order.
double reached_by(std::vector<double> values, double fraction) {
  const double at = std::max((1.0 - fraction) * static_cast<double>(values.size() - 1) - 1.0, 0.0);
  const auto below = static_cast<std::ptrdiff_t>(at);
  const auto nth = values.begin() + below;
  std::nth_element(values.begin(), nth, values.end());
  if (nth + 1 == values.end()) return *nth;
  return std::lerp(*nth, *std::min_element(nth + 1, values.end()), at - static_cast<double>(below));
}

// The area of a blurred ghost that lies in the frame: of one as large across the frame's nearest border as across its
// longer axis. It is not quite 0 elsewhere, so that ghosts count if there are no others.
double visible_px(const GhostBlur& ghost, const Frame& frame) {
  constexpr double kLeast = 1e-6;
  const double radius_px = std::hypot(ghost.size_px.y, ghost.blur_px.y) + 0.5;
  const double inside = std::clamp(0.5 + 0.5 * inside_px(frame, ghost.at_px) / radius_px, 0.0, 1.0);
  return ghost.area_px * std::max(inside * inside * (3.0 - 2.0 * inside), kLeast);
}

// The level of the brightest ghosts that together fill about this area of the frame: the mean from half of it to one
// and a half times as much, which changes steadily as ghosts become brighter or enter the frame.
double brightest_over(const std::vector<GhostBlur>& ghosts, const Frame& frame, double area_px) {
  std::vector<const GhostBlur*> by_level;
  for (const GhostBlur& ghost : ghosts)
    if (ghost.level > 0.0) by_level.push_back(&ghost);
  std::ranges::stable_sort(by_level, std::greater(), &GhostBlur::level);
  const double from_px = 0.5 * area_px, to_px = 1.5 * area_px;
  double filled_px = 0.0, light = 0.0, counted_px = 0.0;
  for (const GhostBlur* ghost : by_level) {
    const double end_px = filled_px + visible_px(*ghost, frame);
    const double within_px = std::max(std::min(end_px, to_px) - std::max(filled_px, from_px), 0.0);
    light += ghost->level * within_px;
    counted_px += within_px;
    filled_px = end_px;
  }
  if (counted_px > 0.0) return light / counted_px;
  return by_level.empty() ? 0.0 : by_level.back()->level;
}

}  // namespace

double peak_of(const std::vector<GhostBlur>& ghosts, const Frame& frame) {
  // Sums overlapping ghosts in the cells of a small frame.
  const double cell = static_cast<double>(std::max(frame.width, frame.height)) / kPeakCells;
  const int columns = std::max(1, static_cast<int>(frame.width / cell));
  const int rows = std::max(1, static_cast<int>(frame.height / cell));
  std::vector<double> sums(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0);
  const auto within = [](double at, int count) { return static_cast<int>(std::clamp(at, 0.0, count - 1.0)); };
  for (const GhostBlur& ghost : ghosts) {
    if (!(ghost.level > 0.0)) continue;
    const Vec2 at = ghost.at_px * (1.0 / cell) - Vec2{0.5, 0.5};
    const double radius = std::sqrt(ghost.area_px / std::numbers::pi) / cell, reach = radius + 0.5;
    for (int y = within(at.y - reach, rows); y <= within(at.y + reach, rows); ++y)
      for (int x = within(at.x - reach, columns); x <= within(at.x + reach, columns); ++x)
        sums[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] +=
            ghost.level * coverage(length(Vec2{x - at.x, y - at.y}), radius);
  }
  // Spots are smaller than such a cell.
  return std::max(reached_by(std::move(sums), kPeakFraction),
                  brightest_over(ghosts, frame, kPeakFraction * frame.width * frame.height));
}

}  // namespace contrejour::inline internal::area
