// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/bench/polynomial_lenses.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

// The figures that fits and pictures must reach.
constexpr double kMostMedian_px = 0.01, kMostWeighted_px = 0.25, kMostTransmittance = 2e-3, kMostTraced = 0.15;
constexpr double kMostBytes = 2e6, kMostClock_s = 30.0;
constexpr double kLeast_db = 50.0, kMostBelowAdaptive_db = 3.0, kMostFlux = 0.005;

// The names of what is missed; "yes" if nothing is.
class Missed {
 public:
  void unless(bool holds, const char* name) {
    if (!holds) names_.emplace_back(name);
  }
  [[nodiscard]] std::string text() const {
    return names_.empty() ? "yes" : fmt::format("no: {}", fmt::join(names_, ", "));
  }

 private:
  std::vector<std::string> names_;
};

Missed missed_by(const LensFit& fit, const LensFitErrors& errors) {
  Missed missed;
  missed.unless(errors.median_px < kMostMedian_px, "median");
  missed.unless(errors.weighted_px < kMostWeighted_px, "mean");
  missed.unless(errors.weighted_transmittance <= kMostTransmittance, "T");
  missed.unless(traced_flux_fraction(*fit.fit) < kMostTraced, "traced");
  missed.unless(static_cast<double>(fit.bytes) < kMostBytes, "file");
  missed.unless(fit.clock_s < kMostClock_s, "time");
  return missed;
}

double db_of(const std::optional<double>& db) { return db.value_or(INFINITY); }
std::string db_words(const std::optional<double>& db) { return db ? fmt::format("{:.1f}", *db) : "equal"; }
std::string flux_words(double ratio) { return fmt::format("{:+.2f}", 100.0 * (ratio - 1.0)); }

Missed missed_by(const LensPicture& picture) {
  Missed missed;
  missed.unless(db_of(picture.polynomial_db) >= kLeast_db, "PSNR");
  missed.unless(db_of(picture.polynomial_db) >= db_of(picture.adaptive_db) - kMostBelowAdaptive_db, "adaptive");
  missed.unless(std::abs(picture.polynomial_flux - 1.0) <= kMostFlux, "flux");
  return missed;
}

std::string fits_text(const PolynomialLenses& lenses) {
  if (lenses.fits.empty()) return "";
  TextTable table({"<lens", "f/", "ghosts", "median px", "mean px", "T %", "worst T %", "traced %", "file MB",
                   "processor s", "clock s", "<holds"});
  table.add({"must", "", "", fmt::format("< {}", kMostMedian_px), fmt::format("< {}", kMostWeighted_px),
             fmt::format("<= {}", 100.0 * kMostTransmittance), "", fmt::format("< {:.0f}", 100.0 * kMostTraced),
             fmt::format("< {:.0f}", kMostBytes / 1e6), "", fmt::format("< {:.0f}", kMostClock_s), ""});
  for (const LensFit& fit : lenses.fits)
    for (const LensFitErrors& errors : fit.errors)
      table.add({std::string(fit.system->name), fmt::format("{:.3g}", errors.f_number),
                 fmt::format("{}", fit.fit->ghosts.size()), fmt::format("{:.4f}", errors.median_px),
                 fmt::format("{:.3f}", errors.weighted_px),
                 fmt::format("{:.3f}", 100.0 * errors.weighted_transmittance),
                 fmt::format("{:.2f}", 100.0 * errors.worst_transmittance),
                 fmt::format("{:.1f}", 100.0 * traced_flux_fraction(*fit.fit)),
                 fmt::format("{:.2f}", static_cast<double>(fit.bytes) / 1e6), fmt::format("{:.1f}", fit.processor_s),
                 fmt::format("{:.1f}", fit.clock_s), missed_by(fit, errors).text()});
  return fmt::format(
      "\nWhole-field fits: 95 per cent of rays that no fit has used, by the scalar tracer; median of the ghosts, mean\n"
      "by their fluxes; {} threads\n{}",
      lenses.fits.front().threads, table.text());
}

std::string pictures_text(const PolynomialLenses& lenses) {
  if (lenses.pictures.empty()) return "";
  TextTable table({"<lens", "f/", "size", "adaptive dB", "polynomial dB", "adaptive flux %", "polynomial flux %",
                   "traced %", "<holds"});
  table.add({"must", "", "", "", fmt::format(">= {:.0f}, adaptive - {:.0f}", kLeast_db, kMostBelowAdaptive_db), "",
             fmt::format("+-{}", 100.0 * kMostFlux), "", ""});
  for (const LensPicture& p : lenses.pictures)
    table.add({std::string(p.system->name), fmt::format("{:.3g}", p.f_number),
               fmt::format("{} x {}", p.width, p.height), db_words(p.adaptive_db), db_words(p.polynomial_db),
               flux_words(p.adaptive_flux), flux_words(p.polynomial_flux), fmt::format("{:.1f}", 100.0 * p.traced_flux),
               missed_by(p).text()});
  return fmt::format("\nPictures from one fit against `reference`: one light, fluxes of the worst channel\n{}",
                     table.text());
}

}  // namespace

std::string polynomial_lenses_text(const PolynomialLenses& lenses) { return fits_text(lenses) + pictures_text(lenses); }

Json polynomial_lenses_json(const PolynomialLenses& lenses) {
  Json fits = Json::array(), pictures = Json::array();
  for (const LensFit& fit : lenses.fits)
    for (const LensFitErrors& errors : fit.errors)
      fits.push_back({{"system", fit.system->key},
                      {"f_number", errors.f_number},
                      {"ghosts", fit.fit->ghosts.size()},
                      {"median_position_p95_px", errors.median_px},
                      {"weighted_position_p95_px", errors.weighted_px},
                      {"weighted_transmittance_p95", errors.weighted_transmittance},
                      {"worst_transmittance_p95", errors.worst_transmittance},
                      {"rays", errors.rays},
                      {"traced_flux_fraction", traced_flux_fraction(*fit.fit)},
                      {"bytes", fit.bytes},
                      {"processor_seconds", fit.processor_s},
                      {"clock_seconds", fit.clock_s},
                      {"threads", fit.threads},
                      {"holds", missed_by(fit, errors).text()}});
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  for (const LensPicture& picture : lenses.pictures)
    pictures.push_back({{"system", picture.system->key},
                        {"f_number", picture.f_number},
                        {"width", picture.width},
                        {"height", picture.height},
                        {"adaptive_psnr_db", number(picture.adaptive_db)},
                        {"polynomial_psnr_db", number(picture.polynomial_db)},
                        {"adaptive_flux_ratio", picture.adaptive_flux},
                        {"polynomial_flux_ratio", picture.polynomial_flux},
                        {"traced_flux_fraction", picture.traced_flux},
                        {"holds", missed_by(picture).text()}});
  return {{"fits", std::move(fits)}, {"pictures", std::move(pictures)}};
}

}  // namespace contrejour::cli
