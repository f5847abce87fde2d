// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fitted_lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "polynomial/asymmetric_basis.h"
#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {
namespace {

using pupils::FittedGhost;
using pupils::RayRequest;
using pupils::RaySource;

// Over the widest stop: rays up to 1.06 of it are in a fit, but count less the farther out they are.
constexpr double kWidestStop = 1.03;
constexpr float kAboveLargest = 1.5F;  // of the transmittance, for points between those of a grid
constexpr float kReach = 1.2F;  // relative height: beyond, polynomials are free to grow

Vec2 mirrored_by(const FoundAsymmetricZone& found, Vec2 v) {
  return {found.mirrored_x ? -v.x : v.x, found.mirrored_y ? -v.y : v.y};
}

struct FieldVector {
  FieldSum along_field, along_pupil;

  FieldVector(const PreparedVector& vector, double field_coordinate)
      : along_field(vector.along_field, field_coordinate), along_pupil(vector.along_pupil, field_coordinate) {}
  // Without axial symmetry: x and y instead.
  FieldVector(const AsymmetricVector& vector, const AsymmetricZone& zone, Vec2 s, const FoundAsymmetricZone& found)
      : along_field(vector.x, parities_of_x(zone), s, {found.mirrored_x, found.mirrored_y, found.mirrored_x}),
        along_pupil(vector.y, parities_of_y(zone), s, {found.mirrored_x, found.mirrored_y, found.mirrored_y}) {}
};

struct PowerVector {
  PowerSum along_field, along_pupil;

  PowerVector(const FieldVector& vector, double wavelength)
      : along_field(vector.along_field.at(wavelength)), along_pupil(vector.along_pupil.at(wavelength)) {}
  void scale(double by) {
    for (PowerSum* const sum : {&along_field, &along_pupil})
      for (float& c : sum->coefficients) c *= static_cast<float>(by);
  }
};

// A zone's polynomials at the field of a light.
struct FieldPolynomials {
  FieldVector sensor_mm;
  std::vector<FieldVector> stop;
  std::vector<FieldSum> rims;
  FieldSum transmittance;
  bool is_symmetric = true;
  double h = 0.0;
  Vec2 centre_mm, radius_mm{1.0, 1.0};  // of pupil points
  double stop_scale = 1.0;  // from the fit's stop radii to the requested ones
  Vec2 shift_mm;  // from the requested entrance plane to the fit's
  Rectangle region;  // that light enters within; its upper half where symmetric

  FieldPolynomials(const PreparedZone& prepared, const PolynomialZone& zone, double field)
      : sensor_mm(prepared.sensor_mm, field_coordinate(zone, field)),
        transmittance(prepared.transmittance, field_coordinate(zone, field)), h(field / zone.field_high),
        centre_mm{centre_at(zone, field), 0.0}, radius_mm{zone.radius_mm, zone.radius_mm} {
    const double u = field_coordinate(zone, field);
    for (const PreparedVector& crossing : prepared.stop) stop.emplace_back(crossing, u);
    for (const PreparedSum& rim : prepared.rims) rims.emplace_back(rim, u);
  }
  // s: of the light or its mirror image in the zone.
  FieldPolynomials(const FoundAsymmetricZone& found, Vec2 s)
      : sensor_mm(found.zone->sensor_mm, *found.zone, s, found),
        transmittance(found.zone->transmittance, parities_of_scalar(*found.zone), s,
                      {found.mirrored_x, found.mirrored_y, false}),
        is_symmetric(false), radius_mm(found.zone->radius_mm) {
    const AsymmetricZone& zone = *found.zone;
    centre_mm = mirrored_by(found, centre_at(zone, s));
    for (const AsymmetricVector& crossing : zone.stop) stop.emplace_back(crossing, zone, s, found);
    for (const PolynomialRim& rim : zone.rims)
      rims.emplace_back(rim.squared, parities_of_scalar(zone), s, Mirroring{found.mirrored_x, found.mirrored_y, false});
  }
};

class EvaluatedRays final : public RaySource {
 public:
  EvaluatedRays(const FieldPolynomials& field, double wavelength)
      : field_(field), wavelength_(wavelength), transmittance_(field.transmittance.at(wavelength)) {}

  void rays(Vec2 origin_mm, PacketPrecision /*precision*/, const float* x_mm, const float* y_mm, std::size_t count,
            const TracedArrays& out) override {
    const float largest = largest_transmittance();  // uses the outputs that are set next
    prepare_geometry();
    vectors_[0].x = out.sensor_x_mm;
    vectors_[0].y = out.sensor_y_mm;
    set_stops(out.stop_x, out.stop_y);
    for (std::size_t k = 0; k < rims_.size(); ++k)
      rim_outputs_[k].values = out.rim_squared != nullptr ? out.rim_squared + k * out.rim_stride : nullptr;
    evaluate_points(map_from(origin_mm), x_mm, y_mm, count,
                    {.vectors = vectors_,
                     .rims = rim_outputs_,
                     .relative_height = out.relative_height,
                     .crossings = field_.stop.size(),
                     .stop_scale = widest_scale(),
                     .transmittance = {&transmittance_, out.transmission},
                     .largest_transmittance = largest});
  }

  void transmissions(Vec2 origin_mm, PacketPrecision /*precision*/, const float* x_mm, const float* y_mm,
                     std::size_t count, float* out) override {
    evaluate_points(map_from(origin_mm), x_mm, y_mm, count,
                    {.transmittance = {&transmittance_, out}, .largest_transmittance = largest_transmittance()});
  }

  // Polynomials do not fail. The relative height comes without its direction, as a point on the x axis.
  void clearances(Vec2 origin_mm, PacketPrecision /*precision*/, const float* x_mm, const float* y_mm,
                  std::size_t count, const ClearanceArrays& out) override {
    prepare_geometry();
    for (float* const none : {out.failing, out.passed, out.rim_y}) std::fill_n(none, count, 0.0F);
    set_stops(out.stop_x, out.stop_y);
    for (ScalarOutput& rim : rim_outputs_) rim.values = nullptr;
    evaluate_points(map_from(origin_mm), x_mm, y_mm, count,
                    {.vectors = std::span(vectors_).subspan(1),
                     .rims = rim_outputs_,
                     .relative_height = out.rim_x,
                     .crossings = field_.stop.size(),
                     .stop_scale = widest_scale()});
  }

  [[nodiscard]] int stop_crossings() const override { return static_cast<int>(field_.stop.size()); }
  [[nodiscard]] std::size_t rims() const override { return field_.rims.size(); }
  [[nodiscard]] bool blocks_within(std::size_t /*rim*/) const override { return false; }
  [[nodiscard]] float reach() const override { return kReach; }
  [[nodiscard]] std::size_t surfaces() const override { return 0; }

 private:
  // The widest stop blocks light as rims do: from stop coordinates to its relative height.
  [[nodiscard]] float widest_scale() const { return static_cast<float>(1.0 / (kWidestStop * field_.stop_scale)); }

  // Somewhat above that of light that gets through a wide open stop; infinite if a grid meets none.
  float largest_transmittance() {
    if (largest_transmittance_) return *largest_transmittance_;
    prepare_geometry();
    constexpr std::size_t kColumns = 8, kRows = 4, kCount = kColumns * kRows;
    std::array<float, kCount> x{}, y{}, height{}, transmittance{}, unused{};
    const Vec2 size = field_.region.high - field_.region.low;
    for (std::size_t k = 0; k < kCount; ++k) {
      x[k] = static_cast<float>(size.x * (static_cast<double>(k % kColumns) + 0.5) / kColumns);
      y[k] = static_cast<float>(size.y * (static_cast<double>(k / kColumns) + 0.5) / kRows);
    }
    for (VectorOutput& vector : vectors_) vector.x = vector.y = unused.data();
    for (ScalarOutput& rim : rim_outputs_) rim.values = nullptr;
    evaluate_points(map_from(field_.region.low), x.data(), y.data(), kCount,
                    {.vectors = vectors_,
                     .rims = rim_outputs_,
                     .relative_height = height.data(),
                     .crossings = field_.stop.size(),
                     .stop_scale = widest_scale(),
                     .transmittance = {&transmittance_, transmittance.data()},
                     .largest_transmittance = std::numeric_limits<float>::infinity()});
    float largest = 0.0F;
    for (std::size_t k = 0; k < kCount; ++k)
      if (height[k] <= 1.0F) largest = std::max(largest, kAboveLargest * transmittance[k]);
    largest_transmittance_ = largest > 0.0F ? largest : std::numeric_limits<float>::infinity();
    return *largest_transmittance_;
  }

  // Wavelengths of which only the transmittance is asked for do without.
  void prepare_geometry() {
    if (!vectors_.empty()) return;
    power_vectors_.emplace_back(field_.sensor_mm, wavelength_);
    for (const FieldVector& crossing : field_.stop) {
      power_vectors_.emplace_back(crossing, wavelength_);
      power_vectors_.back().scale(field_.stop_scale);
    }
    for (const FieldSum& rim : field_.rims) rims_.push_back(rim.at(wavelength_));
    for (const PowerVector& vector : power_vectors_) vectors_.push_back({&vector.along_field, &vector.along_pupil});
    for (const PowerSum& rim : rims_) rim_outputs_.push_back({&rim});
  }

  void set_stops(const std::array<float*, kMaxStopCrossings>& x, const std::array<float*, kMaxStopCrossings>& y) {
    for (std::size_t c = 0; c < field_.stop.size(); ++c) {
      vectors_[1 + c].x = x[c];
      vectors_[1 + c].y = y[c];
    }
  }

  [[nodiscard]] PupilMap map_from(Vec2 origin_mm) const {
    const Vec2 from = origin_mm + field_.shift_mm - field_.centre_mm;
    const Vec2 per_mm{1.0 / field_.radius_mm.x, 1.0 / field_.radius_mm.y};
    return {.x = static_cast<float>(from.x * per_mm.x),
            .y = static_cast<float>(from.y * per_mm.y),
            .per_mm = static_cast<float>(per_mm.x),
            .h = static_cast<float>(field_.h),
            .symmetric = field_.is_symmetric,
            .y_per_mm = static_cast<float>(per_mm.y)};
  }

  const FieldPolynomials& field_;
  double wavelength_;  // its coordinate
  PowerSum transmittance_;
  std::optional<float> largest_transmittance_;
  std::vector<PowerVector> power_vectors_;  // of the sensor, then of the stop's crossings
  std::vector<PowerSum> rims_;
  std::vector<VectorOutput> vectors_;
  std::vector<ScalarOutput> rim_outputs_;
};

class GhostOfLight final : public FittedGhost {
 public:
  GhostOfLight(const LensPolynomials& fit, FieldPolynomials field) : fit_(fit), field_(std::move(field)) {}

  [[nodiscard]] std::unique_ptr<RaySource> at(double lambda_nm) const override {
    return std::make_unique<EvaluatedRays>(field_, wavelength_coordinate(fit_, lambda_nm));
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
