// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fitted_lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

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

struct FieldVector {
  FieldSum along_field, along_pupil;

  FieldVector(const PreparedVector& vector, double field_coordinate)
      : along_field(vector.along_field, field_coordinate), along_pupil(vector.along_pupil, field_coordinate) {}
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
  double h = 0.0, centre_mm = 0.0, radius_mm = 1.0;  // of pupil points
  double stop_scale = 1.0;  // from the fit's stop radii to the requested ones
  double shift_mm = 0.0;  // along x, from the requested entrance plane to the fit's
  Rectangle upper_half;  // that light enters within

  FieldPolynomials(const PreparedZone& prepared, const PolynomialZone& zone, double field)
      : sensor_mm(prepared.sensor_mm, field_coordinate(zone, field)),
        transmittance(prepared.transmittance, field_coordinate(zone, field)), h(field / zone.field_high),
        centre_mm(centre_at(zone, field)), radius_mm(zone.radius_mm) {
    const double u = field_coordinate(zone, field);
    for (const PreparedVector& crossing : prepared.stop) stop.emplace_back(crossing, u);
    for (const PreparedSum& rim : prepared.rims) rims.emplace_back(rim, u);
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
    const Vec2 size = field_.upper_half.high - field_.upper_half.low;
    for (std::size_t k = 0; k < kCount; ++k) {
      x[k] = static_cast<float>(size.x * (static_cast<double>(k % kColumns) + 0.5) / kColumns);
      y[k] = static_cast<float>(size.y * (static_cast<double>(k / kColumns) + 0.5) / kRows);
    }
    for (VectorOutput& vector : vectors_) vector.x = vector.y = unused.data();
    for (ScalarOutput& rim : rim_outputs_) rim.values = nullptr;
    evaluate_points(map_from(field_.upper_half.low), x.data(), y.data(), kCount,
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
    const double per_mm = 1.0 / field_.radius_mm;
    return {static_cast<float>((origin_mm.x + field_.shift_mm - field_.centre_mm) * per_mm),
            static_cast<float>(origin_mm.y * per_mm), static_cast<float>(per_mm), static_cast<float>(field_.h)};
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
  [[nodiscard]] Rectangle upper_half() const override { return field_.upper_half; }

 private:
  const LensPolynomials& fit_;
  FieldPolynomials field_;
};

// A ghost without light.
class DarkGhost final : public FittedGhost {
 public:
  [[nodiscard]] std::unique_ptr<RaySource> at(double /*lambda_nm*/) const override { return nullptr; }
  [[nodiscard]] Rectangle upper_half() const override { return {}; }
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
  }
}

std::unique_ptr<FittedGhost> FittedLens::find(const RayRequest& request) const {
  const LightSource& source = request.light.source;
  if (!request.light.symmetric || !source.is_distant() || request.shortest_nm < fit_->shortest_nm ||
      request.longest_nm > fit_->longest_nm || request.stop_radius_mm > kWidestStop * fit_->stop_radius_mm)
    return nullptr;
  const auto found = ghosts_.find(request.ghost);
  if (found == ghosts_.end()) return nullptr;
  const OfGhost& of = found->second;
  const double field = source.direction.x / source.direction.z;
  const PolynomialZone* const zone = find_zone(*of.ghost, field);
  if (zone == nullptr || zone->state == PolynomialZone::State::Traced) return nullptr;
  const PolynomialBounds bounds = bounds_at(*zone, field);
  if (zone->state == PolynomialZone::State::Dark || !has_light(bounds)) return std::make_unique<DarkGhost>();
  FieldPolynomials polynomials(of.zones[static_cast<std::size_t>(zone - of.ghost->zones.data())], *zone, field);
  polynomials.stop_scale = fit_->stop_radius_mm / request.stop_radius_mm;
  polynomials.shift_mm = field * (fit_->entrance_z_mm - request.plane_z_mm);
  polynomials.upper_half = {{bounds.low_x_mm - polynomials.shift_mm, 0.0},
                            {bounds.high_x_mm - polynomials.shift_mm, bounds.half_y_mm}};
  return std::make_unique<GhostOfLight>(*fit_, std::move(polynomials));
}

}  // namespace contrejour::inline internal::polynomial
