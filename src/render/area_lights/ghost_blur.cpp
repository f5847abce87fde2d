// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/ghost_blur.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "render/area_lights/ghost_area.h"

namespace contrejour::inline internal::area {
namespace {

constexpr double kLargestBlur = 3.0;  // diagonals of the frame: a larger blur makes no visible difference
constexpr double kBrightest = 4.0;    // level of a blurred ghost's brightest lines over its mean, at most
constexpr double kGathered = 2.0;     // times the mean level: light brighter than this is near a caustic
constexpr double kSteadyFit = 0.3;    // of a line's blur: smaller errors of a fit count by their squares
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

// The error of a blur from which on it counts linearly in a fit. If lines of two kinds move differently, a fit in which
// all errors count linearly is undecided between them, and changes from one to the other at once.
double linear_from_px(const GhostBlur& ghost, const BlurredLine& f, const LightPiece& piece) {
  const double radius = 2.0 * std::sqrt(std::max(variance(f.shift_px, piece.covariance), 0.0));
  return edge_width_px(ghost, f, piece) + kSteadyFit * radius;
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
      const double off = displacement_px(f, best, piece) / linear_from_px(ghost, f, piece);
      const double w = weight_of(ghost, f, piece) / (1.0 + off);
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
      const double off = std::abs(radius - made) / linear_from_px(ghost, f, piece);
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

// The length of the outline that a line represents.
double own_length_px(const GhostBlur& ghost, const GhostLine& f) {
  return std::max(f.fraction * outline_px(ghost), 1e-3);
}

// The part of each line that lies in the frame.
std::vector<double> visible_parts(const GhostBlur& ghost, const GhostMotion& motion, const Frame& frame,
                                  Vec2 shift_mm) {
  std::vector<double> visible;
  for (const GhostLine& f : motion.lines) {
    const double own_px = own_length_px(ghost, f);
    const double within_px = inside_px(frame, frame.pixel_from_sensor(f.at_mm + shift_mm)) + ghost.blur_px.x;
    const double inside = std::clamp(0.5 + within_px / own_px, 0.0, 1.0);
    visible.push_back(inside * inside * (3.0 - 2.0 * inside));
  }
  return visible;
}

// The fraction of the pupil whose light lands in the frame. All of it may, if the ghost has no interior rays.
double visible_light(const GhostMotion& motion, const std::vector<double>& visible) {
  double light = 0.0, all = 0.0;
  for (std::size_t k = 0; k < motion.lines.size(); ++k) {
    if (motion.lines[k].is_border) continue;
    light += visible[k] * motion.lines[k].fraction;
    all += motion.lines[k].fraction;
  }
  return all > 0.0 ? light / all : 1.0;
}

// The mean level of the light in the frame.
double visible_level(const GhostBlur& ghost) { return ghost.visible * ghost.flux / ghost.area_px; }

// Sets the lines that reach the frame.
void set_lines(GhostBlur& ghost, const GhostMotion& motion, const std::vector<double>& visible, const Frame& frame,
               Vec2 shift_mm, double value) {
  const double ghost_px = std::numbers::pi * ghost.size_px.x * ghost.size_px.y;
  const double mean = ghost.flux / std::max(ghost_px, 1.0), largest = kBrightest * visible_level(ghost);
  for (std::size_t k = 0; k < motion.lines.size(); ++k) {
    if (visible[k] == 0.0) continue;
    const GhostLine& f = motion.lines[k];
    BlurredLine px;
    px.normal = mirrored(f.normal);
    px.at_px = frame.pixel_from_sensor(f.at_mm + shift_mm);
    px.shift_px = f.shift_mm * (1.0 / frame.pixel_pitch_mm);
    const double density = f.density * value;
    px.height = std::min(f.is_border ? density : std::max(density - kGathered * mean, 0.0), largest);
    px.length_px = visible[k] * own_length_px(ghost, f);
    ghost.lines.push_back(px);
  }
}

// The covariance of a point's blur: by the ghost's map, and by how far the lines' own motions differ from it.
LinearMap blur_covariance(const GhostBlur& ghost, const LightPiece& piece) {
  double sum = 0.0, all = 0.0;
  for (const BlurredLine& f : ghost.lines) {
    const double weight = weight_of(ghost, f, piece);
    sum += weight * displacement_px(f, ghost.px, piece);
    all += weight;
  }
  const double deviation = all > 0.0 ? 0.5 * sum / all : 0.0;
  return mapped_covariance(ghost.px, piece.covariance) + LinearMap{} * (deviation * deviation);
}

// The parts of a ghost that its interior rays stand for, with the light that lands in the frame. If none does, all
// light counts; a ghost without such rays is one part.
std::vector<GhostPart> parts_of(const GhostMotion& motion, const std::vector<double>& visible, double px_by_mm) {
  const LinearMap to_px{{-px_by_mm, 0.0}, {0.0, px_by_mm}};
  std::vector<GhostPart> parts;
  double all = 0.0, seen = 0.0;
  for (std::size_t k = 0; k < motion.lines.size(); ++k) {
    const GhostLine& f = motion.lines[k];
    if (f.is_border) continue;
    parts.push_back({to_px(f.at_mm), mapped_covariance(to_px, f.covariance_mm2), f.fraction});
    all += f.fraction;
    seen += f.fraction * visible[k];
  }
  if (!(all > 0.0))
    return {{{}, mapped_covariance(to_px, motion.spread_mm * transposed(motion.spread_mm) * 0.25), 1.0}};
  std::size_t next = 0;
  for (std::size_t k = 0; k < motion.lines.size(); ++k)
    if (!motion.lines[k].is_border) parts[next++].light *= (seen > 0.0 ? visible[k] : 1.0) / all;
  return parts;
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

// A sharp ghost's brightest lines may be kBrightest times its mean level. Blur spreads them: a spot much smaller than
// its blur has one level. sharp_px: the area of the ghost without blur.
void limit_lines(GhostBlur& ghost, double sharp_px, bool by_disc) {
  const double over_disc = by_disc ? 1.0 : 2.0;  // a kernel's peak over that of a disc as wide; soft pieces' is 2
  const double over_mean = std::lerp(over_disc, kBrightest, std::min(sharp_px / ghost.area_px, 1.0));
  for (BlurredLine& f : ghost.lines) f.height = std::min(f.height, over_mean * visible_level(ghost));
}

}  // namespace

Vec2 radii_of(const LinearMap& covariance) {
  const Vec2 e = eigenvalues(covariance);
  return {2.0 * std::sqrt(std::max(e.x, 0.0)), 2.0 * std::sqrt(std::max(e.y, 0.0))};
}

// The distance from the frame's border; negative outside.
double inside_px(const Frame& frame, Vec2 px) {
  return std::min({px.x, px.y, frame.width - px.x, frame.height - px.y});
}

double outline_px(const GhostBlur& ghost) {
  return std::numbers::pi * (ghost.blur_px.x + ghost.blur_px.y + ghost.size_px.x + ghost.size_px.y);
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
  const std::vector<double> visible = visible_parts(ghost, motion, frame, shift_mm);
  const std::vector<GhostPart> parts = parts_of(motion, visible, 1.0 / frame.pixel_pitch_mm);
  ghost.visible = visible_light(motion, visible);
  ghost.area_px = light_area_px(parts, mapped_covariance(ghost.px, piece.covariance));
  set_lines(ghost, motion, visible, frame, shift_mm, value);
  ghost.px = map_through(ghost, piece, middle);
  ghost.motion_px = ghost.px;
  if (piece.is_symmetric) ghost.px = map_as_wide(ghost, piece, ghost.px);
  // A disc is the same rotated and mirrored, so that the map's symmetric factor is sufficient.
  if (piece.is_disc) ghost.px = square_root(ghost.px * transposed(ghost.px));
  set_blur(ghost, piece, frame);
  const LinearMap blur = blur_covariance(ghost, piece);
  ghost.area_px = light_area_px(parts, blur);
  limit_lines(ghost, light_area_px(parts, kZeroMap), piece.is_disc);
  // Twice the distance that first derivatives predict, since ghosts are larger than that where they are not sharp.
  if (touches(frame, ghost.at_px, 2.0 * (ghost.size_px.y + ghost.blur_px.y))) ghost.level = visible_level(ghost);
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

GhostBlur as_drawn(GhostBlur ghost, const LightPiece& piece) {
  constexpr int kNormals = 6;
  for (BlurredLine& f : ghost.lines) f.shift_px = along(f.normal, ghost.px);
  // The outline of the blur itself, which a spot shows in all directions, whatever the directions of its own lines.
  const Vec2 radii = radii_of(blur_covariance(ghost, piece));
  for (int k = 0; k < kNormals; ++k) {
    const double angle = k * std::numbers::pi / kNormals;
    BlurredLine f;
    f.normal = {std::cos(angle), std::sin(angle)};
    f.at_px = ghost.at_px;
    f.shift_px = along(f.normal, ghost.px);
    f.height = ghost.level;
    f.length_px = ghost.visible * std::numbers::pi * (radii.x + radii.y) / kNormals;
    ghost.lines.push_back(f);
  }
  return ghost;
}

}  // namespace contrejour::inline internal::area
