// SPDX-License-Identifier: Apache-2.0
#include "cli/line_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include "contrejour/expert/svg.h"

namespace contrejour::cli {
namespace {

constexpr double kCurvesWidth = 760.0, kCurvesHeight = 400.0;
constexpr double kCurvesLeft = 84.0, kCurvesRight = 172.0, kCurvesTop = 44.0, kCurvesBottom = 56.0;
constexpr std::array kCurvesColours{"#2f6fb0", "#c2402f", "#2c9a5b", "#d08a1e", "#7a4fa3",
                                    "#111111", "#17a2b8", "#b0578d", "#7f8c3a", "#8a97a3"};
constexpr const char* kCurvesText = R"(font-size="12" fill="#333")";
constexpr int kMostLegend = 18;

// One axis: its range, and how it is divided.
class ChartAxis {
 public:
  ChartAxis(double low, double high, bool logarithmic) : log_(logarithmic) {
    if (!(low <= high)) low = logarithmic ? 1.0 : 0.0, high = logarithmic ? 10.0 : 1.0;
    if (log_) {
      low_ = std::floor(std::log10(low) + 1e-9);
      high_ = std::max(std::ceil(std::log10(high) - 1e-9), low_ + 1.0);
      step_ = std::max(1.0, std::ceil((high_ - low_) / 8.0));
      return;
    }
    if (low == high) low -= 0.5, high += 0.5;
    const double fifth = (high - low) / 5.0, decade = std::pow(10.0, std::floor(std::log10(fifth)));
    step_ = 10.0 * decade;
    for (const double factor : {5.0, 2.0, 1.0}) step_ = factor * decade >= fifth ? factor * decade : step_;
    low_ = step_ * std::floor(low / step_ + 1e-9);
    high_ = step_ * std::ceil(high / step_ - 1e-9);
  }

  // From 0 to 1.
  [[nodiscard]] double at(double value) const { return ((log_ ? std::log10(value) : value) - low_) / (high_ - low_); }
  [[nodiscard]] bool shows(double value) const { return std::isfinite(value) && (!log_ || value > 0.0); }
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> all;
    for (int k = 0; low_ + k * step_ <= high_ + 1e-6 * step_; ++k) {
      const double tick = low_ + k * step_;
      all.push_back(log_ ? std::pow(10.0, tick) : std::abs(tick) < 1e-9 * step_ ? 0.0 : tick);
    }
    return all;
  }

 private:
  bool log_ = false;
  double low_ = 0, high_ = 1, step_ = 1;
};

ChartAxis axis_of(const LineChart& chart, bool is_x) {
  const bool logarithmic = is_x ? chart.log_x : chart.log_y;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ChartCurve& curve : chart.curves) {
    for (const Vec2 p : curve.points) {
      const double value = is_x ? p.x : p.y;
      if (!std::isfinite(p.x + p.y) || (logarithmic && !(value > 0.0))) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  return {low, high, logarithmic};
}

struct ChartAxes {
  ChartAxis x, y;

  [[nodiscard]] Vec2 at(double u, double v) const {  // from 0 to 1
    return {kCurvesLeft + u * (kCurvesWidth - kCurvesLeft - kCurvesRight),
            kCurvesHeight - kCurvesBottom - v * (kCurvesHeight - kCurvesTop - kCurvesBottom)};
  }
};

void draw_grid(Svg& svg, const ChartAxes& axes, const LineChart& chart) {
  constexpr const char* kGridStyle = R"(stroke="#ddd" stroke-width="1")";
  const std::string text = kCurvesText;
  for (const double tick : axes.x.ticks()) {
    svg.line(axes.at(axes.x.at(tick), 0.0), axes.at(axes.x.at(tick), 1.0), kGridStyle);
    svg.text(axes.at(axes.x.at(tick), 0.0) + Vec2{0.0, 18.0}, fmt::format("{:.4g}", tick),
             text + R"( text-anchor="middle")");
  }
  for (const double tick : axes.y.ticks()) {
    svg.line(axes.at(0.0, axes.y.at(tick)), axes.at(1.0, axes.y.at(tick)), kGridStyle);
    svg.text(axes.at(0.0, axes.y.at(tick)) + Vec2{-8.0, 4.0}, fmt::format("{:.4g}", tick),
             text + R"( text-anchor="end")");
  }
  svg.text({kCurvesLeft, 24.0}, chart.title, R"(font-size="15" fill="#111")");
  svg.text(axes.at(0.5, 0.0) + Vec2{0.0, 42.0}, chart.x_label, text + R"( text-anchor="middle")");
  const Vec2 middle = axes.at(0.0, 0.5);
  svg.text({18.0, middle.y}, chart.y_label,
           text + fmt::format(R"-( text-anchor="middle" transform="rotate(-90 18 {:.1f})")-", middle.y));
}

void draw_curve(Svg& svg, const ChartAxes& axes, const ChartCurve& curve, const std::string& colour) {
  std::vector<Vec2> line;
  for (const Vec2 p : curve.points)
    if (axes.x.shows(p.x) && axes.y.shows(p.y)) line.push_back(axes.at(axes.x.at(p.x), axes.y.at(p.y)));
  if (!curve.marks) return svg.polyline(line, fmt::format("stroke=\"{}\" stroke-width=\"1.8\"", colour));
  for (const Vec2 p : line) svg.circle(p, 3.0, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\"", colour));
}

void draw_legend(Svg& svg, const ChartCurve& curve, const std::string& colour, int row) {
  const Vec2 from{kCurvesWidth - kCurvesRight + 14.0, kCurvesTop + 18.0 * row + 8.0}, to = from + Vec2{20.0, 0.0};
  if (curve.marks) {
    svg.circle((from + to) * 0.5, 3.0, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\"", colour));
  } else {
    svg.line(from, to, fmt::format("stroke=\"{}\" stroke-width=\"1.8\"", colour));
  }
  svg.text(to + Vec2{8.0, 4.0}, curve.name, kCurvesText);
}

}  // namespace

std::string line_chart(const LineChart& chart) {
  const ChartAxes axes{axis_of(chart, true), axis_of(chart, false)};
  Svg svg(kCurvesWidth, kCurvesHeight);
  svg.rectangle({0.0, 0.0}, {kCurvesWidth, kCurvesHeight}, R"(fill="#fff")");
  draw_grid(svg, axes, chart);
  int row = 0;
  for (std::size_t k = 0; k < chart.curves.size(); ++k) {
    const std::string colour = kCurvesColours[k % kCurvesColours.size()];
    draw_curve(svg, axes, chart.curves[k], colour);
    if (!chart.curves[k].name.empty() && row < kMostLegend) draw_legend(svg, chart.curves[k], colour, row++);
  }
  return svg.finish();
}

}  // namespace contrejour::cli
