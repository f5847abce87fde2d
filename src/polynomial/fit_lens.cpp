// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fit_lens.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "base/split_mix.h"
#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "polynomial/chebyshev_basis.h"
#include "polynomial/fit_asymmetric.h"
#include "polynomial/fit_field.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr double kPixelsAcross = 1920.0;
constexpr int kMaxHalvings = 4;

// Neither through an obscuration nor of an order of the sensor's grating.
bool is_unobscured(const LensState& lens, const Ghost& ghost) {
  return ghost.order == std::array<int, 2>{0, 0} && !ghost_path(lens, ghost, lens.design_wavelength_nm).obscured;
}

GhostPolynomials fit_ghost(const LensState& lens, const StepsByWavelength& steps, const LensPolynomials& all,
                           const PolynomialOptions& options, const Ghost& ghost) {
  const bool symmetric = has_axial_symmetry(lens, ghost);
  if (!is_unobscured(lens, ghost) || (!symmetric && !options.asymmetric)) return {ghost, {traced_zone(all)}};
  const GhostRays rays(lens, steps, ghost, all.entrance_z_mm);
  const Vec2 sensor_half_mm{0.5 * lens.sensor_width_mm, 0.5 * lens.sensor_height_mm};
  if (!symmetric)
    return fit_asymmetric_ghost({all, options, rays, sensor_half_mm}, lens, ghost, largest_tangents(lens, options));
  GhostPolynomials fitted{ghost, {}};
  for (auto& zone : fit_field({all, options, {{&rays, 1.0}}, {{&rays, {1.0}}}, sensor_half_mm}, all.max_field))
    fitted.zones.push_back(std::move(zone.front()));
  return fitted;
}

class Fingerprint {
 public:
  // Seven digits: compilers may differ in the last ones.
  void add(double value) {
    for (const char c : fmt::format("{:.6e};", value)) hash_ = split_mix(hash_ ^ static_cast<unsigned char>(c));
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = kSplitMixIncrement;
};

// A number that differs for apertures and obscurations that differ; 0 for a disc without any.
double opening_of(const SurfaceState& surface) {
  const Obscuration& within = surface.obscuration;
  double sum = 1.1 * within.half_mm.x + 1.3 * within.half_mm.y + 1.7 * within.centre_mm.x + 1.9 * within.centre_mm.y +
               2.3 * within.rotation_rad;
  const ClearAperture& aperture = surface.aperture;
  if (aperture.kind != ApertureKind::Disc)
    sum += 100.0 * static_cast<double>(aperture.kind) + 2.9 * aperture.half_mm.x + 3.1 * aperture.half_mm.y +
           3.7 * aperture.centre_mm.x + 4.1 * aperture.centre_mm.y + 4.3 * aperture.rotation_rad;
  return sum;
}

}  // namespace

double largest_field(const LensState& lens, const PolynomialOptions& options) {
  if (options.half_field_rad > 0.0) return std::tan(options.half_field_rad);
  const Vec3 corner = direction_for_image_point(lens, {0.5 * lens.sensor_width_mm, 0.5 * lens.sensor_height_mm},
                                                lens.design_wavelength_nm);
  return kBeyondCorner * std::hypot(corner.x, corner.y) / corner.z;
}

LensState wide_open(const LensState& lens) {
  LensState open = lens;
  open.stop_radius_mm = lens.surfaces[static_cast<std::size_t>(lens.stop_index)].semi_diameter_mm;
  return open;
}

Result<void> check_fit_options(const PolynomialOptions& options) {
  if (options.max_order < 5 || options.max_order > 2 * kMaxDegree + 1 || options.max_order % 2 == 0)
    return invalid_argument(fmt::format("the largest order is {}; choose an odd one, 5 to 17", options.max_order));
  if (options.max_halvings < 0 || options.max_halvings > kMaxHalvings)
    return invalid_argument(fmt::format("the field cannot be halved {} times; choose 0 to 4", options.max_halvings));
  for (const double tolerance : {options.position_px, options.edge, options.transmittance, options.target_px})
    if (!(tolerance > 0.0 && tolerance < 1e6))
      return invalid_argument("the tolerances of a polynomial fit must be above 0");
  if (!(options.half_field_rad >= 0.0 && options.half_field_rad < 1.5))
    return invalid_argument("the half field of a polynomial fit must be 0 to 85 degrees");
  return {};
}

PolynomialZone traced_zone(const LensPolynomials& all) {
  PolynomialZone traced;
  traced.state = PolynomialZone::State::Traced;
  traced.field_high = all.max_field;
  return traced;
}

bool is_fitted(const LensState& lens, const Ghost& ghost) {
  return has_axial_symmetry(lens, ghost) && is_unobscured(lens, ghost);
}

Result<std::vector<Ghost>> ghosts_to_fit(const LensState& lens, const PolynomialOptions& options) {
  std::vector<Ghost> ghosts =
      options.ghosts.empty() ? enumerate_ghosts(lens, options.scope, options.reflections) : options.ghosts;
  for (const Ghost& ghost : ghosts)
    if (!has_ghost(lens, ghost))
      return invalid_argument(fmt::format("there is no ghost {} in this lens", ghost_name(ghost)));
  return ghosts;
}

LensPolynomials without_ghosts(const LensState& lens, const PolynomialOptions& options) {
  const LensState open = wide_open(lens);
  LensPolynomials all;
  all.lens = lens.name;
  all.fingerprint = polynomial_fingerprint(lens);
  all.entrance_z_mm = entrance_window(open, LightSource({0.0, 0.0, 1.0})).z_mm;
  all.stop_radius_mm = open.stop_radius_mm;
  all.pixel_mm = lens.sensor_width_mm / kPixelsAcross;
  all.max_field = largest_field(lens, options);
  return all;
}

}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

std::uint64_t polynomial_fingerprint(const LensState& lens) {
  Fingerprint fingerprint;
  fingerprint.add(lens.sensor_z_mm);
  fingerprint.add(lens.absorption ? 1.0 : 0.0);
  for (const double lambda_nm : {450.0, 550.0, 650.0}) {
    const ReflectanceTables tables(lens, lambda_nm);
    for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
      const SurfaceState& surface = lens.surfaces[k];
      fingerprint.add(surface.z_mm);
      fingerprint.add(opening_of(surface));
      if (surface.kind == SurfaceKind::Stop) continue;
      fingerprint.add(surface.curvature_per_mm);
      fingerprint.add(surface.semi_diameter_mm);
      fingerprint.add(refractive_index(surface.before, lambda_nm));
      fingerprint.add(refractive_index(surface.after, lambda_nm));
      fingerprint.add(surface.is_centred() ? 0.0
                                           : surface.pose.shift_mm.x + 2.0 * surface.pose.shift_mm.y +
                                                 3.0 * surface.pose.axis.x + 5.0 * surface.pose.axis.y);
      const auto sag = sag_range(surface.curvature_per_mm, surface.shape, 0.7 * surface.semi_diameter_mm);
      fingerprint.add(sag ? sag->low_mm + 2.0 * sag->high_mm : 0.0);
      const int at = tables.of(static_cast<int>(k)).reflectance[0];
      for (const int node : {ReflectanceTables::kIntervals, ReflectanceTables::kIntervals / 2})
        fingerprint.add(at >= 0 ? tables.values()[at + node] : 0.0);
    }
  }
  return fingerprint.value();
}

Result<LensPolynomials> fit_polynomials(const LensState& lens, const PolynomialOptions& options,
                                        const Context& context) {
  if (const auto good = check_lens(lens); !good) return tl::unexpected(good.error());
  if (const auto good = check_fit_options(options); !good) return tl::unexpected(good.error());
  const LensState open = wide_open(lens);
  const TablesByWavelength tables(open);
  const StepsByWavelength steps(open, tables);
  LensPolynomials all = without_ghosts(lens, options);
  const auto wanted = ghosts_to_fit(lens, options);
  if (!wanted) return tl::unexpected(wanted.error());
  const std::vector<Ghost>& ghosts = *wanted;
  std::vector<GhostPolynomials> fitted(ghosts.size());
  const bool done = parallel_for(ghosts.size(), context,
                                 [&](std::size_t k) { fitted[k] = fit_ghost(open, steps, all, options, ghosts[k]); });
  if (!done) return interrupted();
  all.ghosts = std::move(fitted);
  return all;
}

double traced_flux_fraction(const LensPolynomials& polynomials) {
  double traced = 0.0, sum = 0.0;
  for (const GhostPolynomials& ghost : polynomials.ghosts) {
    for (const AsymmetricZone& zone : ghost.asymmetric) {
      const double flux = zone.flux_mm2 * area_of(ghost, zone);
      sum += flux;
      if (zone.state == PolynomialZone::State::Traced) traced += flux;
    }
    for (const PolynomialZone& zone : ghost.zones) {
      const double flux = zone.flux_mm2 * (zone.field_high * zone.field_high - zone.field_low * zone.field_low);
      sum += flux;
      if (zone.state == PolynomialZone::State::Traced) traced += flux;
    }
  }
  return sum > 0.0 ? traced / sum : 0.0;
}

}  // namespace contrejour
