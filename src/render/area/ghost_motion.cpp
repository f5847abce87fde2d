#include "render/area/ghost_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "contrejour/light.h"
#include "render/area/ghost_pupil.h"

namespace contrejour::area {
namespace {

constexpr double kRayStep = 1e-3;      // of the entrance window's width,
constexpr double kPupilStep = 0.1;     // or of the pupil's standard deviation, whichever is less
constexpr double kAngleStep = 1e-5;    // tangent
constexpr double kStrange = 2.0;       // as far as a ghost moves at a fixed place of the front
constexpr double kBlindRadius = 0.35;  // of the entrance window's diagonal: a pupil's that no ray was found in

double size(const LinearMap& map) { return length(map.x) + length(map.y); }

// Which place a ghost's border keeps as the light moves: one in the stop, or at the rim of a step of the path.
struct Edge {
  std::size_t crossing = 0;
  std::optional<std::size_t> rim;
};

struct EdgeRay {
  bool arrives = false;
  Vec2 sensor_mm, edge;
};

// Where rays go, only: most are asked for nothing else, and coatings take as long as the way.
OpticalPath without_coatings(OpticalPath path) {
  for (PathStep& step : path.steps) step.coating = {};
  return path;
}

// A ghost's rays by where they start in the plane of the entrance window.
class Rays {
 public:
  Rays(const OpticalPath& path, const LightSource& source, double z_mm)
      : coated_(path), path_(without_coatings(path)), source_(source), z_mm_(z_mm) {}

  [[nodiscard]] EdgeRay from(Vec2 start_mm, Vec2 tangents, const Edge& edge) const {
    if (!edge.rim) {
      const TracedRay ray = trace(path_, start(start_mm, tangents));
      return {ray.status == RayStatus::Ok, ray.sensor_mm, ray.stop[edge.crossing]};
    }
    const RayRecord record = trace_recorded(path_, start(start_mm, tangents));
    if (record.ray.status != RayStatus::Ok) return {};
    const Vec3& at = record.steps[*edge.rim].position_mm;
    return {true, record.ray.sensor_mm, {at.x, at.y}};
  }

  [[nodiscard]] double transmission(Vec2 start_mm) const { return trace(coated_, start(start_mm, {})).transmission; }

  // The step whose rim most of some rays are farthest beyond.
  [[nodiscard]] std::optional<std::size_t> blocking_rim(const std::vector<Vec2>& starts_mm) const {
    std::map<std::size_t, int> votes;
    for (const Vec2 start_mm : starts_mm) {
      const RayRecord record = trace_recorded(path_, start(start_mm, {}));
      std::size_t worst = 0;
      double farthest = 0.0;
      for (std::size_t k = 0; k < record.steps.size(); ++k) {
        if (path_.steps[k].event == PathEvent::Stop) continue;
        const Vec3& at = record.steps[k].position_mm;
        const double out = length(path_.steps[k].rim_place({at.x, at.y}));
        if (!(out > farthest)) continue;
        farthest = out;
        worst = k;
      }
      if (farthest > 1.0) ++votes[worst];
    }
    const auto most = std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
    return most == votes.end() ? std::nullopt : std::optional(most->first);
  }

 private:
  [[nodiscard]] Ray start(Vec2 start_mm, Vec2 tangents) const {
    const LightSource light = tangents == Vec2{} ? source_ : source_beside(source_, tangents);
    const Vec3 from{start_mm.x, start_mm.y, z_mm_};
    return {from, light.direction_at(from)};
  }

  const OpticalPath& coated_;
  OpticalPath path_;
  LightSource source_;
  double z_mm_;
};

// First derivatives at a ray, of the sensor's place and the edge's.
struct LocalMotion {
  Vec2 start_mm;
  EdgeRay ray;
  LinearMap sensor_by_start, sensor_by_angle, edge_by_start;
  LinearMap shift;  // of the sensor's place by the light's direction at a fixed place of the edge

  [[nodiscard]] double spread() const { return std::abs(sensor_by_start.determinant()); }
};

// None where rays fail, or where places at the edge say nothing of the start.
std::optional<LocalMotion> local_motion(const Rays& rays, Vec2 start, double step_mm, const Edge& edge) {
  const EdgeRay here = rays.from(start, {}, edge);
  const std::array beside{rays.from(start + Vec2{step_mm, 0.0}, {}, edge),
                          rays.from(start + Vec2{0.0, step_mm}, {}, edge), rays.from(start, {kAngleStep, 0.0}, edge),
                          rays.from(start, {0.0, kAngleStep}, edge)};
  if (!here.arrives || !std::ranges::all_of(beside, &EdgeRay::arrives)) return std::nullopt;
  const double s = 1.0 / step_mm, t = 1.0 / kAngleStep;
  const auto derivative = [&](Vec2 EdgeRay::* place, std::size_t first, double per) {
    return LinearMap{(beside[first].*place - here.*place) * per, (beside[first + 1].*place - here.*place) * per};
  };
  LocalMotion motion;
  motion.start_mm = start;
  motion.ray = here;
  motion.sensor_by_start = derivative(&EdgeRay::sensor_mm, 0, s);
  motion.sensor_by_angle = derivative(&EdgeRay::sensor_mm, 2, t);
  motion.edge_by_start = derivative(&EdgeRay::edge, 0, s);
  if (!std::isnormal(motion.edge_by_start.determinant()) || !std::isnormal(motion.spread())) return std::nullopt;
  // dp = p_a da + p_d dd with e_a da + e_d dd = 0.
  motion.shift = motion.sensor_by_angle -
                 motion.sensor_by_start * inverse(motion.edge_by_start) * derivative(&EdgeRay::edge, 2, t);
  if (!std::isfinite(size(motion.shift))) return std::nullopt;
  return motion;
}

// The one that differs least from all, each counted by its brightness: a mean would follow those few near a fold.
LinearMap median_shift(const std::vector<LocalMotion>& all) {
  LinearMap best = all.front().shift;
  double least = std::numeric_limits<double>::infinity();
  for (const LocalMotion& one : all) {
    double off = 0.0;
    for (const LocalMotion& other : all) {
      const LinearMap apart = one.shift - other.shift;
      off += std::sqrt(dot(apart.x, apart.x) + dot(apart.y, apart.y)) / other.spread();
    }
    if (!(off < least)) continue;
    least = off;
    best = one.shift;
  }
  return best;
}

}  // namespace

GhostMotion ghost_motion(const LensState& lens, Ghost ghost, const LightSource& source, const LightWindows& windows,
                         const ReflectanceTables& tables) {
  const OpticalPath path = ghost_path(lens, ghost, tables.lambda_nm());
  const LightFrame light(source, has_axial_symmetry(lens, ghost));
  const EntranceWindow& window = windows.of(light.symmetric);
  const auto pupil = find_ghost_pupil(path, tables, light, window);
  if (!pupil) return {};
  const Rays rays(path, source, window.z_mm);
  Edge edge;
  if (pupil->bound == kRims)
    edge.rim = rays.blocking_rim(pupil->beyond_rims_mm);
  else
    edge.crossing = static_cast<std::size_t>(pupil->bound);
  const double width = length(window.max_mm - window.min_mm);
  const double step_mm = pupil->is_open
                             ? std::min(kRayStep * width, kPupilStep * std::sqrt(trace_of(pupil->covariance)))
                             : kRayStep * width;
  auto middle = local_motion(rays, pupil->at_mm, step_mm, edge);
  if (!middle) return {};
  if (pupil->is_whole()) {
    // To the middle of the stop itself, by Newton's step.
    const Vec2 start = pupil->at_mm - inverse(middle->edge_by_start)(middle->ray.edge);
    if (const auto nearer = local_motion(rays, start, step_mm, edge)) middle = nearer;
  }
  std::vector<LocalMotion> all{*middle};
  for (const Vec2 start : pupil->border_mm)
    if (const auto there = local_motion(rays, start, step_mm, edge)) all.push_back(*there);

  GhostMotion motion;
  motion.shift_mm = median_shift(all);
  // Of what was not seen to get through, places in the stop may say nothing: then those at the front do.
  if (!pupil->is_open && size(motion.shift_mm) > kStrange * size(middle->sensor_by_angle))
    motion.shift_mm = middle->sensor_by_angle;
  motion.at_mm = middle->ray.sensor_mm;
  motion.spread_mm = middle->sensor_by_start *
                     (pupil->is_open ? square_root(pupil->covariance * 4.0) : LinearMap{} * (kBlindRadius * width));
  motion.density = rays.transmission(middle->start_mm) * source.direction.z / middle->spread();
  if (!std::isfinite(motion.density)) return {};
  return motion;
}

}  // namespace contrejour::area
