// SPDX-License-Identifier: Apache-2.0
#include "cli/fit_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>

#include <fmt/format.h>

#include "cli/line_chart.h"
#include "cli/printable.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/svg.h"
#include "contrejour/image_io.h"

namespace contrejour::cli {
namespace {

constexpr double kShownQuantile = 0.998, kShownLevel = 0.8;  // samples of this quantile are shown at this level
constexpr int kCurvePoints = 60;

constexpr const char* kReportHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>A flare learned from photographs</title>
<style>
body { font: 11pt/1.4 sans-serif; max-width: 62em; margin: 1.5em auto; padding: 0 1em; color: #111; }
h1 { font-size: 1.4em; } h2 { font-size: 1.15em; margin: 1.6em 0 .4em; }
table { border-collapse: collapse; } td, th { padding: .15em .6em; text-align: right; border-bottom: 1px solid #ddd; }
.pictures { display: grid; grid-template-columns: 6em repeat(3, 1fr); gap: 4px; align-items: center; }
.pictures img { width: 100%; background: #000; } .pictures div { font-size: .9em; }
svg { max-width: 100%; height: auto; }
</style>
</head>
<body>
)";

std::string page_text(const std::string& words) { return markup_text(printable(words, Lines::Keep)); }

Result<std::string> embedded(const Image& picture, double stops) {
  const auto png = preview_png(picture, {stops, true});
  if (!png) return tl::unexpected(png.error());
  return "<img alt=\"\" src=\"" + data_uri("image/png", *png) + "\">\n";
}

double angle_of(double s) { return std::atan(s) / params::kDegree_rad; }

Result<std::string> pictures_html(const FittedFlare& fit) {
  std::string html =
      "<h2>Captured, fitted, residual</h2>\n<p>Without the halo, black where it or saturation covers the flare; the "
      "residual is the difference's "
      "size; all at one exposure.</p>\n<div class=\"pictures\">\n";
  const double stops = exposure_of(fit);
  for (const FittedStation& station : fit.stations) {
    if (station.captured_picture.pixels.empty()) continue;
    html += fmt::format("<div>{:+.2f}&deg;{}<br>NRMSE {:.0f}&nbsp;%</div>\n", angle_of(station.s),
                        station.held_out ? "<br>held out" : "", 100.0 * station.nrmse);
    for (const Image& picture : {station.captured_picture, station.fitted_picture, residual_of(station)}) {
      const auto image = embedded(picture, stops);
      if (!image) return tl::unexpected(image.error());
      html += *image;
    }
  }
  return html + "</div>\n";
}

// A curve of each ghost, but the veil, over the light's angle.
LineChart ghost_chart(const FittedFlare& fit, const std::string& title, const std::string& label,
                      const std::function<double(const MeasuredGhost&, double)>& value) {
  LineChart chart{title, "angle of the light, degrees", label, {}};
  for (const MeasuredGhost& ghost : fit.flare.ghosts) {
    if (ghost.name == "veil") continue;
    ChartCurve curve{"ghost " + ghost.name, {}};
    for (int k = 0; k <= kCurvePoints; ++k) {
      const double s = ghost.first + (ghost.last - ghost.first) * k / kCurvePoints;
      curve.points.push_back({angle_of(s), value(ghost, s)});
    }
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

LineChart station_chart(const FittedFlare& fit, bool of_flux) {
  LineChart chart;
  chart.x_label = "angle of the light, degrees";
  chart.title = of_flux ? "Flux of the flare, relative to the light's" : "NRMSE by angle";
  chart.y_label = of_flux ? "flux" : "per cent";
  chart.curves = of_flux ? std::vector<ChartCurve>{{"captured", {}, true}, {"fitted", {}}}
                         : std::vector<ChartCurve>{{"fitted", {}, true}, {"held out", {}, true}};
  for (const FittedStation& s : fit.stations) {
    if (of_flux) {
      chart.curves[0].points.push_back({angle_of(s.s), s.captured});
      chart.curves[1].points.push_back({angle_of(s.s), s.fitted});
    } else {
      chart.curves[s.held_out ? 1 : 0].points.push_back({angle_of(s.s), 100.0 * s.nrmse});
    }
  }
  for (ChartCurve& curve : chart.curves) std::ranges::sort(curve.points, {}, &Vec2::x);
  return chart;
}

// The mean level inside a ghost, with its profile.
double green_inside(const MeasuredGhost& ghost, double s) {
  double level = ghost.inside[1](s);
  for (std::size_t k = 0; k < ghost.profile[1].size(); ++k) level += profile_mean(k) * ghost.profile[1][k](s);
  return std::max(level, 0.0);
}

LineChart convergence_chart(const FittedFlare& fit) {
  LineChart chart{"The last fit of all ghosts: cost over pictures evaluated", "pictures evaluated", "cost", {{}}};
  for (const FitProgress& p : fit.progress) chart.curves[0].points.push_back({p.image_evaluations, p.cost});
  return chart;
}

std::string charts_html(const FittedFlare& fit) {
  std::string html =
      "<h2>By angle</h2>\n" + line_chart(station_chart(fit, true)) + line_chart(station_chart(fit, false));
  if (!fit.found.empty()) {
    html += "<h2>Curves of the ghosts</h2>\n";
    html += line_chart(ghost_chart(fit, "Centre over the light's place (speed)", "speed", [](const auto& g, double s) {
      return s > 1e-6 ? g.centre(s) / s : g.centre.derivative(0.0);
    }));
    html += line_chart(ghost_chart(fit, "Half height, as a tangent", "half height",
                                   [](const auto& g, double s) { return g.half_height(s); }));
    html += line_chart(ghost_chart(fit, "Half width, as a tangent", "half width",
                                   [](const auto& g, double s) { return g.half_width(s); }));
    LineChart levels = ghost_chart(fit, "Mean level inside, green", "level", green_inside);
    levels.log_y = true;
    html += line_chart(levels);
  }
  return html + "<h2>Convergence</h2>\n" + line_chart(convergence_chart(fit));
}

std::string comparison_html(const FitComparison& c) {
  return fmt::format(
             "<h2>Against walch2018's descent</h2>\n<p>From the same start, by the paper's cost (its section 3.3.1), "
             "grey "
             "pictures. Ours: {:.0f} pictures evaluated, cost {:.4f} at the end. The descent: {:.0f} pictures, cost "
             "{:.4f}; ours reaches that after {}.</p>\n",
             c.ours.back().image_evaluations, c.ours.back().cost, c.walch.back().image_evaluations, c.walch.back().cost,
             c.ours_to_walch_cost ? fmt::format("{:.0f} pictures", *c.ours_to_walch_cost) : "no number of pictures") +
         comparison_chart(c);
}

}  // namespace

double exposure_of(const FittedFlare& fit) {
  double bright = 0.0;
  for (const FittedStation& station : fit.stations)
    if (!station.captured_picture.pixels.empty())
      bright = std::max(bright, quantile_of_samples(station.captured_picture, kShownQuantile));
  return bright > 0.0 ? std::log2(kShownLevel / bright) : 0.0;
}

Image residual_of(const FittedStation& station) {
  Image residual = station.captured_picture;
  for (std::size_t k = 0; k < residual.pixels.size(); ++k)
    residual.pixels[k] = std::abs(residual.pixels[k] - station.fitted_picture.pixels[k]);
  return residual;
}

std::string comparison_chart(const FitComparison& comparison) {
  LineChart chart{"The paper's cost over pictures evaluated", "pictures evaluated", "cost", {}};
  chart.log_x = chart.log_y = true;
  const std::array<std::pair<const char*, const std::vector<CostProgress>&>, 2> both{
      {{"ours", comparison.ours}, {"walch2018", comparison.walch}}};
  for (const auto& [name, progress] : both) {
    std::array<ChartCurve, 3> curves{
        {{std::string(name) + ", cost", {}}, {std::string(name) + ", MSE", {}}, {std::string(name) + ", edges", {}}}};
    for (const CostProgress& p : progress) {
      curves[0].points.push_back({p.image_evaluations, p.cost});
      curves[1].points.push_back({p.image_evaluations, p.mse});
      curves[2].points.push_back({p.image_evaluations, p.edges});
    }
    chart.curves.insert(chart.curves.end(), curves.begin(), curves.end());
  }
  return line_chart(chart);
}

std::string comparison_csv(const FitComparison& comparison) {
  std::string csv = "fit,image_evaluations,cost,mse,edges\n";
  const auto add = [&](const char* name, const std::vector<CostProgress>& progress) {
    for (const CostProgress& p : progress)
      csv += fmt::format("{},{:.0f},{:.6g},{:.6g},{:.6g}\n", name, p.image_evaluations, p.cost, p.mse, p.edges);
  };
  add("ours", comparison.ours);
  add("walch2018", comparison.walch);
  return csv;
}

Result<std::string> fit_report(const FitOutcome& outcome, const std::optional<FitComparison>& comparison) {
  const auto pictures = pictures_html(outcome.fit);
  if (!pictures) return tl::unexpected(pictures.error());
  std::string html = kReportHead;
  html += "<h1>" + page_text(outcome.name) + ": a flare learned from photographs</h1>\n<pre>" +
          page_text(fit_text(outcome)) + "</pre>\n";
  for (const std::string& warning : outcome.fit.warnings) html += "<p>Warning: " + page_text(warning) + "</p>\n";
  html += *pictures + charts_html(outcome.fit);
  if (comparison) html += comparison_html(*comparison);
  return html + "</body>\n</html>\n";
}

}  // namespace contrejour::cli
