// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal {
namespace {

// From the denser side angles beyond the critical one have no u; from the other side every u is an angle.
double cos_in_denser(double u, double n_low, double n_high) {
  const double eta = n_low / n_high;
  return std::sqrt(1.0 - eta * eta * (1.0 - u * u));
}

// Every kSpacing-th value of the table is computed; a cubic through four of them gives the others, to 2e-6.
constexpr std::size_t kSpacing = 16;

// The weights of four nodes for the values in the first, second or third interval between them.
using CubicWeights = std::array<std::array<std::array<double, 4>, kSpacing>, 3>;

// Lagrange's cubics.
constexpr CubicWeights cubic_weights() {
  CubicWeights weights{};
  for (std::size_t from = 0; from < weights.size(); ++from) {
    for (std::size_t k = 0; k < kSpacing; ++k) {
      const double t = static_cast<double>(from) + static_cast<double>(k) / kSpacing;
      weights[from][k] = {(t - 1) * (t - 2) * (t - 3) / -6.0, t * (t - 2) * (t - 3) / 2.0, t * (t - 1) * (t - 3) / -2.0,
                          t * (t - 1) * (t - 2) / 6.0};
    }
  }
  return weights;
}
constexpr CubicWeights kCubic = cubic_weights();

}  // namespace

ReflectanceTables::ReflectanceTables(const LensState& lens, double lambda_nm) : lambda_nm_(lambda_nm) {
  for (const SurfaceState& surface : lens.surfaces) {
    entries_.push_back(surface.kind == SurfaceKind::Stop ? Entry{} : entry_of(surface, lens));
    if (none_ >= 0 || (surface.aperture.kind == ApertureKind::Disc && !surface.obscuration.any())) continue;
    none_ = static_cast<int>(values_.size());
    values_.insert(values_.end(), kIntervals + 1, 0.0F);
  }
}

// Reuses the entry of an earlier surface with the same reflectance, or makes one.
ReflectanceTables::Entry ReflectanceTables::entry_of(const SurfaceState& surface, const LensState& lens) {
  const bool absorbs = may_absorb(surface.coating);
  const bool same_both_directions = !absorbs && !std::holds_alternative<HullinFresnelAR>(surface.coating.films);
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    const SurfaceState& other = lens.surfaces[k];
    if (other.kind == SurfaceKind::Stop || !(other.coating == surface.coating)) continue;
    if ((other.before == surface.before && other.after == surface.after) ||
        (same_both_directions && other.before == surface.after && other.after == surface.before))
      return entries_[k];
  }
  Entry entry;
  entry.reflectance[0] = add(surface, +1, false);
  entry.reflectance[1] = same_both_directions ? entry.reflectance[0] : add(surface, -1, false);
  if (absorbs) entry.transmittance = add(surface, +1, true);
  return entry;
}

int ReflectanceTables::add(const SurfaceState& surface, int direction, bool transmitted) {
  const int offset = static_cast<int>(values_.size());
  const double before = refractive_index(surface.before, lambda_nm_);
  const double after = refractive_index(surface.after, lambda_nm_);
  const double n_in = direction > 0 ? before : after;
  const double n_out = direction > 0 ? after : before;
  const Coating coating = at_wavelength(surface.coating, lambda_nm_);
  const auto exact = [&](int k) {
    // At grazing incidence the film matrix gives 0/0; a value close to it gives the limit.
    const double u = std::max(static_cast<double>(k) / kIntervals, 1e-9);
    const double cos_in = n_in > n_out ? cos_in_denser(u, n_out, n_in) : u;
    return transmitted ? transmittance(coating, n_in, n_out, cos_in, lambda_nm_)
                       : reflectance(coating, n_in, n_out, cos_in, lambda_nm_);
  };
  constexpr std::size_t kNodes = kIntervals / kSpacing + 1;
  static_assert(kIntervals % kSpacing == 0 && kNodes >= 4);
  std::array<double, kNodes> nodes{};
  for (std::size_t k = 0; k < kNodes; ++k) nodes[k] = exact(static_cast<int>(k * kSpacing));
  values_.resize(values_.size() + kIntervals + 1);
  float* to = values_.data() + offset;
  for (std::size_t k = 0; k + 1 < kNodes; ++k) {
    const std::size_t first = std::clamp<std::size_t>(k, 1, kNodes - 3) - 1;
    for (const auto& w : kCubic[k - first])
      *to++ = static_cast<float>(nodes[first] * w[0] + nodes[first + 1] * w[1] + nodes[first + 2] * w[2] +
                                 nodes[first + 3] * w[3]);
  }
  *to = static_cast<float>(nodes.back());
  return offset;
}

PacketPath::PacketPath(const OpticalPath& path, const ReflectanceTables& tables, const LightRays& rays)
    : tables_(tables.values()), source_(rays.source),
      geometry_(path.centred ? PathGeometry::Spheres : PathGeometry::General),
      inverse_stop_radius_per_mm_(1.0 / path.stop_radius_mm) {
  start_.origin_mm = rays.origin_mm;
  start_from({rays.origin_mm.x, rays.origin_mm.y});
  Vec3 before_mm{0.0, 0.0, rays.origin_mm.z};
  steps_.reserve(path.steps.size());
  for (const PathStep& from : path.steps) {
    const ReflectanceTables::Entry& entry = tables.of(from.surface);
    PacketStep& step = steps_.emplace_back();  // constructed in place, which saves a copy of every field
    step.event = from.event;
    if (from.event == PathEvent::Stop) step.crossing = stop_crossings_++;
    step.from_denser = from.n_in > from.n_out;
    step.reflectance = from.is_rim_only ? tables.none() : entry.reflectance[from.direction > 0 ? 0 : 1];
    step.transmittance = from.is_rim_only ? -1 : entry.transmittance;
    step.direction = from.direction;
    const Vec3 vertex_mm = Vec3{0.0, 0.0, from.z_mm} + from.pose.shift_mm;
    step.gap_mm = vertex_mm.z - before_mm.z;
    step.offset_mm = {vertex_mm.x - before_mm.x, vertex_mm.y - before_mm.y};
    step.axis = from.pose.axis;
    step.curvature_per_mm = from.curvature_per_mm;
    if (from.shape) {
      step.shape = from.shape.get();
      shapes_.push_back(from.shape);
      if (geometry_ == PathGeometry::Spheres) geometry_ = PathGeometry::Shapes;
    }
    const double per_mm = 1.0 / from.semi_diameter_mm;
    step.inverse_semi_diameter_per_mm = per_mm;
    step.inverse_semi_diameter_squared = per_mm * per_mm;
    step.eta = from.n_in / from.n_out;
    step.rim = from.rim.value_or(Rim{{}, {per_mm, 0.0}, {0.0, per_mm}});
    step.blocks_within = from.blocks_within;
    step.absorption_per_mm = from.absorption_per_mm;
    step.grating_shift = from.grating_shift;
    step.efficiency = from.efficiency;
    if (from.rim || from.absorption_per_mm != 0.0 || from.efficiency != 1.0) geometry_ = PathGeometry::General;
    before_mm = vertex_mm;
  }
  sensor_gap_mm_ = path.sensor_z_mm - before_mm.z;
  sensor_offset_mm_ = {-before_mm.x, -before_mm.y};
}

void PacketPath::start_from(Vec2 origin_mm) {
  const Vec3 origin{origin_mm.x, origin_mm.y, start_.origin_mm.z};
  start_ = {origin, source_.direction_at(origin)};
  if (source_.is_distant()) return;
  start_.diverges = true;
  start_.per_distance_mm = 1.0 / length(origin + source_.direction * source_.distance_mm);
  start_.flux = source_.flux_at(origin);
}

}  // namespace contrejour::inline internal
