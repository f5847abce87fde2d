#include "render/area/ghost_motion.h"

#include <cmath>
#include <optional>

#include "contrejour/light.h"

namespace contrejour::area {
namespace {

constexpr int kNewtonSteps = 4;
constexpr double kCloseToMiddle = 0.02;  // stop radii
constexpr int kGridSide = 9;
constexpr double kNearlyThrough = 0.1;  // outside what stops it, over that one's radius
constexpr double kRayStep = 1e-3;    // of the entrance window's width
constexpr double kStrange = 2.0;  // as far as a ghost moves at a fixed place of the front
constexpr double kAngleStep = 1e-5;  // tangent

// A ghost's rays by where they start in the plane of the entrance window.
class Rays {
 public:
  Rays(const LensState& lens, Ghost ghost, const LightSource& source, double lambda_nm)
      : lens_(lens), path_(ghost_path(lens, ghost, lambda_nm)), source_(source), window_(entrance_window(lens, source)) {}

  [[nodiscard]] std::optional<TracedRay> from(Vec2 start_mm, Vec2 tangents = {}) const {
    const LightSource source = tangents == Vec2{} ? source_ : source_beside(source_, tangents);
    const Vec3 start{start_mm.x, start_mm.y, window_.z_mm};
    const TracedRay ray = trace(path_, {start, source.direction_at(start)});
    if (ray.status != RayStatus::Ok) return std::nullopt;
    return ray;
  }
  [[nodiscard]] double blocked(const TracedRay& ray) const { return blocked_by(ray, path_, lens_.iris); }
  [[nodiscard]] Vec2 at(double u, double v) const {
    const Vec2 size = window_.max_mm - window_.min_mm;
    return {window_.min_mm.x + u * size.x, window_.min_mm.y + v * size.y};
  }
  [[nodiscard]] double step_mm() const { return kRayStep * length(window_.max_mm - window_.min_mm); }
  [[nodiscard]] double radius_mm() const { return 0.35 * length(window_.max_mm - window_.min_mm); }
  [[nodiscard]] double cosine() const { return source_.direction.z; }

 private:
  const LensState& lens_;
  OpticalPath path_;
  LightSource source_;
  EntranceWindow window_;
};

// Of sensor and stop by where a ray starts.
struct StartDerivatives {
  LinearMap sensor, stop;
};

std::optional<StartDerivatives> by_start(const Rays& rays, Vec2 start, const TracedRay& ray) {
  const double h = rays.step_mm();
  const auto x = rays.from(start + Vec2{h, 0.0}), y = rays.from(start + Vec2{0.0, h});
  if (!x || !y) return std::nullopt;
  const double s = 1.0 / h;
  return StartDerivatives{{(x->sensor_mm - ray.sensor_mm) * s, (y->sensor_mm - ray.sensor_mm) * s},
                          {(x->stop[0] - ray.stop[0]) * s, (y->stop[0] - ray.stop[0]) * s}};
}

double size(const LinearMap& map) { return length(map.x) + length(map.y); }

bool is_usable(const LinearMap& map) { return std::isnormal(map.determinant()); }

// Newton's steps to the middle of the stop.
std::optional<Vec2> start_through_middle(const Rays& rays) {
  Vec2 start = rays.at(0.5, 0.5);
  for (int k = 0; k < kNewtonSteps; ++k) {
    const auto ray = rays.from(start);
    if (!ray) return std::nullopt;
    if (length(ray->stop[0]) < kCloseToMiddle)
      return rays.blocked(*ray) <= 0.0 ? std::optional<Vec2>(start) : std::nullopt;
    const auto derivatives = by_start(rays, start, *ray);
    if (!derivatives || !is_usable(derivatives->stop)) return std::nullopt;
    start = start - inverse(derivatives->stop)(ray->stop[0]);
  }
  return std::nullopt;
}

std::optional<Vec2> least_blocked_start(const Rays& rays) {
  std::optional<Vec2> best;
  double least = kNearlyThrough;
  for (int k = 0; k < kGridSide * kGridSide; ++k) {
    const Vec2 start = rays.at((k % kGridSide + 0.5) / kGridSide, (k / kGridSide + 0.5) / kGridSide);
    const auto ray = rays.from(start);
    if (!ray) continue;
    const double blocked = rays.blocked(*ray);
    if (!(blocked < least)) continue;
    least = blocked;
    best = start;
  }
  return best;
}

}  // namespace

GhostMotion ghost_motion(const LensState& lens, Ghost ghost, const LightSource& source, double lambda_nm) {
  const Rays rays(lens, ghost, source, lambda_nm);
  auto start = start_through_middle(rays);
  const bool through_middle = start.has_value();
  if (!start) start = least_blocked_start(rays);
  const auto ray = start ? rays.from(*start) : std::nullopt;
  const auto derivatives = ray ? by_start(rays, *start, *ray) : std::nullopt;
  const auto right = ray ? rays.from(*start, {kAngleStep, 0.0}) : std::nullopt;
  const auto up = ray ? rays.from(*start, {0.0, kAngleStep}) : std::nullopt;
  GhostMotion motion;
  if (!derivatives || !right || !up || !is_usable(derivatives->stop)) return motion;

  // dp = p_a da + p_d dd with s_a da + s_d dd = 0.
  const double s = 1.0 / kAngleStep;
  const LinearMap sensor_by_angle{(right->sensor_mm - ray->sensor_mm) * s, (up->sensor_mm - ray->sensor_mm) * s};
  const LinearMap stop_by_angle{(right->stop[0] - ray->stop[0]) * s, (up->stop[0] - ray->stop[0]) * s};
  motion.at_mm = ray->sensor_mm;
  motion.spread_mm = derivatives->sensor * inverse(derivatives->stop);
  motion.shift_mm = sensor_by_angle - motion.spread_mm * stop_by_angle;
  // Where the stop is not what bounds a ghost, its places may say nothing of the ghost's: then the front's do.
  if (!through_middle && size(motion.shift_mm) > kStrange * size(sensor_by_angle)) {
    motion.shift_mm = sensor_by_angle;
    motion.spread_mm = derivatives->sensor * rays.radius_mm();
  }
  const double spread = std::abs(derivatives->sensor.determinant());
  motion.density = spread > 0.0 ? ray->transmission * rays.cosine() / spread : 0.0;
  const LinearMap& m = motion.shift_mm;
  if (!std::isfinite(m.x.x + m.x.y + m.y.x + m.y.y) || !std::isfinite(motion.density)) return {};
  return motion;
}

}  // namespace contrejour::area
