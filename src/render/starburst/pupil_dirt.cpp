// SPDX-License-Identifier: Apache-2.0
// Shapes keep sharp edges: their outlines are mapped corner by corner, and their coverage of the mask's samples is
// exact.
#include "render/starburst/pupil_dirt.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "render/starburst/mask_points.h"
#include "render/starburst/smooth_fit.h"

namespace contrejour::inline internal {
namespace {

constexpr double kBoxMargin = 0.01;   // of the box of the rays: polynomials are not valid far beyond
constexpr double kLongestEdge = 0.03;  // of the box: longer edges are split, since they bend in the map
constexpr int kSamplesAlong = 64;        // steps along a stroke, to find the part of it that is open,
constexpr int kSamplesAcross = 5;        // and points on a side of a speck
constexpr double kOpen = 0.5;         // amplitude
constexpr int kBisections = 12;
constexpr int kMaxSubsamples = 4;    // on a side of a mask's sample, where a picture is finer

struct Box {
  Vec2 low, high;
  [[nodiscard]] double size() const { return std::max(high.x - low.x, high.y - low.y); }
};

Box box_of(const std::vector<Vec2>& points) {
  Box box{points.front(), points.front()};
  for (const Vec2 p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  const Vec2 margin = (box.high - box.low) * kBoxMargin;
  return {box.low - margin, box.high + margin};
}

// The part where sign * (coordinate - bound) >= 0 (Sutherland & Hodgman 1974). Pieces of a shape that is not convex may
// stay connected along the bound, where they cover no area.
template <double Vec2::* coordinate>
std::vector<Vec2> cut(const std::vector<Vec2>& polygon, double bound, double sign) {
  std::vector<Vec2> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    const double from_a = sign * (a.*coordinate - bound), from_b = sign * (b.*coordinate - bound);
    if (from_a >= 0.0) kept.push_back(a);
    if ((from_a >= 0.0) != (from_b >= 0.0)) kept.push_back(a + (b - a) * (from_a / (from_a - from_b)));
  }
  return kept;
}

std::vector<Vec2> part_within(const std::vector<Vec2>& polygon, const Box& box) {
  return cut<&Vec2::y>(
      cut<&Vec2::y>(cut<&Vec2::x>(cut<&Vec2::x>(polygon, box.low.x, 1.0), box.high.x, -1.0), box.low.y, 1.0),
      box.high.y, -1.0);
}

class PupilDirtPainter {
 public:
  PupilDirtPainter(const LensState& lens, const LightSource& light, const PupilRays& pupil,
                   const std::vector<std::size_t>& used, int degree, ExitPupil& out)
      : dirt_(lens.dirt), out_(out), points_(points_of(lens, light, pupil, used)), box_(box_of(points_)),
        cosines_(cosines_of(pupil, used)), to_pupil_(fit_points(points_, cosines_, degree)), degree_(degree) {
    const std::size_t surface = dirt_.plane == DirtPlane::Front ? 0 : static_cast<std::size_t>(lens.stop_index);
    clear_radius_mm_ = lens.surfaces[surface].semi_diameter_mm;
  }

  void paint(double power_mm2) {
    const std::vector<float> clean = out_.mask.amplitude;
    MaskPower power(clean.size(), 1.0F);
    const std::vector<DirtStroke> strokes = dirt_within(dirt_, box_.low, box_.high);
    std::vector<DimPolygon> polygons;
    for (const DirtStroke& stroke : strokes) polygons.push_back({in_pupil(dirt_outline(stroke)), 1.0 - stroke.opacity});
    dim(out_.mask, power, polygons);
    if (dirt_.picture) dim_by_picture(power);

    double all = 0.0, left = 0.0;
    for (std::size_t k = 0; k < clean.size(); ++k) {
      const double own = static_cast<double>(clean[k]) * clean[k];
      all += own;
      left += own * power[k];
    }
    out_.open_fraction = left / all;
    out_.flux_mm2 *= out_.open_fraction;
    if (!(left > 0.0) || !out_.outline || polygons.empty()) return;
    PupilDirt dirt;
    for (const DirtStroke& stroke : strokes) add_open_part(stroke, clean, dirt.strokes);
    const SmoothFit straight = fit_points(points_, cosines_, 1);
    const auto step = [&](Vec2 to) {
      return Vec2{straight(to, 0) - straight({}, 0), straight(to, 1) - straight({}, 1)};
    };
    dirt.x_mm = step({1.0, 0.0});
    dirt.y_mm = step({0.0, 1.0});
    dirt.power_mm2 = power_mm2 * out_.open_fraction;
    out_.outline->dirt = std::make_shared<const PupilDirt>(std::move(dirt));
  }

 private:
  // The points where rays cross the plane that the dirt lies in.
  static std::vector<Vec2> points_of(const LensState& lens, const LightSource& light, const PupilRays& pupil,
                                     const std::vector<std::size_t>& used) {
    const auto front = [&](const PupilRay& ray) {
      const Vec3 along = light.direction_at({ray.entrance_mm.x, ray.entrance_mm.y, pupil.z_mm});
      const double steps = (lens.surfaces.front().z_mm - pupil.z_mm) / along.z;
      return ray.entrance_mm + Vec2{along.x, along.y} * steps;
    };
    std::vector<Vec2> points;
    for (const std::size_t k : used)
      points.push_back(lens.dirt.plane == DirtPlane::Front ? front(pupil.rays[k])
                                                           : pupil.rays[k].stop * lens.stop_radius_mm);
    return points;
  }
  static std::vector<Vec2> cosines_of(const PupilRays& pupil, const std::vector<std::size_t>& used) {
    std::vector<Vec2> cosines;
    for (const std::size_t k : used) cosines.push_back(pupil.rays[k].cosines);
    return cosines;
  }
  [[nodiscard]] Vec2 in_pupil(Vec2 point) const {
    double cosines[2];
    to_pupil_.evaluate(point, cosines);
    return Vec2{cosines[0], cosines[1]} - out_.middle;
  }
  [[nodiscard]] std::vector<Vec2> in_pupil(const std::vector<Vec2>& outline) const {
    const std::vector<Vec2> within = part_within(outline, box_);
    std::vector<Vec2> corners;
    for (std::size_t k = 0; k < within.size(); ++k) {
      const Vec2 a = within[k], b = within[(k + 1) % within.size()];
      const int parts = std::max(1, static_cast<int>(std::ceil(length(b - a) / (kLongestEdge * box_.size()))));
      for (int i = 0; i < parts; ++i) corners.push_back(in_pupil(a + (b - a) * (static_cast<double>(i) / parts)));
    }
    return corners;
  }

  // The clean mask's amplitude, linear between samples, so that what is scaled by it changes smoothly.
  [[nodiscard]] double openness(Vec2 point, const std::vector<float>& clean) const {
    if (point.x < box_.low.x || point.y < box_.low.y || point.x > box_.high.x || point.y > box_.high.y) return 0.0;
    const MaskGrid& grid = out_.mask.grid;
    const Vec2 at = in_pupil(point);
    const double x = 0.5 * grid.side + at.x / grid.pitch_mm - 0.5, y = 0.5 * grid.side - at.y / grid.pitch_mm - 0.5;
    if (!(x >= 0.0 && y >= 0.0 && x < grid.side - 1 && y < grid.side - 1)) return 0.0;
    const double s = x - std::floor(x), t = y - std::floor(y);
    const auto side = static_cast<std::size_t>(grid.side);
    const float* const p = clean.data() + static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x);
    return (1.0 - t) * ((1.0 - s) * p[0] + s * p[1]) + t * ((1.0 - s) * p[side] + s * p[side + 1]);
  }

  // Where the opening ends between two points along a stroke's line; the first is open.
  [[nodiscard]] double end_between(const DirtStroke& stroke, double open, double dark,
                                   const std::vector<float>& clean) const {
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (open + dark);
      (openness(stroke.at(middle), clean) > kOpen ? open : dark) = middle;
    }
    return open;
  }

  // Adds a speck scaled to the area of its part in the opening, or the longest part of a scratch that lies in the
  // opening.
  void add_open_part(const DirtStroke& stroke, const std::vector<float>& clean, std::vector<DirtStroke>& out) const {
    if (stroke.length_mm <= stroke.width_mm) return add_open_speck(stroke, clean, out);
    const auto fraction_at = [](int step) { return static_cast<double>(step) / kSamplesAlong - 0.5; };
    int best_first = 0, best_count = 0, count = 0;
    for (int i = 0; i <= kSamplesAlong; ++i) {
      count = openness(stroke.at(fraction_at(i)), clean) > kOpen ? count + 1 : 0;
      if (count > best_count) best_count = count, best_first = i - count + 1;
    }
    if (best_count == 0) return;
    double low = fraction_at(best_first), high = fraction_at(best_first + best_count - 1);
    if (low > -0.5) low = end_between(stroke, low, low - 1.0 / kSamplesAlong, clean);
    if (high < 0.5) high = end_between(stroke, high, high + 1.0 / kSamplesAlong, clean);
    DirtStroke part = stroke;
    part.middle_mm = stroke.at(0.5 * (low + high));
    part.angle_rad += 0.5 * (low + high) * stroke.bend_rad;
    part.bend_rad *= high - low;
    part.length_mm *= high - low;
    part.width_mm = std::min(part.width_mm, part.length_mm);  // a scratch shrinks to nothing, not to a speck
    out.push_back(part);
  }
  void add_open_speck(const DirtStroke& speck, const std::vector<float>& clean, std::vector<DirtStroke>& out) const {
    double open = 0.0;
    for (int i = 0; i < kSamplesAcross * kSamplesAcross; ++i) {
      const Vec2 off =
          Vec2{(i % kSamplesAcross + 0.5) / kSamplesAcross - 0.5, (i / kSamplesAcross + 0.5) / kSamplesAcross - 0.5};
      open += std::min(1.0, openness(speck.middle_mm + off * speck.width_mm, clean));
    }
    if (!(open > 0.0)) return;
    DirtStroke part = speck;
    part.width_mm *= std::sqrt(open) / kSamplesAcross;
    part.length_mm *= std::sqrt(open) / kSamplesAcross;
    out.push_back(part);
  }

  void dim_by_picture(MaskPower& power) {
    const MaskGrid& grid = out_.mask.grid;
    const MaskPoints points(cosines_, points_, degree_, out_.middle, grid);
    const double per_clear_radius = 1.0 / clear_radius_mm_;
    const double finer = points.sample() * per_clear_radius / dirt_.picture->pixel();
    const int sub = std::clamp(static_cast<int>(std::ceil(finer)), 1, kMaxSubsamples);
    std::size_t k = 0;
    for (int row = 0; row < grid.side; ++row) {
      for (int column = 0; column < grid.side; ++column, ++k) {
        if (!(out_.mask.amplitude[k] > 0.0F)) continue;
        double sum = 0.0;
        for (int i = 0; i < sub * sub; ++i) {
          const Vec2 at = points.at(column + (i % sub + 0.5) / sub - 0.5, row + (i / sub + 0.5) / sub - 0.5);
          sum += dirt_.picture->transmission(at * per_clear_radius);
        }
        const double transmittance = sum / (sub * sub);
        out_.mask.amplitude[k] *= static_cast<float>(std::sqrt(transmittance));
        power[k] *= static_cast<float>(transmittance);
      }
    }
  }

  const Dirt& dirt_;
  ExitPupil& out_;
  std::vector<Vec2> points_;  // in mm of the dirt's plane
  Box box_;
  std::vector<Vec2> cosines_;
  SmoothFit to_pupil_;
  int degree_;
  double clear_radius_mm_ = 1;
};

}  // namespace

void add_dirt(const LensState& lens, const LightSource& light, const PupilRays& pupil,
              const std::vector<std::size_t>& used, int degree, double power_mm2, ExitPupil& out) {
  if (!lens.dirt.any() || !(power_mm2 > 0.0)) return;
  PupilDirtPainter(lens, light, pupil, used, degree, out).paint(power_mm2);
}

}  // namespace contrejour::inline internal
