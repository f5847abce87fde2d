// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/polynomial_zones.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/polynomial.h"
#include "contrejour/expert/published_samples.h"
#include "contrejour/lens.h"

namespace contrejour::cli {
namespace {

using namespace published;

constexpr double kPixelsOfWidth = 1920.0;
constexpr int kMostGhosts = 4;

double largest_field_of(const LensState& lens) {
  return std::hypot(lens.sensor_width_mm, lens.sensor_height_mm) * 0.5 / lens.focal_length_mm;
}

Result<void> add_zones(PolynomialFits& fits, const LensState& lens, const Ghost& ghost, const ZoneOptions& options,
                       const ZoneSampling& sampling, const Context& context) {
  const auto zones = zone_samples(lens, ghost, sampling);
  if (!zones) return tl::unexpected(zones.error());
  ZoneSampling others = sampling;
  others.seed = sampling.seed + 1000;
  const auto unseen = zone_samples(lens, ghost, others);
  if (!unseen) return tl::unexpected(unseen.error());
  const auto fit = fit_sparse_zones(zones->zones, options, context);
  if (!fit) return tl::unexpected(fit.error());
  double squares = 0.0;
  std::size_t rays = 0;
  for (std::size_t zone = 0; zone < std::min(unseen->zones.size(), fit->coefficients.size()); ++zone) {
    Polynomial polynomial;
    for (std::size_t k = 0; k < fit->terms.size(); ++k)
      polynomial.terms.push_back({fit->terms[k], fit->coefficients[zone][k]});
    Samples samples{unseen->zones[zone].inputs, unseen->zones[zone].values};
    const double scale = unseen->radius_mm / zones->radius_mm;  // each has its own circle
    for (Inputs& at : samples.inputs) {
      at[0] *= scale, at[1] *= scale, at[2] *= scale;
      at[3] = 1.0 - at[2];
    }
    const double error = rms_error(polynomial, samples);
    squares += error * error * static_cast<double>(samples.values.size());
    rays += samples.values.size();
  }
  const double pixel_mm = lens.sensor_width_mm / kPixelsOfWidth;
  const bool gaps = options.search == ZoneOptions::Search::Gaps;
  PolynomialRow row{"zones",
                    fmt::format("{} {}, {}", ghost_name(ghost), gaps ? "gap search" : "annealing",
                                sampling.along_field ? "along the field" : "across"),
                    options.terms,
                    sampling.rays,
                    gaps ? static_cast<int>(fit->curve.size()) : options.iterations,
                    fit->error / pixel_mm,
                    std::sqrt(squares / static_cast<double>(rays)) / pixel_mm,
                    fit->seconds};
  row.note = fmt::format("pixels; {} zones", zones->zones.size());
  fits.rows.push_back(std::move(row));
  auto curve = fit->curve;
  for (CurvePoint& point : curve) point.error /= pixel_mm, point.best /= pixel_mm;
  if (sampling.along_field)
    fits.curves.push_back(
        {"zones", fmt::format("{} {} {}", ghost_name(ghost), gaps ? "gaps" : "annealing", options.terms), curve});
  return {};
}

// Our fit of the ghosts: one for the whole field and all wavelengths.
Result<void> add_whole_field(PolynomialFits& fits, const LensState& lens, const std::vector<Ghost>& ghosts,
                             const Context& context) {
  const std::clock_t start = std::clock();
  const auto fit =
      fit_polynomials(lens, {.half_field_rad = std::atan(largest_field_of(lens)), .ghosts = ghosts}, context);
  if (!fit) return tl::unexpected(fit.error());
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  for (const GhostPolynomials& ghost : fit->ghosts) {
    for (const PolynomialZone& zone : ghost.zones) {
      if (zone.state != PolynomialZone::State::Fitted) continue;
      const auto terms =
          zone.sensor_mm.along_field.coefficients.size() + zone.sensor_mm.along_pupil.coefficients.size();
      PolynomialRow row{"zones",
                        fmt::format("{} invariant, order {}", ghost_name(ghost.ghost), zone.order),
                        static_cast<int>(terms),
                        0,
                        0,
                        zone.accuracy.position_p95_px,
                        zone.accuracy.position_p95_px,
                        seconds / static_cast<double>(ghosts.size())};
      row.note = fmt::format(
          "pixels, 95 per cent of rays left out; tangents {:.3f} to {:.3f}, all wavelengths, both "
          "coordinates and all other outputs",
          zone.field_low, zone.field_high);
      fits.rows.push_back(std::move(row));
    }
  }
  return {};
}

}  // namespace

Result<void> measure_polynomial_zones(PolynomialFits& fits, const PolynomialBenchOptions& options,
                                      const Context& context) {
  const auto prescription = find_lens(options.lens);
  if (!prescription) return tl::unexpected(prescription.error());
  const auto lens = configure_lens(*prescription);
  if (!lens) return tl::unexpected(lens.error());
  std::vector<Ghost> ghosts = enumerate_ghosts(*lens, GhostScope::OneSideOfStop);
  const std::size_t count = options.full ? kMostGhosts : 1;
  if (ghosts.size() > count) ghosts.resize(count);
  ZoneSampling sampling{
      .fields = options.full ? 24 : 6, .largest_field = largest_field_of(*lens), .seed = options.seed};
  sampling.rays = options.full ? 800 : 300;
  for (const Ghost& ghost : ghosts) {
    for (const int terms : options.full ? std::vector{5, 10} : std::vector{5}) {
      for (const auto search : {ZoneOptions::Search::Gaps, ZoneOptions::Search::Annealing}) {
        if (terms > 5 && search == ZoneOptions::Search::Annealing) continue;
        const ZoneOptions zone{
            .terms = terms, .search = search, .iterations = options.full ? 10000 : 2000, .seed = options.seed};
        if (const auto ok = add_zones(fits, *lens, ghost, zone, sampling, context); !ok) return ok;
      }
    }
  }
  return add_whole_field(fits, *lens, ghosts, context);
}

}  // namespace contrejour::cli
