// SPDX-License-Identifier: Apache-2.0
// Traces the thesis's system, with spheres or as its own code does. Nothing of the library's tracer is used: the faults
// would not fit in, and the tests compare both.
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "contrejour/expert/published_samples.h"
#include "polynomial/published/seeded_random.h"

namespace contrejour::published {
namespace {

constexpr double kRadius = 3.0, kStopRadius = 1.0, kLight_z = -6.0, kHalfWidth = 0.5, kLambda_um = 0.5;
constexpr int kStop = 2, kElements = 5, kBlades = 6;
constexpr std::array<double, kElements> kElement_z{-5.0, -3.5, -2.0, -2.0, -0.5};

constexpr bool is_entry(int element) { return element == 0 || element == 3; }

// Sellmeier's formula with Schott's coefficients of N-BK7.
double index_of_bk7() {
  constexpr double kB[] = {1.03961212, 0.231792344, 1.01046945}, kC[] = {6.00069867e-3, 2.00179144e-2, 103.560653};
  const double square = kLambda_um * kLambda_um;
  double n_squared = 1.0;
  for (int k = 0; k < 3; ++k) n_squared += kB[k] * square / (square - kC[k]);
  return std::sqrt(n_squared);
}

// A point and a direction as three numbers each.
struct ScenePath {
  Vec3 at, direction;
};

// Distances to both intersections with a sphere or a circle: -b -+ sqrt(b^2 - c). NaN where there is none.
double distance(double b, double c, bool first) {
  const double root = std::sqrt(b * b - c);
  return first ? -b - root : -b + root;
}

// The unit normal against the ray; false where the ray misses.
bool meet_sphere(ScenePath& ray, double centre_z, bool first, Vec3& normal) {
  const Vec3 from = ray.at - Vec3{0.0, 0.0, centre_z};
  const double far = distance(dot(ray.direction, from), dot(from, from) - kRadius * kRadius, first);
  if (!std::isfinite(far)) return false;
  ray.at = ray.at + ray.direction * far;
  normal = normalized(ray.at - Vec3{0.0, 0.0, centre_z});
  return true;
}

// As published: a distance in the y-z plane, taken along the ray in space, and a normal from the point scaled to a
// distance of 1 from the origin.
bool meet_published_cylinder(ScenePath& ray, double centre_z, bool first, Vec3& normal) {
  const double length_yz = std::hypot(ray.direction.y, ray.direction.z);
  const double dy = ray.direction.y / length_yz, dz = ray.direction.z / length_yz;
  const double y = ray.at.y, z = ray.at.z - centre_z;
  const double far = distance(dy * y + dz * z, y * y + z * z - kRadius * kRadius, first);
  if (!std::isfinite(far)) return false;
  ray.at = ray.at + ray.direction * far;
  const double scale = 1.0 / std::hypot(ray.at.y, ray.at.z);
  normal = normalized(Vec3{0.0, ray.at.y * scale, ray.at.z * scale - centre_z});
  return true;
}

class SystemTracer {
 public:
  SystemTracer(const TwoLenses& system, const Inputs& at) : system_(system), index_(index_of_bk7()) {
    const Vec3 light{kHalfWidth * at[0], kHalfWidth * at[1], kLight_z};
    ray_ = {light, normalized({kHalfWidth * at[2], kHalfWidth * at[3], kElement_z[0] - kLight_z})};
  }

  bool meet(int element, bool reflects) {
    if (element == kStop) return pass_stop();
    const bool entry = is_entry(element), forward = ray_.direction.z > 0.0;
    const double centre_z = kElement_z[static_cast<std::size_t>(element)] + (entry ? kRadius : -kRadius);
    const bool first = entry == forward;
    Vec3 normal;
    const bool cylinder = !entry && system_.tracer == TwoLenses::Tracer::AsPublished;
    if (cylinder ? !meet_published_cylinder(ray_, centre_z, first, normal)
                 : !meet_sphere(ray_, centre_z, first, normal))
      return false;
    if (!first) normal = normal * -1.0;
    if (reflects) {
      ray_.direction = ray_.direction - normal * (2.0 * dot(normal, ray_.direction));
      return true;
    }
    // Differs for backward refraction: the published code never exchanges the indices. No pair of one lens needs it.
    const double ratio = entry == forward ? 1.0 / index_ : index_;
    return refract(normal, ratio);
  }

  [[nodiscard]] std::optional<TwoLensesRay> finish() const {
    const double far = (system_.sensor_z - ray_.at.z) / ray_.direction.z;
    const Vec3 at = ray_.at + ray_.direction * far;
    if (!std::isfinite(at.x + at.y)) return std::nullopt;
    return TwoLensesRay{true, {at.x, at.y}, stop_};
  }

 private:
  bool refract(Vec3 normal, double ratio) {
    const double along = dot(normal, ray_.direction);
    const double square = 1.0 - ratio * ratio * (1.0 - along * along);
    if (square < 0.0) return false;
    ray_.direction = ray_.direction * ratio - normal * (ratio * along + std::sqrt(square));
    return true;
  }

  bool pass_stop() {
    ray_.at = ray_.at + ray_.direction * ((kElement_z[kStop] - ray_.at.z) / ray_.direction.z);
    stop_ = {ray_.at.x / kStopRadius, ray_.at.y / kStopRadius};
    return !system_.stop || inside_hexagon(stop_);
  }

  [[nodiscard]] static bool inside_hexagon(Vec2 at) {
    for (int k = 0; k < kBlades; ++k) {
      const double angle_rad = 2.0 * std::numbers::pi * k / kBlades;
      if (at.x * std::cos(angle_rad) + at.y * std::sin(angle_rad) > 1.0) return false;
    }
    return true;
  }

  const TwoLenses& system_;
  double index_;
  ScenePath ray_;
  Vec2 stop_;
};

Samples samples_of(const RaySamples& rays, double Vec2::* axis) {
  Samples samples{rays.inputs, {}};
  for (const Vec2& sensor : rays.sensor) samples.values.push_back(sensor.*axis);
  return samples;
}

}  // namespace

Samples RaySamples::x() const { return samples_of(*this, &Vec2::x); }
Samples RaySamples::y() const { return samples_of(*this, &Vec2::y); }

TwoLensesRay trace(const TwoLenses& system, ElementPair ghost, const Inputs& at) {
  const auto [i, j] = ghost;
  if (i < 0 || i >= j || j >= kElements || i == kStop || j == kStop) return {};
  SystemTracer ray(system, at);
  for (int k = 0; k < j; ++k)
    if (!ray.meet(k, false)) return {};
  for (int k = j; k >= i; --k)
    if (!ray.meet(k, k == i || k == j)) return {};
  for (int k = i + 1; k < kElements; ++k)
    if (!ray.meet(k, false)) return {};
  return ray.finish().value_or(TwoLensesRay{});
}

RaySamples grid_samples(const TwoLenses& system, ElementPair ghost, int side) {
  RaySamples samples;
  Inputs at;
  const auto coordinate = [side](int k) { return 2.0 * k / side - 1.0; };
  for (int cell = 0; cell < side * side * side * side; ++cell) {
    int rest = cell;
    for (std::size_t axis = at.size(); axis-- > 0; rest /= side) at[axis] = coordinate(rest % side);
    const TwoLensesRay ray = trace(system, ghost, at);
    if (!ray.arrives) continue;
    samples.inputs.push_back(at);
    samples.sensor.push_back(ray.sensor);
  }
  return samples;
}

RaySamples random_samples(const TwoLenses& system, ElementPair ghost, int count, std::uint64_t seed) {
  polynomial::SeededRandom random(seed);
  RaySamples samples;
  for (int tried = 0; tried < 100 * count && static_cast<int>(samples.inputs.size()) < count; ++tried) {
    Inputs at;
    for (double& x : at) x = 2.0 * random.unit() - 1.0;
    const TwoLensesRay ray = trace(system, ghost, at);
    if (!ray.arrives) continue;
    samples.inputs.push_back(at);
    samples.sensor.push_back(ray.sensor);
  }
  return samples;
}

}  // namespace contrejour::published
