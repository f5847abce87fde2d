// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>

#include "cli/bench/polynomial_lenses.h"
#include "contrejour/expert/trace.h"

namespace contrejour::cli {
namespace {

constexpr int kFields = 7, kPointsAtField = 160;  // of a zone
constexpr std::array kLambdas_nm{416.0, 487.0, 533.0, 601.0, 668.0};  // no nodes of a fit
constexpr double kLandingNear = 1.1;  // of the sensor's half diagonal

double quantile_95(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(values.size() - 1)))];
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// The bounds of light at a field, between those of the fields next to it.
std::optional<PolynomialBounds> bounds_near(const PolynomialZone& zone, double field) {
  for (std::size_t k = 0; k + 1 < zone.bounds.size(); ++k) {
    const PolynomialBounds &a = zone.bounds[k], &b = zone.bounds[k + 1];
    if (field < a.field || field > b.field || a.low_x_mm >= a.high_x_mm || b.low_x_mm >= b.high_x_mm) continue;
    const auto t = static_cast<float>((field - a.field) / std::max<double>(b.field - a.field, 1e-9));
    return PolynomialBounds{static_cast<float>(field), std::lerp(a.low_x_mm, b.low_x_mm, t),
                            std::lerp(a.high_x_mm, b.high_x_mm, t), std::lerp(a.half_y_mm, b.half_y_mm, t)};
  }
  return std::nullopt;
}

class GhostErrors {
 public:
  GhostErrors(const LensPolynomials& fit, const LensState& lens, const GhostPolynomials& ghost)
      : fit_(fit), random_(static_cast<std::uint32_t>(1000 * ghost.ghost.i + ghost.ghost.j)),
        opening_(lens.stop_radius_mm / fit.stop_radius_mm),
        near_mm_(kLandingNear * 0.5 * std::hypot(lens.sensor_width_mm, lens.sensor_height_mm)) {
    LensState open = lens;
    open.stop_radius_mm = fit.stop_radius_mm;
    for (const double lambda_nm : kLambdas_nm) paths_.push_back(ghost_path(open, ghost.ghost, lambda_nm));
    for (const PolynomialZone& zone : ghost.zones)
      if (zone.state == PolynomialZone::State::Fitted) add(zone);
    for (auto& [error, wavelength] : transmittance_) relative_.push_back(error / std::max(largest_[wavelength], 1e-30));
  }

  [[nodiscard]] int rays() const { return static_cast<int>(transmittance_.size()); }
  [[nodiscard]] double flux() const { return flux_; }
  double position_px() { return quantile_95(position_px_); }
  double transmittance() { return quantile_95(relative_); }

 private:
  double uniform() { return std::uniform_real_distribution(0.0, 1.0)(random_); }

  void add(const PolynomialZone& zone) {
    flux_ += zone.flux_mm2 * (zone.field_high * zone.field_high - zone.field_low * zone.field_low);
    for (int f = 0; f < kFields; ++f) {
      const double low = zone.field_low * zone.field_low, high = zone.field_high * zone.field_high;
      const double field = std::sqrt(low + (high - low) * (f + uniform()) / kFields);
      const auto bounds = bounds_near(zone, field);
      if (!bounds) continue;
      for (int k = 0; k < kPointsAtField; ++k) add_ray(zone, field, *bounds, static_cast<std::size_t>(k + f) % 5);
    }
  }

  void add_ray(const PolynomialZone& zone, double field, const PolynomialBounds& bounds, std::size_t wavelength) {
    Vec2 at{std::lerp(bounds.low_x_mm, bounds.high_x_mm, uniform()), bounds.half_y_mm * uniform()};
    if (opening_ < 0.99) {
      const auto aimed = aimed_at_stop(zone, field, at, wavelength);
      if (!aimed) return;
      at = *aimed;
    }
    const TracedRay traced =
        trace(paths_[wavelength], {{at.x, at.y, fit_.entrance_z_mm}, normalized(Vec3{field, 0.0, 1.0})});
    if (traced.status != RayStatus::Ok || traced.relative_height > 1.0) return;
    for (int c = 0; c < paths_[wavelength].stop_crossings; ++c)
      if (length(traced.stop[static_cast<std::size_t>(c)]) > opening_) return;
    const PolynomialRay fitted = evaluate(fit_, zone, field, at, kLambdas_nm[wavelength]);
    largest_[wavelength] = std::max(largest_[wavelength], traced.transmission);
    if (length(traced.sensor_mm) > near_mm_) return;
    transmittance_.emplace_back(std::abs(fitted.transmittance - traced.transmission), wavelength);
    position_px_.push_back(length(fitted.sensor_mm - traced.sensor_mm) / fit_.pixel_mm);
  }

  // The point from which a ray crosses the stop, by the polynomials, at a random point of the opening: of random points
  // few would get through a small one. Newton's method from `at`; none if it does not converge.
  std::optional<Vec2> aimed_at_stop(const PolynomialZone& zone, double field, Vec2 at, std::size_t wavelength) {
    const double radius = opening_ * std::sqrt(uniform()), angle = 6.283185307179586 * uniform();
    const Vec2 target = Vec2{std::cos(angle), std::sin(angle)} * radius;
    const double step_mm = 1e-4 * zone.radius_mm;
    const auto miss = [&](Vec2 from) {
      return evaluate(fit_, zone, field, from, kLambdas_nm[wavelength]).stop[0] - target;
    };
    for (int k = 0; k < 8; ++k) {
      const Vec2 here = miss(at);
      if (length(here) < 1e-3 * opening_) return at;
      const Vec2 dx = (miss(at + Vec2{step_mm, 0.0}) - here) * (1.0 / step_mm);
      const Vec2 dy = (miss(at + Vec2{0.0, step_mm}) - here) * (1.0 / step_mm);
      const double determinant = dx.x * dy.y - dx.y * dy.x;
      Vec2 move = Vec2{here.y * dy.x - here.x * dy.y, here.x * dx.y - here.y * dx.x} * (1.0 / determinant);
      const double size = length(move), longest = 0.5 * zone.radius_mm;
      if (!(size < 1e9)) return std::nullopt;
      if (size > longest) move = move * (longest / size);
      at = at + move;
    }
    return std::nullopt;
  }

  const LensPolynomials& fit_;
  std::mt19937 random_;
  double opening_;  // of the stop, over the widest
  double near_mm_;
  std::vector<OpticalPath> paths_;
  std::vector<double> position_px_, relative_;
  std::vector<std::pair<double, std::size_t>> transmittance_;  // errors, and the wavelengths that they are of
  std::array<double, kLambdas_nm.size()> largest_{};
  double flux_ = 0.0;
};

}  // namespace

LensFitErrors errors_of_fit(const LensPolynomials& fit, const LensState& lens) {
  LensFitErrors errors{.f_number = lens.f_number};
  std::vector<double> medians;
  double flux = 0.0;
  for (const GhostPolynomials& ghost : fit.ghosts) {
    GhostErrors of(fit, lens, ghost);
    if (of.rays() == 0) continue;
    errors.rays += of.rays();
    flux += of.flux();
    medians.push_back(of.position_px());
    errors.weighted_px += of.flux() * of.position_px();
    errors.weighted_transmittance += of.flux() * of.transmittance();
    errors.worst_transmittance = std::max(errors.worst_transmittance, of.transmittance());
  }
  for (double* const mean : {&errors.weighted_px, &errors.weighted_transmittance}) *mean /= std::max(flux, 1e-30);
  errors.median_px = median_of(std::move(medians));
  return errors;
}

}  // namespace contrejour::cli
