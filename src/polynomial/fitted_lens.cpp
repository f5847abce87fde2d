// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fitted_lens.h"

#include <algorithm>
#include <utility>

#include "polynomial/asymmetric_basis.h"
#include "polynomial/evaluated_rays.h"
#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {
namespace {

using pupils::FittedGhost;
using pupils::RayRequest;
using pupils::RaySource;

class GhostOfLight final : public FittedGhost {
 public:
  GhostOfLight(const LensPolynomials& fit, FieldPolynomials field) : fit_(fit), field_(std::move(field)) {}

  [[nodiscard]] std::unique_ptr<RaySource> at(double lambda_nm) const override {
    return evaluated_rays(field_, wavelength_coordinate(fit_, lambda_nm));
  }
  [[nodiscard]] Rectangle region() const override { return field_.region; }
  [[nodiscard]] bool is_symmetric() const override { return field_.is_symmetric; }

 private:
  const LensPolynomials& fit_;
  FieldPolynomials field_;
};

// A ghost without light.
class DarkGhost final : public FittedGhost {
 public:
  [[nodiscard]] std::unique_ptr<RaySource> at(double /*lambda_nm*/) const override { return nullptr; }
  [[nodiscard]] Rectangle region() const override { return {}; }
  [[nodiscard]] bool is_symmetric() const override { return true; }
};

// The bounds at a field; next to a field without light those of the other neighbour, since searches miss some small
// pupils.
PolynomialBounds bounds_at(const PolynomialZone& zone, double field) {
  const PolynomialBounds between = bounds_between(zone, field);
  if (has_light(between)) return between;
  const auto at = static_cast<float>(field);
  for (std::size_t k = 0; k + 1 < zone.bounds.size(); ++k) {
    if (at < zone.bounds[k].field || at > zone.bounds[k + 1].field) continue;
    PolynomialBounds bounds = has_light(zone.bounds[k]) ? zone.bounds[k] : zone.bounds[k + 1];
    if (!has_light(bounds)) continue;
    const auto shift = static_cast<float>(centre_at(zone, field) - centre_at(zone, bounds.field));
    bounds.low_x_mm += shift;
    bounds.high_x_mm += shift;
    return bounds;
  }
  return between;
}

}  // namespace

FittedLens::FittedLens(std::shared_ptr<const LensPolynomials> fit) : fit_(std::move(fit)) {
  for (const GhostPolynomials& ghost : fit_->ghosts) {
    OfGhost& of = ghosts_[ghost.ghost];
    of.ghost = &ghost;
    for (const PolynomialZone& zone : ghost.zones) {
      of.zones.emplace_back();
      if (zone.state != PolynomialZone::State::Fitted) continue;
      of.zones.back() = PreparedZone(zone);
      bytes_ += 2 * sizeof(float) * zone.sensor_mm.along_field.coefficients.size() * (2 + zone.stop.size());
    }
    for (const AsymmetricZone& zone : ghost.asymmetric)
      bytes_ += 2 * sizeof(float) * zone.sensor_mm.x.coefficients.size() * (2 + zone.stop.size());
  }
}

std::unique_ptr<FittedGhost> FittedLens::find(const RayRequest& request) const {
  const LightSource& source = request.light.source;
  if (!source.is_distant() || request.shortest_nm < fit_->shortest_nm || request.longest_nm > fit_->longest_nm ||
      request.stop_radius_mm > kWidestStop * fit_->stop_radius_mm)
    return nullptr;
  const auto found = ghosts_.find(request.ghost);
  if (found == ghosts_.end()) return nullptr;
  const OfGhost& of = found->second;
  if (!request.light.symmetric) return find_asymmetric(request, *of.ghost);
  const double field = source.direction.x / source.direction.z;
  const PolynomialZone* const zone = find_zone(*of.ghost, field);
  if (zone == nullptr || zone->state == PolynomialZone::State::Traced) return nullptr;
  const PolynomialBounds bounds = bounds_at(*zone, field);
  if (zone->state == PolynomialZone::State::Dark || !has_light(bounds)) return std::make_unique<DarkGhost>();
  FieldPolynomials polynomials(of.zones[static_cast<std::size_t>(zone - of.ghost->zones.data())], *zone, field);
  polynomials.stop_scale = fit_->stop_radius_mm / request.stop_radius_mm;
  polynomials.shift_mm.x = field * (fit_->entrance_z_mm - request.plane_z_mm);
  polynomials.region = {{bounds.low_x_mm - polynomials.shift_mm.x, 0.0},
                        {bounds.high_x_mm - polynomials.shift_mm.x, bounds.half_y_mm}};
  return std::make_unique<GhostOfLight>(*fit_, std::move(polynomials));
}

std::unique_ptr<FittedGhost> FittedLens::find_asymmetric(const RayRequest& request,
                                                         const GhostPolynomials& ghost) const {
  const Vec3 direction = request.light.source.direction;
  const Vec2 tangents{direction.x / direction.z, direction.y / direction.z};
  const FoundAsymmetricZone found = find_zone(ghost, tangents);
  if (found.zone == nullptr || found.zone->state == PolynomialZone::State::Traced) return nullptr;
  if (found.zone->state == PolynomialZone::State::Dark) return std::make_unique<DarkGhost>();
  const Vec2 of_zone = mirrored_by(found, tangents);
  const AsymmetricBounds bounds = bounds_between(*found.zone, of_zone);
  if (!lets_light_in(bounds)) return std::make_unique<DarkGhost>();
  FieldPolynomials polynomials(found, field_point(*found.zone, of_zone));
  polynomials.stop_scale = fit_->stop_radius_mm / request.stop_radius_mm;
  polynomials.shift_mm = tangents * (fit_->entrance_z_mm - request.plane_z_mm);
  const Vec2 a = mirrored_by(found, {bounds.low_x_mm, bounds.low_y_mm}) - polynomials.shift_mm;
  const Vec2 b = mirrored_by(found, {bounds.high_x_mm, bounds.high_y_mm}) - polynomials.shift_mm;
  polynomials.region = {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
  return std::make_unique<GhostOfLight>(*fit_, std::move(polynomials));
}

}  // namespace contrejour::inline internal::polynomial
