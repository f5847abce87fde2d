// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/ghost_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "contrejour/light.h"
#include "render/pupils/pupil_shape.h"

namespace contrejour::inline internal::area {

using pupils::BorderPoint, pupils::InnerPoint, pupils::kRims, pupils::PupilShape;

namespace {

constexpr double kRayStep = 1e-3;      // of the entrance window's width,
constexpr double kPupilStep = 0.1;     // or of the pupil's standard deviation, whichever is less
constexpr double kAngleStep = 1e-4;    // tangent: 0.01 mm on many sensors; floats resolve a thousandth of it
constexpr double kStrange = 2.0;       // times the motion of something steadier nearby: more is not plausible

double size(const LinearMap& map) { return length(map.x) + length(map.y); }

// Where a ray crosses the stop and a rim, and where it lands.
struct PassingRay {
  bool arrives = false;
  Vec2 sensor_mm;
  std::array<Vec2, kMaxStopCrossings> stop{};  // over its radius
  double rim_squared = 0.0;  // at the rim to which the first ray of its group comes closest
  double transmission = 0.0;
};

// A ray and four next to it: two that start to the right and above, two from lights to the right and above.
using RayFive = std::array<PassingRay, 5>;

// The rays of a ghost, by where they start in the plane of the entrance window.
class Rays {
 public:
  Rays(const LensSteps& steps, Ghost ghost, const LightSource& source, double z_mm)
      : source_(source), z_mm_(z_mm),
        paths_{path(steps, ghost, {}), path(steps, ghost, {kAngleStep, 0.0}), path(steps, ghost, {0.0, kAngleStep})} {}

  [[nodiscard]] std::vector<RayFive> around(const std::vector<Vec2>& starts_mm, double step_mm) {
    const std::size_t count = starts_mm.size();
    std::vector<RayFive> fives(count);
    std::vector<Vec2> near(starts_mm);
    for (const Vec2 at : starts_mm) near.push_back(at + Vec2{step_mm, 0.0});
    for (const Vec2 at : starts_mm) near.push_back(at + Vec2{0.0, step_mm});
    trace(0, near);
    nearest_rim_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      nearest_rim_[k] = nearest_rim(k);
      for (std::size_t j = 0; j < 3; ++j) fives[k][j] = ray(j * count + k, nearest_rim_[k]);
    }
    for (std::size_t light = 1; light <= 2; ++light) {
      trace(light, starts_mm);
      for (std::size_t k = 0; k < count; ++k) fives[k][2 + light] = ray(k, nearest_rim_[k]);
    }
    return fives;
  }

 private:
  [[nodiscard]] PacketPath path(const LensSteps& steps, Ghost ghost, Vec2 tangents) const {
    return {steps, ghost, {{0.0, 0.0, z_mm_}, tangents == Vec2{} ? source_ : offset_source(source_, tangents)}};
  }

  void trace(std::size_t light, const std::vector<Vec2>& starts_mm) {
    PacketPath& path = paths_[light];
    const Vec2 origin_mm = starts_mm.front();
    path.start_from(origin_mm);
    count_ = starts_mm.size();
    fields_.resize((6 + 2 * kMaxStopCrossings + path.steps().size()) * count_);
    for (std::size_t k = 0; k < count_; ++k) {
      field(0)[k] = static_cast<float>(starts_mm[k].x - origin_mm.x);
      field(1)[k] = static_cast<float>(starts_mm[k].y - origin_mm.y);
    }
    TracedArrays out{
        .sensor_x_mm = field(2), .sensor_y_mm = field(3), .transmission = field(4), .relative_height = field(5)};
    for (std::size_t c = 0; c < kMaxStopCrossings; ++c) {
      out.stop_x[c] = field(6 + 2 * c);
      out.stop_y[c] = field(7 + 2 * c);
    }
    out.rim_squared = field(kRimsFrom);
    out.rim_stride = count_;
    trace_packets(path, PacketPrecision::Double, field(0), field(1), count_, out);
  }

  [[nodiscard]] std::size_t nearest_rim(std::size_t k) {
    const std::vector<PacketStep>& steps = paths_[0].steps();
    std::size_t nearest = steps.size();
    for (std::size_t s = 0; s < steps.size(); ++s) {
      if (steps[s].event == PathEvent::Stop) continue;
      if (nearest == steps.size() || field(kRimsFrom + s)[k] > field(kRimsFrom + nearest)[k]) nearest = s;
    }
    return nearest;
  }

  [[nodiscard]] PassingRay ray(std::size_t k, std::size_t rim) {
    PassingRay ray;
    ray.arrives = std::isfinite(field(5)[k]);
    ray.sensor_mm = {field(2)[k], field(3)[k]};
    for (std::size_t c = 0; c < static_cast<std::size_t>(paths_[0].stop_crossings()); ++c)
      ray.stop[c] = {field(6 + 2 * c)[k], field(7 + 2 * c)[k]};
    if (rim < paths_[0].steps().size()) ray.rim_squared = field(kRimsFrom + rim)[k];
    ray.transmission = field(4)[k];
    return ray;
  }

  [[nodiscard]] float* field(std::size_t k) { return fields_.data() + k * count_; }

  static constexpr std::size_t kRimsFrom = 6 + 2 * kMaxStopCrossings;
  LightSource source_;
  double z_mm_;
  std::array<PacketPath, 3> paths_;  // for the light, for one to its right, for one above
  std::size_t count_ = 0;
  std::vector<float> fields_;
  std::vector<std::size_t> nearest_rim_;
};

// First derivatives at a ray.
class LocalMotion {
 public:
  LocalMotion(const RayFive& rays, double step_mm) : rays_(rays), step_mm_(step_mm) {
    sensor_by_start = derivative(1, step_mm, [](const PassingRay& ray) { return ray.sensor_mm; });
    sensor_by_angle = derivative(3, kAngleStep, [](const PassingRay& ray) { return ray.sensor_mm; });
  }

  [[nodiscard]] bool is_usable() const {
    return std::ranges::all_of(rays_, &PassingRay::arrives) && std::isnormal(sensor_by_start.determinant());
  }
  [[nodiscard]] const PassingRay& ray() const { return rays_[0]; }
  [[nodiscard]] double density() const { return ray().transmission / std::abs(sensor_by_start.determinant()); }

  [[nodiscard]] LinearMap stop_by_start(std::size_t crossing) const {
    return derivative(1, step_mm_, [&](const PassingRay& ray) { return ray.stop[crossing]; });
  }
  // How the start moves with the light's direction, if the ray is to cross the stop at the same point.
  [[nodiscard]] LinearMap start_at_stop(std::size_t crossing) const {
    const LinearMap by_start = stop_by_start(crossing);
    if (!std::isnormal(by_start.determinant())) return kZeroMap;
    return inverse(by_start) * derivative(3, kAngleStep, [&](const PassingRay& ray) { return ray.stop[crossing]; }) *
           -1.0;
  }
  // How the point on the sensor moves with the angle, if the start moves as given.
  [[nodiscard]] LinearMap shift(const LinearMap& start_by_angle) const {
    return sensor_by_angle + sensor_by_start * start_by_angle;
  }

  // The derivatives, by start and by light direction, of the height that is too large where neighbouring rays are
  // blocked.
  struct Bound {
    Vec2 by_start, by_angle;
  };
  [[nodiscard]] Bound bound(int which) const {
    const auto height = [&](const PassingRay& ray) {
      if (which == kRims) return ray.rim_squared;
      const Vec2 at = ray.stop[static_cast<std::size_t>(which)];
      return dot(at, at);
    };
    const double here = height(rays_[0]);
    return {Vec2{height(rays_[1]) - here, height(rays_[2]) - here} * (1.0 / step_mm_),
            Vec2{height(rays_[3]) - here, height(rays_[4]) - here} * (1.0 / kAngleStep)};
  }

  LinearMap sensor_by_start, sensor_by_angle;

 private:
  template <class At>
  [[nodiscard]] LinearMap derivative(std::size_t first, double step, const At& at_point) const {
    return {(at_point(rays_[first]) - at_point(rays_[0])) * (1.0 / step),
            (at_point(rays_[first + 1]) - at_point(rays_[0])) * (1.0 / step)};
  }

  const RayFive& rays_;
  double step_mm_;
};

// A ray at the border, and one of the interior, with what it stands for.
struct BorderMotion {
  LocalMotion at;
  int bound = 0;
  double length_mm = 0.0;
};
struct InnerMotion {
  LocalMotion at;
  double fraction = 0.0;
  LinearMap covariance_mm2;  // of where the light of that part of the pupil lands, by the local derivative of the map
};

Vec2 across(Vec2 v) { return {-v.y, v.x}; }

// At the outline, only the motion along the normal counts: it follows whatever blocks the light there.
std::optional<GhostLine> border_line(const BorderMotion& border) {
  const LocalMotion& at = border.at;
  const LocalMotion::Bound bound = at.bound(border.bound);
  const double steepness = dot(bound.by_start, bound.by_start);
  const Vec2 edge = at.sensor_by_start(across(bound.by_start));
  if (!std::isnormal(steepness) || !(length(edge) > 0.0)) return std::nullopt;
  const Vec2 normal = across(edge) * (1.0 / length(edge));
  const double by_height = dot(normal, at.sensor_by_start(bound.by_start)) / steepness;
  return GhostLine{normal,
                   along(normal, at.sensor_by_angle) - bound.by_angle * by_height,
                   at.ray().sensor_mm,
                   at.density(),
                   true,
                   border.length_mm,
                   kZeroMap};
}

// A caustic lies along the image of the direction that the map from the pupil hardly stretches.
GhostLine inner_line(const InnerMotion& inner, const LinearMap& shift) {
  const LocalMotion& at = inner.at;
  const LinearMap squares = at.sensor_by_start * transposed(at.sensor_by_start);
  const double angle = 0.5 * std::atan2(2.0 * squares.x.y, squares.x.x - squares.y.y);
  const Vec2 normal{-std::sin(angle), std::cos(angle)};
  return {normal, along(normal, shift), at.ray().sensor_mm, at.density(), false, inner.fraction, inner.covariance_mm2};
}

// The motion of the whole pupil in the plane of the starts, fitted to its border by least squares.
LinearMap pupil_motion(const std::vector<BorderMotion>& borders) {
  LinearMap squares = kZeroMap, sums = kZeroMap;
  for (const BorderMotion& border : borders) {
    const LocalMotion::Bound bound = border.at.bound(border.bound);
    const double steepness = dot(bound.by_start, bound.by_start);
    if (!std::isnormal(steepness)) continue;
    const Vec2 m = bound.by_start;
    const double w = border.length_mm / steepness;
    squares = squares + LinearMap{m * (w * m.x), m * (w * m.y)};
    sums = sums + LinearMap{m * (-w * bound.by_angle.x), m * (-w * bound.by_angle.y)};
  }
  const double trace = trace_of(squares);
  if (!(squares.determinant() > 1e-3 * trace * trace)) return kZeroMap;
  return inverse(squares) * sums;
}

Vec2 area_rate(const PupilShape& pupil, const std::vector<BorderMotion>& borders) {
  Vec2 rate;
  double length_mm = 0.0;
  for (const BorderMotion& border : borders) {
    const LocalMotion::Bound bound = border.at.bound(border.bound);
    const double steepness = length(bound.by_start);
    length_mm += border.length_mm;
    if (std::isnormal(steepness)) rate = rate - bound.by_angle * (border.length_mm / steepness);
  }
  if (!(length_mm > 0.0) || !(pupil.area_mm2 > 0.0)) return {};
  return rate * (pupil.border_mm / length_mm / pupil.area_mm2);
}

// Sets the centre and the spread of where the light lands.
void set_extent(GhostMotion& motion, const std::vector<InnerMotion>& inside, double area_mm2) {
  double light = 0.0, all = 0.0;
  for (const InnerMotion& inner : inside) {
    const double weight = inner.fraction * inner.at.ray().transmission;
    motion.centroid_mm = motion.centroid_mm + inner.at.ray().sensor_mm * weight;
    light += weight;
    all += inner.fraction;
  }
  motion.centroid_mm = motion.centroid_mm * (1.0 / light);
  LinearMap covariance = kZeroMap;
  for (const InnerMotion& inner : inside) {
    const Vec2 d = inner.at.ray().sensor_mm - motion.centroid_mm;
    const double weight = inner.fraction * inner.at.ray().transmission / light;
    covariance = covariance + LinearMap{d * (d.x * weight), d * (d.y * weight)} + inner.covariance_mm2 * weight;
  }
  motion.spread_mm = square_root(covariance * 4.0);
  motion.flux_mm2 = light / all * area_mm2;
}

// The motion of the start of a ray for lights to the right and above, through the same point of what bounds the pupil:
// of each bound, by how much of the border it makes.
class StartMotion {
 public:
  StartMotion(const PupilShape& pupil, const std::vector<BorderMotion>& borders) : of_rims_(pupil_motion(borders)) {
    double all = 0.0;
    for (std::size_t k = 0; k < weights_.size(); ++k) {
      weights_[k] = std::pow(pupil.bound_fractions[k], kDominance);
      all += weights_[k];
    }
    if (all > 0.0)
      for (double& weight : weights_) weight /= all;
    else
      weights_[kRims] = 1.0;
  }

  [[nodiscard]] LinearMap of(const LocalMotion& at) const {
    LinearMap sum = of_rims_ * weights_[kRims];
    for (std::size_t c = 0; c < kMaxStopCrossings; ++c)
      if (weights_[c] > kLeastWeight) sum = sum + at.start_at_stop(c) * weights_[c];
    return sum;
  }

 private:
  static constexpr double kDominance = 4.0;  // the bound of most of the border counts nearly alone
  static constexpr double kLeastWeight = 1e-4;
  LinearMap of_rims_;
  std::array<double, kMaxStopCrossings + 1> weights_{};
};

// The motion at the pupil's middle, no larger than kStrange times that of the fastest piece of the border: beside a ray
// at which the map to the stop folds, the stop's coordinates hardly follow the ray, and the motion at a fixed point of
// the stop grows without limit.
LinearMap plausible(const LinearMap& shift, const std::vector<GhostLine>& lines) {
  double largest = 0.0;
  for (const GhostLine& line : lines)
    if (line.is_border) largest = std::max(largest, length(line.shift_mm));
  const double mean_row = std::sqrt(0.5 * (dot(shift.x, shift.x) + dot(shift.y, shift.y)));
  return largest > 0.0 && mean_row > kStrange * largest ? shift * (kStrange * largest / mean_row) : shift;
}

// Makes the fractions of all lines of a kind sum to 1.
void normalise_fractions(std::vector<GhostLine>& lines) {
  for (const bool is_border : {true, false}) {
    double sum = 0.0;
    for (const GhostLine& line : lines)
      if (line.is_border == is_border) sum += line.fraction;
    for (GhostLine& line : lines)
      if (line.is_border == is_border) line.fraction /= sum;
  }
}

// The motion of a ghost of which no ray was found to get through, by the ray that is blocked least.
GhostMotion blind_motion(const LocalMotion& at, const PupilShape& pupil, double cosine) {
  GhostMotion motion;
  motion.outside = pupil.outside;
  if (!at.is_usable()) return motion;
  motion.shift_mm = at.shift(at.start_at_stop(0));
  // Far from the stop, its coordinates may say nothing about the ray: the motion at a fixed point of the front is then
  // used.
  if (!(size(motion.shift_mm) <= kStrange * size(at.sensor_by_angle))) motion.shift_mm = at.sensor_by_angle;
  motion.centroid_mm = at.ray().sensor_mm;
  motion.spread_mm = at.sensor_by_start * std::sqrt(pupil.area_mm2);
  motion.flux_mm2 = at.ray().transmission * pupil.area_mm2 * cosine;
  return motion;
}

}  // namespace

GhostMotion ghost_motion(const LensSteps& steps, Ghost ghost, const LightSource& source, const LightWindows& windows) {
  const LightFrame light(source, has_axial_symmetry(steps.lens(), ghost));
  const EntranceWindow& window = windows.of(light.symmetric);
  const auto pupil = pupils::find_pupil_shape(steps, ghost, light, window);
  if (!pupil) return {};
  Rays rays(steps, ghost, source, window.z_mm);
  double step_mm = kRayStep * length(window.max_mm - window.min_mm);
  if (!pupil->is_open)
    return blind_motion(LocalMotion(rays.around({pupil->middle_mm}, step_mm).front(), step_mm), *pupil,
                        source.direction.z);
  step_mm = std::min(step_mm, kPupilStep * std::sqrt(trace_of(pupil->covariance)));

  std::vector<Vec2> starts_mm{pupil->middle_mm};
  for (const InnerPoint& point : pupil->inside) starts_mm.push_back(point.start_mm);
  for (const BorderPoint& point : pupil->border) starts_mm.push_back(point.start_mm);
  const std::vector<RayFive> fives = rays.around(starts_mm, step_mm);
  const LocalMotion middle(fives.front(), step_mm);
  std::vector<InnerMotion> inside;
  std::vector<BorderMotion> borders;
  for (std::size_t k = 1; k < fives.size(); ++k) {
    const LocalMotion at(fives[k], step_mm);
    if (!at.is_usable()) continue;
    const std::size_t border = k - 1 - pupil->inside.size();
    if (k <= pupil->inside.size())
      inside.push_back(
          {at, pupil->inside[k - 1].fraction, mapped_covariance(at.sensor_by_start, pupil->inside[k - 1].covariance)});
    else
      borders.push_back({at, pupil->border[border].bound, pupil->border[border].length_mm});
  }
  if (inside.empty()) return {};

  GhostMotion motion;
  motion.is_open = true;
  const StartMotion start(*pupil, borders);
  const LocalMotion& centre = middle.is_usable() ? middle : inside.front().at;
  motion.shift_mm = centre.shift(start.of(centre));
  set_extent(motion, inside, pupil->area_mm2);
  motion.flux_mm2 *= source.direction.z;
  motion.area_rate = area_rate(*pupil, borders);
  for (const BorderMotion& border : borders)
    if (const auto line = border_line(border)) motion.lines.push_back(*line);
  for (const InnerMotion& inner : inside) motion.lines.push_back(inner_line(inner, inner.at.shift(start.of(inner.at))));
  for (GhostLine& line : motion.lines) line.density *= source.direction.z;
  std::erase_if(motion.lines, [](const GhostLine& f) {
    return !std::isfinite(f.density + f.shift_mm.x + f.shift_mm.y + f.normal.x + f.normal.y);
  });
  normalise_fractions(motion.lines);
  motion.shift_mm = plausible(motion.shift_mm, motion.lines);
  if (!std::isfinite(motion.flux_mm2 + size(motion.shift_mm) + size(motion.spread_mm))) return {};
  return motion;
}

}  // namespace contrejour::inline internal::area
