// SPDX-License-Identifier: Apache-2.0
#include "polynomial/evaluated_rays.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>

#include "polynomial/asymmetric_basis.h"

namespace contrejour::inline internal::polynomial {
namespace {

using pupils::RaySource;

constexpr float kAboveLargest = 1.5F;  // of the transmittance, for points between those of a grid
constexpr float kReach = 1.2F;  // relative height: beyond, polynomials are free to grow

struct PowerVector {
  PowerSum along_field, along_pupil;

  PowerVector(const FieldVector& vector, double wavelength)
      : along_field(vector.along_field.at(wavelength)), along_pupil(vector.along_pupil.at(wavelength)) {}
  void scale(double by) {
    for (PowerSum* const sum : {&along_field, &along_pupil})
      for (float& c : sum->coefficients) c *= static_cast<float>(by);
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
            .y_per_mm = static_cast<float>(per_mm.y),
            .per_end = field_.pupil_end > 0.0 ? static_cast<float>(1.0 / (field_.pupil_end * field_.pupil_end)) : 0.0F};
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

}  // namespace

Vec2 mirrored_by(const FoundAsymmetricZone& found, Vec2 v) {
  return {found.mirrored_x ? -v.x : v.x, found.mirrored_y ? -v.y : v.y};
}

FieldPolynomials::FieldPolynomials(const PreparedZone& prepared, const PolynomialZone& zone, double field)
    : sensor_mm(prepared.sensor_mm, field_coordinate(zone, field)),
      transmittance(prepared.transmittance, field_coordinate(zone, field)), h(field / zone.field_high),
      centre_mm{centre_at(zone, field), 0.0}, radius_mm{zone.radius_mm, zone.radius_mm}, pupil_end(zone.pupil_end) {
  const double u = field_coordinate(zone, field);
  for (const PreparedVector& crossing : prepared.stop) stop.emplace_back(crossing, u);
  for (const PreparedSum& rim : prepared.rims) rims.emplace_back(rim, u);
}

FieldPolynomials::FieldPolynomials(const FoundAsymmetricZone& found, Vec2 s)
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

std::unique_ptr<RaySource> evaluated_rays(const FieldPolynomials& field, double wavelength) {
  return std::make_unique<EvaluatedRays>(field, wavelength);
}

}  // namespace contrejour::inline internal::polynomial
