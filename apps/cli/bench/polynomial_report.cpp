// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <functional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "cli/bench/polynomial_fits.h"
#include "cli/bench/report.h"
#include "cli/bench/thesis_figures.h"
#include "cli/csv_text.h"
#include "cli/line_chart.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

struct TableTitle {
  std::string_view table, title;
};
constexpr TableTitle kFitTitles[] = {
    {"dense", "Dense polynomials of degree 10 (5.3.1)"},
    {"algorithms", "100 of 1001 terms (5.3.2, figures 5.7 and 5.8)"},
    {"annealing", "Annealing by samples and iterations (5.3.2, figure 5.9)"},
    {"variation", "Annealing with other seeds (5.3.2, figure 5.10)"},
    {"unfitted", "Annealing without a fit in each step (5.3.2)"},
    {"zones", "Few terms in zones of the field (Bodonyi, Csoba and Kunkli 2025), and the whole-field fit"},
};

std::string count_text(int count) { return count > 0 ? fmt::format("{}", count) : ""; }
std::string error_text(double error) { return fmt::format("{:.4g}", error); }
std::string seconds_text(double seconds) { return fmt::format("{:.{}f}", seconds, seconds < 10.0 ? 2 : 0); }

template <class Format>
std::string optional_text(const std::optional<double>& value, const Format& format) {
  return value ? format(*value) : "";
}

std::string table_text(const PolynomialFits& fits, const TableTitle& title) {
  TextTable table(
      {"<fit", "terms", "samples", "steps", "error", "unseen", "processor s", "thesis error", "thesis s", "<"});
  bool any = false;
  for (const PolynomialRow& row : fits.rows) {
    if (row.table != title.table) continue;
    any = true;
    table.add({row.fit, count_text(row.terms), count_text(row.samples), count_text(row.iterations),
               error_text(row.error), row.unseen > 0.0 ? error_text(row.unseen) : "", seconds_text(row.seconds),
               optional_text(row.thesis_error, error_text), optional_text(row.thesis_seconds, seconds_text), row.note});
  }
  return any ? fmt::format("\n{}\n{}", title.title, table.text()) : "";
}

using AxisValue = std::function<double(const published::CurvePoint&)>;

ChartCurve curve_of(const PolynomialCurve& curve, const AxisValue& x, const AxisValue& y) {
  ChartCurve drawn{curve.name, {}};
  for (const auto& point : curve.points) drawn.points.push_back({x(point), y(point)});
  return drawn;
}

// A level of the thesis, as a mark at its time or its number of steps.
ChartCurve thesis_mark(std::string name, double x, double error) { return {std::move(name), {{x, error}}, true}; }

double step_of(const published::CurvePoint& point) { return point.step; }
double seconds_of(const published::CurvePoint& point) { return point.seconds; }
double error_of(const published::CurvePoint& point) { return point.error; }
double best_of(const published::CurvePoint& point) { return point.best; }

LineChart chart_of(const PolynomialFits& fits, std::string_view plot, const AxisValue& x, const AxisValue& y) {
  LineChart chart;
  for (const PolynomialCurve& curve : fits.curves)
    if (curve.plot == plot)
      chart.curves.push_back(curve.line.empty() ? curve_of(curve, x, y) : ChartCurve{curve.name, curve.line});
  return chart;
}

}  // namespace

std::string polynomial_fits_text(const PolynomialFits& fits) {
  if (fits.rows.empty()) return "";
  std::string text =
      "Errors are root mean squares, in units of the thesis's scene; its times are those of a Core i7-8700K\nwith up "
      "to six threads, ours processor time.\n";
  for (const TableTitle& title : kFitTitles) text += table_text(fits, title);
  return text;
}

Json polynomial_fits_json(const PolynomialFits& fits) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  Json rows = Json::array(), curves = Json::array();
  for (const PolynomialRow& row : fits.rows)
    rows.push_back({{"table", row.table},
                    {"fit", row.fit},
                    {"terms", row.terms},
                    {"samples", row.samples},
                    {"steps", row.iterations},
                    {"error", row.error},
                    {"unseen_error", row.unseen},
                    {"seconds", row.seconds},
                    {"thesis_error", number(row.thesis_error)},
                    {"thesis_seconds", number(row.thesis_seconds)},
                    {"note", row.note}});
  for (const PolynomialCurve& curve : fits.curves) {
    Json points = Json::array();
    for (const auto& p : curve.points) points.push_back({p.step, p.seconds, p.error, p.best});
    for (const Vec2 p : curve.line) points.push_back({p.x, p.y});
    const char* columns = curve.line.empty() ? "step_seconds_error_best" : "x_y";
    curves.push_back({{"plot", curve.plot}, {"name", curve.name}, {columns, std::move(points)}});
  }
  return {{"machine", machine_text()}, {"rows", std::move(rows)}, {"curves", std::move(curves)}};
}

std::string polynomial_fits_csv(const PolynomialFits& fits) {
  std::string csv = "table,fit,terms,samples,steps,error,unseen_error,seconds,thesis_error,thesis_seconds,note\n";
  const auto number = [](double value) { return fmt::format("{:.6g}", value); };
  for (const PolynomialRow& row : fits.rows)
    csv += fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{},{}\n", row.table, csv_text(row.fit), row.terms,
                       row.samples, row.iterations, row.error, row.unseen, row.seconds,
                       optional_text(row.thesis_error, number), optional_text(row.thesis_seconds, number),
                       csv_text(row.note));
  return csv;
}

std::vector<PolynomialPlot> polynomial_plots(const PolynomialFits& fits) {
  std::vector<PolynomialPlot> plots;
  const auto add = [&](std::string name, LineChart chart, std::string title, std::string x, std::string y) {
    if (chart.curves.empty()) return;
    chart.title = std::move(title), chart.x_label = std::move(x), chart.y_label = std::move(y);
    chart.log_y = true;
    plots.push_back({std::move(name), line_chart(chart)});
  };
  const std::string rms = "RMS error, scene units";
  LineChart steps = chart_of(fits, "convergence", step_of, error_of);
  steps.log_x = true;
  add("convergence", std::move(steps), "Errors by steps (figure 5.7)", "steps", rms);
  LineChart times = chart_of(fits, "convergence", seconds_of, best_of);
  if (!times.curves.empty()) {
    times.curves.push_back(thesis_mark("thesis, omp", thesis::kPursuit.seconds, thesis::kPursuit.error));
    times.curves.push_back(thesis_mark("thesis, replaced", thesis::kReplacement.seconds, thesis::kReplacement.error));
    times.curves.push_back(thesis_mark("thesis, annealing", thesis::kAnnealing.seconds, thesis::kAnnealing.error));
    times.log_x = true;
  }
  add("times", std::move(times), "Lowest errors by time (figure 5.8)", "seconds", rms);
  LineChart annealing = chart_of(fits, "annealing", step_of, error_of);
  if (!annealing.curves.empty()) {
    ChartCurve marks{"thesis", {}, true};
    for (const auto& figure : thesis::kAnnealingTable)
      marks.points.push_back({static_cast<double>(figure.iterations), figure.error});
    annealing.curves.push_back(std::move(marks));
  }
  add("annealing", std::move(annealing), "Annealing, samples x iterations (figure 5.9)", "iterations", rms);
  LineChart variation = chart_of(fits, "variation", step_of, error_of);
  for (ChartCurve& curve : variation.curves) {
    curve.marks = true;
    const Vec2 first{curve.points.front().x, thesis::kVariationMean}, last{curve.points.back().x, first.y};
    variation.curves.push_back({"thesis, mean", {first, last}});
    break;
  }
  add("variation", std::move(variation), "Annealing, other seeds (figure 5.10)", "run", rms);
  add("overview", chart_of(fits, "overview", step_of, error_of), "Errors of dense polynomials (figure 5.6)",
      "direction dx at dy = 0.15", "error, scene units");
  LineChart orthogonality = chart_of(fits, "orthogonality", step_of, error_of);
  orthogonality.log_x = true;
  add("orthogonality", std::move(orthogonality), "Legendre polynomials on grids (figure 3.3)", "points of the grid",
      "sum of errors of all products");
  add("zones", chart_of(fits, "zones", step_of, best_of), "Few terms in zones of the field", "steps",
      "RMS error, pixels");
  return plots;
}

}  // namespace contrejour::cli
