// SPDX-License-Identifier: Apache-2.0
// Fits the direct image of a lens: docs/physics/polynomial.md, "Direct image".
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "polynomial/direct_check.h"
#include "polynomial/direct_samples.h"
#include "polynomial/fit_lens.h"
#include "polynomial/fit_rays.h"
#include "polynomial/node_polynomials.h"
#include "polynomial/zone_check.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr double kPastCorner = 1.02;
constexpr int kLowestDegree = 2;  // order 5
constexpr double kFarthestDirect = 1.2, kFarthestRim = 2.0;  // relative heights, as for ghosts
constexpr double kLeftOutTerms = 0.25;  // of a target: last wavelength terms, and rounding
constexpr double kInnerAccuracy = 1e-5;  // of the aperture's sine

// The fit without polynomials.
DirectPolynomials direct_frame(const LensState& lens, const DirectFitOptions& options) {
  const LensPolynomials ghosts = without_ghosts(lens, {.half_field_rad = 0.1});
  DirectPolynomials frame;
  frame.lens = ghosts.lens;
  frame.fingerprint = ghosts.fingerprint;
  frame.focal_length_mm = lens.focal_length_mm;
  frame.front_z_mm = ghosts.entrance_z_mm;
  frame.sensor_z_mm = lens.sensor_z_mm;
  frame.stop_radius_mm = ghosts.stop_radius_mm;
  frame.pixel_mm = ghosts.pixel_mm;
  frame.max_height_mm = options.max_height_mm > 0.0
                            ? options.max_height_mm
                            : kPastCorner * 0.5 * std::hypot(lens.sensor_width_mm, lens.sensor_height_mm);
  return frame;
}

// Rises from the lowest degree until the errors reach the target; keeps the best. fit(degree) and error_of(fitted).
template <class Fitted, class Fit, class ErrorOf>
double rising_degree(const DirectSystem& system, int max_degree, double target, Fitted& best, const Fit& fit,
                     const ErrorOf& error_of) {
  double least = std::numeric_limits<double>::infinity();
  for (int degree = kLowestDegree; degree <= max_degree && system.has_enough_rays(degree); ++degree) {
    Fitted tried = fit(degree);
    const double error = error_of(tried);
    if (!(error < least)) continue;  // not a number, too
    least = error;
    best = std::move(tried);
    if (error <= target) break;
  }
  return least;
}

class DirectFit {
 public:
  DirectFit(const DirectFitOptions& options, const DirectSamples& samples, const DirectCheck& check,
            DirectPolynomials& fitted)
      : options_(options), samples_(samples), check_(check), fitted_(fitted), light_(samples, fitted, kFarthestDirect),
        edges_(samples, fitted, kFarthestRim) {}

  void fit_ray() {
    const double aperture = std::abs(0.5 * entrance_diameter_mm() / fitted_.focal_length_mm);
    const std::array<DirectSystem::Member, 3> members{
        {{&CameraRay::origin_mm, kLeftOutTerms * options_.edge * 0.5 * entrance_diameter_mm()},
         {&CameraRay::direction,
          kLeftOutTerms * options_.position_px * fitted_.pixel_mm / std::abs(fitted_.focal_length_mm)},
         {&CameraRay::inner, kInnerAccuracy * aperture}}};
    rising_degree(
        light_, max_degree_, options_.position_px, fitted_,
        [&](int degree) {
          DirectPolynomials tried = fitted_;
          auto vectors = light_.vectors(degree, members);
          tried.origin_mm = std::move(vectors[0]);
          tried.direction = std::move(vectors[1]);
          tried.inner = std::move(vectors[2]);
          return tried;
        },
        [&](const DirectPolynomials& tried) { return quantile(check_.landing(tried).sensor_px, 0.95); });
    const DirectCheck::Landing landing = check_.landing(fitted_);
    accuracy().sensor_p50_px = quantile(landing.sensor_px, 0.5);
    accuracy().sensor_p95_px = quantile(landing.sensor_px, 0.95);
    accuracy().sensor_max_px = quantile(landing.sensor_px, 1.0);
    accuracy().stop_p95 = quantile(landing.stop, 0.95);
  }

  void fit_rims() {
    RayTable table;  // all that the search of rims reads
    table.stop.resize(1);
    for (std::size_t k = 0; k < samples_.points.size(); ++k) {
      const CameraRay& ray = samples_.middle()[k];
      table.sensor_x_mm.push_back(0.0F);
      table.relative_height.push_back(static_cast<float>(ray.largest_height));
      table.stop[0][0].push_back(static_cast<float>(samples_.points[k].stop.x));
      table.stop[0][1].push_back(static_cast<float>(samples_.points[k].stop.y));
      table.rim_squared.resize(ray.rim_squared.size());
      for (std::size_t step = 0; step < ray.rim_squared.size(); ++step)
        table.rim_squared[step].push_back(static_cast<float>(ray.rim_squared[step]));
    }
    std::vector<int> steps;
    add_blocking_steps(table, steps);
    for (const int step : steps) {
      PolynomialRim rim{step, {}};
      const double error = rising_degree(
          edges_, max_degree_, options_.edge, rim.squared,
          [&](int degree) {
            const auto value = [step](const CameraRay& ray) { return ray.rim_squared[static_cast<std::size_t>(step)]; };
            return edges_.scalar(degree, kWavelengthStep, value, kLeftOutTerms * options_.edge);
          },
          [&](const ChebyshevSum& tried) { return quantile(check_.rim_errors(tried, step), 0.95); });
      accuracy().rim_p95 = std::max(accuracy().rim_p95, error);
      fitted_.rims.push_back(std::move(rim));
    }
  }

  void fit_transmittance() {
    accuracy().transmittance_p95 = rising_degree(
        light_, max_degree_, options_.transmittance, fitted_.transmittance,
        [&](int degree) {
          return light_.scalar(
              degree, 1, [](const CameraRay& ray) { return ray.transmittance; },
              kLeftOutTerms * options_.transmittance);
        },
        [&](const ChebyshevSum& tried) { return quantile(check_.transmittance_errors(tried), 0.95); });
  }

  void finish() {
    accuracy().rays = check_.rays();
    check_.count_wrongly_blocked(fitted_, accuracy());
  }

  [[nodiscard]] bool has_enough_rays() const { return light_.has_enough_rays(kLowestDegree); }

 private:
  [[nodiscard]] DirectAccuracy& accuracy() { return fitted_.accuracy; }
  // Twice the largest distance from the chief ray's on the axis, at which rays cross the front plane.
  [[nodiscard]] double entrance_diameter_mm() const {
    double largest = 0.0;
    for (std::size_t k = 0; k < samples_.points.size(); ++k)
      if (samples_.points[k].sensor_mm.x == 0.0) largest = std::max(largest, length(samples_.middle()[k].origin_mm));
    return 2.0 * largest;
  }

  const DirectFitOptions& options_;
  const DirectSamples& samples_;
  const DirectCheck& check_;
  DirectPolynomials& fitted_;
  DirectSystem light_, edges_;
  int max_degree_ = (options_.max_order - 1) / 2;
};

Result<void> check_direct_options(const DirectFitOptions& options) {
  if (const auto good = check_fit_options({.position_px = options.position_px,
                                           .edge = options.edge,
                                           .transmittance = options.transmittance,
                                           .max_order = options.max_order});
      !good)
    return good;
  if (!(options.max_height_mm >= 0.0 && options.max_height_mm < 1e6))
    return invalid_argument("the largest height of a sensor point must be 0 mm or more");
  return {};
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

Result<DirectPolynomials> fit_direct_polynomials(const LensState& lens, const DirectFitOptions& options,
                                                 const Context& context) {
  if (const auto good = check_lens(lens); !good) return tl::unexpected(good.error());
  if (const auto good = check_direct_options(options); !good) return tl::unexpected(good.error());
  const LensState open = wide_open(lens);
  if (!lens.has_axial_symmetry() || direct_path(open, open.design_wavelength_nm).obscured)
    return failure(ErrorCode::Unsupported,
                   fmt::format("the direct image of '{}' cannot be fitted: it has elements without axial symmetry, or "
                               "obscurations; trace its rays",
                               lens.name));
  DirectPolynomials fitted = direct_frame(lens, options);
  const DirectPolynomials frame = fitted;
  const DirectSamples samples = direct_samples(open, frame, context);
  if (context.cancelled()) return interrupted();
  const DirectCheck check(open, frame);
  DirectFit fit(options, samples, check, fitted);
  if (!fit.has_enough_rays() || check.rays() == 0)
    return failure(ErrorCode::Unsupported,
                   fmt::format("too few rays get through '{}' to fit its direct image", lens.name));
  fit.fit_ray();
  fit.fit_rims();
  fit.fit_transmittance();
  fit.finish();
  return fitted;
}

}  // namespace contrejour
