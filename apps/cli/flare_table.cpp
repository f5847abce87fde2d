// SPDX-License-Identifier: Apache-2.0
#include "cli/flare_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

double degrees_of(double tangent) { return std::atan(tangent) / params::kDegree_rad; }

std::size_t held_out(const FittedFlare& fit) {
  return static_cast<std::size_t>(std::ranges::count(fit.stations, true, &FittedStation::held_out));
}

// On the axis, or where its range begins.
double level_of(const MeasuredGhost& ghost) { return ghost.inside[1](ghost.first); }

std::string ghost_row(const MeasuredGhost& ghost) {
  return fmt::format("{:<8} {:>8.4f} {:>9.5f} {:>10.3g} {:>7.2f} {:>7.2f}\n", ghost.name, ghost.centre.derivative(0.0),
                     ghost.half_height(0.0), level_of(ghost), degrees_of(ghost.first), degrees_of(ghost.last));
}

Json ghost_json(const MeasuredGhost& ghost) {
  return {{"name", ghost.name},       {"speed", ghost.centre.derivative(0.0)}, {"half_height", ghost.half_height(0.0)},
          {"level", level_of(ghost)}, {"first_deg", degrees_of(ghost.first)},  {"last_deg", degrees_of(ghost.last)}};
}

}  // namespace

double flux_error(const FittedFlare& fit) {
  double squares = 0.0, count = 0.0;
  for (const FittedStation& station : fit.stations) {
    if (!(station.captured > 0.0)) continue;
    squares += std::pow(station.fitted / station.captured - 1.0, 2);
    ++count;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

std::string fit_text(const FitOutcome& outcome) {
  const FittedFlare& fit = outcome.fit;
  std::string text = fmt::format(
      "{}: {} ghosts found at {} stations, {:.1f} s, {:.0f} pictures evaluated\n"
      "optical centre {:.2f}, {:.2f} px (the light alone: {:.2f}, {:.2f} +- {:.2f}); focal length {:.1f} px; roll "
      "{:.2f} degrees\n"
      "NRMSE {:.1f} per cent at {} fitted stations",
      outcome.name, fit.found.size(), fit.stations.size(), outcome.seconds, fit.image_evaluations, fit.centre_px.x,
      fit.centre_px.y, outcome.geometry.centre_px.x, outcome.geometry.centre_px.y, outcome.geometry.centre_error_px.x,
      std::abs(outcome.geometry.focal_length_px), outcome.geometry.roll_rad / params::kDegree_rad, 100.0 * fit.nrmse,
      fit.stations.size() - held_out(fit));
  if (held_out(fit) > 0) text += fmt::format(", {:.1f} at {} held out", 100.0 * fit.held_out_nrmse, held_out(fit));
  text += fmt::format("; flux by angle within {:.1f} per cent (RMS)\n", 100.0 * flux_error(fit));
  if (fit.flare.ghosts.empty()) return text;
  text += "\nghost       speed  1/2height      level    from      to (degrees)\n";
  for (const MeasuredGhost& ghost : fit.flare.ghosts) text += ghost_row(ghost);
  return text;
}

Json fit_json(const FitOutcome& outcome) {
  const FittedFlare& fit = outcome.fit;
  Json ghosts = Json::array(), stations = Json::array();
  for (const MeasuredGhost& ghost : fit.flare.ghosts) ghosts.push_back(ghost_json(ghost));
  for (const FittedStation& s : fit.stations) {
    stations.push_back({{"angle_deg", degrees_of(s.s)},
                        {"held_out", s.held_out},
                        {"nrmse", s.nrmse},
                        {"captured_flux", s.captured},
                        {"fitted_flux", s.fitted}});
  }
  return {{"name", outcome.name},
          {"seconds", outcome.seconds},
          {"ghosts_found", fit.found.size()},
          {"degree", fit.degree},
          {"image_evaluations", fit.image_evaluations},
          {"nrmse", fit.nrmse},
          {"held_out_nrmse", fit.held_out_nrmse},
          {"flux_error", flux_error(fit)},
          {"centre_px", Json::array({fit.centre_px.x, fit.centre_px.y})},
          {"focal_length_px", outcome.geometry.focal_length_px},
          {"roll_deg", outcome.geometry.roll_rad / params::kDegree_rad},
          {"zero_deg", outcome.geometry.zero_rad / params::kDegree_rad},
          {"ghosts", ghosts},
          {"stations", stations},
          {"warnings", fit.warnings}};
}

std::string stations_csv(const FittedFlare& fit) {
  std::string csv = "angle_deg,held_out,nrmse,captured_flux,fitted_flux\n";
  for (const FittedStation& s : fit.stations)
    csv += fmt::format("{:.6g},{},{:.6g},{:.6g},{:.6g}\n", degrees_of(s.s), s.held_out ? 1 : 0, s.nrmse, s.captured,
                       s.fitted);
  return csv;
}

}  // namespace contrejour::cli
