#include <algorithm>
#include <cmath>

#include "optics/trace/packet_trace.h"

namespace contrejour {
namespace {

// Beyond the critical angle seen from the denser side there is no u; from the other side every u is an angle.
double cos_in_denser(double u, double n_low, double n_high) {
  const double eta = n_low / n_high;
  return std::sqrt(1.0 - eta * eta * (1.0 - u * u));
}

// Every so many of the table's values is computed; a cubic through four of them, good to 1e-7, gives the others.
constexpr int kSpacing = 8;

// Lagrange's cubic through the four nodes about a place between the first and the last.
double cubic(const std::vector<double>& nodes, double place) {
  const auto first = static_cast<std::size_t>(
      std::clamp<double>(std::floor(place) - 1.0, 0.0, static_cast<double>(nodes.size()) - 4.0));
  const double t = place - static_cast<double>(first);
  return nodes[first] * (t - 1) * (t - 2) * (t - 3) / -6.0 + nodes[first + 1] * t * (t - 2) * (t - 3) / 2.0 +
         nodes[first + 2] * t * (t - 1) * (t - 3) / -2.0 + nodes[first + 3] * t * (t - 1) * (t - 2) / 6.0;
}

}  // namespace

ReflectanceTables::ReflectanceTables(const LensState& lens, double lambda_nm) : lambda_nm_(lambda_nm) {
  for (const SurfaceState& surface : lens.surfaces) {
    Entry entry;
    if (surface.kind != SurfaceKind::Stop) {
      const bool absorbs = may_absorb(surface.coating);
      const bool same_both_ways = !absorbs && !std::holds_alternative<HullinFresnelAR>(surface.coating.films);
      entry.reflectance[0] = add(surface, +1, false);
      entry.reflectance[1] = same_both_ways ? entry.reflectance[0] : add(surface, -1, false);
      if (absorbs) entry.transmittance = add(surface, +1, true);
    }
    entries_.push_back(entry);
    if (none_ >= 0 || (surface.aperture.kind == ApertureKind::Disc && !surface.obscuration.any())) continue;
    none_ = static_cast<int>(values_.size());
    values_.insert(values_.end(), kIntervals + 1, 0.0F);
  }
}

int ReflectanceTables::add(const SurfaceState& surface, int direction, bool transmitted) {
  const int offset = static_cast<int>(values_.size());
  const double before = refractive_index(surface.before, lambda_nm_);
  const double after = refractive_index(surface.after, lambda_nm_);
  const double n_in = direction > 0 ? before : after;
  const double n_out = direction > 0 ? after : before;
  const Coating coating = at_wavelength(surface.coating, lambda_nm_);
  const auto exact = [&](int k) {
    // Grazing itself is 0/0 in a matrix of films; its limit is next to it.
    const double u = std::max(static_cast<double>(k) / kIntervals, 1e-9);
    const double cos_in = n_in > n_out ? cos_in_denser(u, n_out, n_in) : u;
    return transmitted ? transmittance(coating, n_in, n_out, cos_in, lambda_nm_)
                       : reflectance(coating, n_in, n_out, cos_in, lambda_nm_);
  };
  std::vector<double> nodes;
  for (int k = 0; k <= kIntervals; k += kSpacing) nodes.push_back(exact(k));
  for (int k = 0; k < kIntervals; ++k)
    values_.push_back(static_cast<float>(cubic(nodes, static_cast<double>(k) / kSpacing)));
  values_.push_back(static_cast<float>(nodes.back()));
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
    PacketStep step;
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
    step.inverse_semi_diameter_per_mm = 1.0 / from.semi_diameter_mm;
    step.inverse_semi_diameter_squared = 1.0 / (from.semi_diameter_mm * from.semi_diameter_mm);
    step.eta = from.n_in / from.n_out;
    const double per_mm = 1.0 / from.semi_diameter_mm;
    step.rim = from.rim.value_or(Rim{{}, {per_mm, 0.0}, {0.0, per_mm}});
    step.blocks_within = from.blocks_within;
    step.absorption_per_mm = from.absorption_per_mm;
    step.kick = from.kick;
    step.share = from.share;
    if (from.rim || from.absorption_per_mm != 0.0 || from.share != 1.0) geometry_ = PathGeometry::General;
    before_mm = vertex_mm;
    steps_.push_back(step);
  }
  sensor_gap_mm_ = path.sensor_z_mm - before_mm.z;
  sensor_offset_mm_ = {-before_mm.x, -before_mm.y};
}

void PacketPath::start_from(Vec2 origin_mm) {
  const Vec3 origin{origin_mm.x, origin_mm.y, start_.origin_mm.z};
  start_ = {origin, source_.direction_at(origin)};
  if (source_.is_distant()) return;
  start_.diverges = true;
  start_.per_way_mm = 1.0 / length(origin + source_.direction * source_.distance_mm);
  start_.flux = source_.flux_at(origin);
}

}  // namespace contrejour
