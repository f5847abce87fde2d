#include "render/area/ghost_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "contrejour/light.h"
#include "render/area/ghost_pupil.h"

namespace contrejour::area {
namespace {

constexpr double kRayStep = 1e-3;      // of the entrance window's width,
constexpr double kPupilStep = 0.1;     // or of the pupil's standard deviation, whichever is less
constexpr double kAngleStep = 1e-4;    // tangent: 0.01 mm on many sensors, of which floats tell a thousandth
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

// A ghost's rays by where they start in the plane of the entrance window.
class Rays {
 public:
  Rays(const LensSteps& steps, Ghost ghost, const LightSource& source, double z_mm)
      : steps_(steps), ghost_(ghost), path_(ghost_path(steps.lens(), ghost, steps.tables().lambda_nm())),
        source_(source), z_mm_(z_mm) {}

  // Of the light so far beside its place.
  [[nodiscard]] std::vector<EdgeRay> from(const std::vector<Vec2>& starts_mm, Vec2 tangents, const Edge& edge) const {
    const LightSource light = tangents == Vec2{} ? source_ : source_beside(source_, tangents);
    return edge.rim ? past_rim(starts_mm, light, *edge.rim) : through_stop(starts_mm, light, edge.crossing);
  }

  [[nodiscard]] double transmission(Vec2 start_mm) const { return trace(path_, start(start_mm, source_)).transmission; }

  // The step whose rim most of some rays are farthest beyond.
  [[nodiscard]] std::optional<std::size_t> blocking_rim(const std::vector<Vec2>& starts_mm) const {
    std::map<std::size_t, int> votes;
    for (const Vec2 start_mm : starts_mm) {
      const RayRecord record = trace_recorded(path_, start(start_mm, source_));
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
  [[nodiscard]] Ray start(Vec2 start_mm, const LightSource& light) const {
    const Vec3 from{start_mm.x, start_mm.y, z_mm_};
    return {from, light.direction_at(from)};
  }

  [[nodiscard]] std::vector<EdgeRay> past_rim(const std::vector<Vec2>& starts_mm, const LightSource& light,
                                              std::size_t rim) const {
    std::vector<EdgeRay> rays;
    for (const Vec2 start_mm : starts_mm) {
      const RayRecord record = trace_recorded(path_, start(start_mm, light));
      if (record.ray.status != RayStatus::Ok) {
        rays.emplace_back();
        continue;
      }
      const Vec3& at = record.steps[rim].position_mm;
      rays.push_back({true, record.ray.sensor_mm, {at.x, at.y}});
    }
    return rays;
  }

  [[nodiscard]] std::vector<EdgeRay> through_stop(const std::vector<Vec2>& starts_mm, const LightSource& light,
                                                  std::size_t crossing) const {
    const Vec2 origin_mm = starts_mm.front();
    const PacketPath path(steps_, ghost_, {{origin_mm.x, origin_mm.y, z_mm_}, light});
    const std::size_t count = starts_mm.size();
    std::vector<float> room((6 + 2 * kMaxStopCrossings) * count);
    const auto field = [&](std::size_t k) { return room.data() + k * count; };
    float *const x_mm = field(0), *const y_mm = field(1);
    for (std::size_t k = 0; k < count; ++k) {
      x_mm[k] = static_cast<float>(starts_mm[k].x - origin_mm.x);
      y_mm[k] = static_cast<float>(starts_mm[k].y - origin_mm.y);
    }
    TracedArrays out{.sensor_x_mm = field(2), .sensor_y_mm = field(3), .transmission = field(4), .r_rel = field(5)};
    for (std::size_t c = 0; c < kMaxStopCrossings; ++c) {
      out.stop_x[c] = field(6 + 2 * c);
      out.stop_y[c] = field(7 + 2 * c);
    }
    trace_packets(path, PacketPrecision::Double, x_mm, y_mm, count, out);
    std::vector<EdgeRay> rays;
    for (std::size_t k = 0; k < count; ++k)
      rays.push_back({std::isfinite(out.r_rel[k]),
                      {out.sensor_x_mm[k], out.sensor_y_mm[k]},
                      {out.stop_x[crossing][k], out.stop_y[crossing][k]}});
    return rays;
  }

  const LensSteps& steps_;
  Ghost ghost_;
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
std::optional<LocalMotion> local_motion(Vec2 start_mm, double step_mm, const std::array<EdgeRay, 5>& rays) {
  const EdgeRay& here = rays[0];
  if (!std::ranges::all_of(rays, &EdgeRay::arrives)) return std::nullopt;
  const auto derivative = [&](Vec2 EdgeRay::* place, std::size_t first, double step) {
    return LinearMap{(rays[first].*place - here.*place) * (1.0 / step),
                     (rays[first + 1].*place - here.*place) * (1.0 / step)};
  };
  LocalMotion motion;
  motion.start_mm = start_mm;
  motion.ray = here;
  motion.sensor_by_start = derivative(&EdgeRay::sensor_mm, 1, step_mm);
  motion.sensor_by_angle = derivative(&EdgeRay::sensor_mm, 3, kAngleStep);
  motion.edge_by_start = derivative(&EdgeRay::edge, 1, step_mm);
  if (!std::isnormal(motion.edge_by_start.determinant()) || !std::isnormal(motion.spread())) return std::nullopt;
  // dp = p_a da + p_d dd with e_a da + e_d dd = 0.
  motion.shift = motion.sensor_by_angle -
                 motion.sensor_by_start * inverse(motion.edge_by_start) * derivative(&EdgeRay::edge, 3, kAngleStep);
  if (!std::isfinite(size(motion.shift))) return std::nullopt;
  return motion;
}

// At those of some starts that have one.
std::vector<LocalMotion> local_motions(const Rays& rays, const std::vector<Vec2>& starts_mm, double step_mm,
                                       const Edge& edge) {
  if (starts_mm.empty()) return {};
  std::vector<Vec2> around;
  for (const Vec2 start_mm : starts_mm)
    for (const Vec2 aside : {Vec2{}, Vec2{step_mm, 0.0}, Vec2{0.0, step_mm}}) around.push_back(start_mm + aside);
  const std::vector<EdgeRay> near = rays.from(around, {}, edge), right = rays.from(starts_mm, {kAngleStep, 0.0}, edge),
                             up = rays.from(starts_mm, {0.0, kAngleStep}, edge);
  std::vector<LocalMotion> motions;
  for (std::size_t k = 0; k < starts_mm.size(); ++k)
    if (const auto motion =
            local_motion(starts_mm[k], step_mm, {near[3 * k], near[3 * k + 1], near[3 * k + 2], right[k], up[k]}))
      motions.push_back(*motion);
  return motions;
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

GhostMotion ghost_motion(const LensSteps& steps, Ghost ghost, const LightSource& source, const LightWindows& windows) {
  const LightFrame light(source, has_axial_symmetry(steps.lens(), ghost));
  const EntranceWindow& window = windows.of(light.symmetric);
  const auto pupil = find_ghost_pupil(steps, ghost, light, window);
  if (!pupil) return {};
  const Rays rays(steps, ghost, source, window.z_mm);
  Edge edge;
  if (pupil->bound == kRims)
    edge.rim = rays.blocking_rim(pupil->beyond_rims_mm);
  else
    edge.crossing = static_cast<std::size_t>(pupil->bound);
  const double width = length(window.max_mm - window.min_mm);
  const double step_mm = pupil->is_open
                             ? std::min(kRayStep * width, kPupilStep * std::sqrt(trace_of(pupil->covariance)))
                             : kRayStep * width;
  std::vector<LocalMotion> all = local_motions(rays, {pupil->at_mm}, step_mm, edge);
  if (all.empty()) return {};
  if (pupil->is_whole()) {
    // To the middle of the stop itself, by Newton's step.
    const LocalMotion& near = all.front();
    const Vec2 start_mm = pupil->at_mm - inverse(near.edge_by_start)(near.ray.edge);
    if (auto nearer = local_motions(rays, {start_mm}, step_mm, edge); !nearer.empty()) all = std::move(nearer);
  }
  const LocalMotion middle = all.front();
  const std::vector<LocalMotion> others = local_motions(rays, pupil->border_mm, step_mm, edge);
  all.insert(all.end(), others.begin(), others.end());

  GhostMotion motion;
  motion.shift_mm = median_shift(all);
  // Of what was not seen to get through, places in the stop may say nothing: then those at the front do.
  if (!pupil->is_open && size(motion.shift_mm) > kStrange * size(middle.sensor_by_angle))
    motion.shift_mm = middle.sensor_by_angle;
  motion.at_mm = middle.ray.sensor_mm;
  motion.spread_mm = middle.sensor_by_start *
                     (pupil->is_open ? square_root(pupil->covariance * 4.0) : LinearMap{} * (kBlindRadius * width));
  motion.density = rays.transmission(middle.start_mm) * source.direction.z / middle.spread();
  if (!std::isfinite(motion.density)) return {};
  return motion;
}

}  // namespace contrejour::area
