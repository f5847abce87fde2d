// SPDX-License-Identifier: Apache-2.0
#include "cli/light_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "contrejour/expert/settings.h"
#include "contrejour/expert/svg.h"

namespace contrejour::cli {
namespace {

constexpr double kChartRadius = 270.0, kChartTop = 56.0, kChartMargin = 40.0, kLegendWidth = 180.0;
constexpr Vec2 kChartCentre{kChartMargin + kChartRadius, kChartTop + kChartRadius};
constexpr double kChartWidth = 2.0 * (kChartMargin + kChartRadius) + kLegendWidth;
constexpr double kChartHeight = kChartTop + 2.0 * kChartRadius + kChartMargin;
constexpr const char* kChartText = R"(font-family="sans-serif" font-size="12" fill="#222")";
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kRings = 5, kOutlinePoints = 80;

// Colours from safe to worst; the first two are those of safe positions.
constexpr std::array<std::array<int, 3>, 5> kChartColours{
    {{26, 122, 62}, {148, 203, 110}, {255, 236, 140}, {240, 130, 50}, {165, 20, 30}}};

// Between the first two colours up to the safe limit, among the others beyond it, so that the limit shows. Cells have a
// border of their colour, because viewers leave seams between them.
std::string chart_colour(double in_range, double safe) {
  const bool is_safe = in_range <= safe;
  const double part = is_safe ? in_range / std::max(safe, 1e-9) : (in_range - safe) / std::max(1.0 - safe, 1e-9);
  const double at = is_safe ? std::clamp(part, 0.0, 1.0) : 2.0 + 2.0 * std::clamp(part, 0.0, 1.0);
  const auto low = is_safe ? std::size_t{0} : std::min(static_cast<std::size_t>(at), kChartColours.size() - 2);
  std::array<int, 3> rgb;
  for (std::size_t c = 0; c < 3; ++c) {
    const double between = at - static_cast<double>(low);
    rgb[c] =
        static_cast<int>(std::lround(kChartColours[low][c] * (1.0 - between) + kChartColours[low + 1][c] * between));
  }
  const std::string colour = fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
  return fmt::format("fill=\"{0}\" stroke=\"{0}\" stroke-width=\"0.6\"", colour);
}

// A point of the chart: the distance from its centre is the angle from the axis.
Vec2 chart_point(const LightMap& map, double angle_rad, double direction_rad) {
  const double radius = kChartRadius * angle_rad / map.to_rad;
  return kChartCentre + Vec2{radius * std::cos(direction_rad), -radius * std::sin(direction_rad)};
}

// The part of the chart that a point of the map stands for: half a step to each side.
std::string sector_path(const LightMap& map, double angle_rad, double direction_rad, double half_turn) {
  const double half = 0.5 * map.to_rad / (map.angles - 1);
  const double inner = std::max(angle_rad - half, 0.0), outer = std::min(angle_rad + half, map.to_rad);
  const auto at = [&](double angle, double turn) {
    const Vec2 p = chart_point(map, angle, direction_rad + turn);
    return fmt::format("{:.2f},{:.2f}", p.x, p.y);
  };
  const auto arc = [&](double angle, int sweep) {
    const double radius = kChartRadius * angle / map.to_rad;
    return fmt::format("A{0:.2f},{0:.2f} 0 0 {1} ", radius, sweep);
  };
  return fmt::format("M{} {}{} L{} {}{} Z", at(outer, -half_turn), arc(outer, 0), at(outer, half_turn),
                     at(inner, half_turn), arc(inner, 1), at(inner, -half_turn));
}

// All directions that a point of the map stands for by symmetry.
std::vector<double> directions_of(const LightMap& map, double direction_rad) {
  if (!map.is_quarter) return {direction_rad};
  return {direction_rad, 0.5 * kTurn - direction_rad, 0.5 * kTurn + direction_rad, -direction_rad};
}

void draw_cells(Svg& svg, const LightChart& chart, const std::vector<double>& values) {
  const LightMap& map = *chart.map;
  const double step = map.is_quarter ? 0.25 * kTurn / (map.directions - 1) : kTurn / map.directions;
  for (std::size_t k = 1; k < map.points.size(); ++k) {
    const std::string style = chart_colour(rating_of(values[k], values)->in_range, chart.safe);
    for (const double direction : directions_of(map, map.points[k].direction_rad))
      svg.path(sector_path(map, map.points[k].angle_rad, direction, 0.5 * step), style);
  }
  const double half = 0.5 * kChartRadius / (map.angles - 1);
  svg.circle(kChartCentre, half, chart_colour(rating_of(values[0], values)->in_range, chart.safe));
}

void draw_rings(Svg& svg, const LightMap& map) {
  for (int k = 1; k <= kRings; ++k) {
    const double angle_rad = map.to_rad * k / kRings;
    svg.circle(kChartCentre, kChartRadius * k / kRings, R"(fill="none" stroke="#0004" stroke-width="0.7")");
    svg.text(chart_point(map, angle_rad, 0.0) + Vec2{-2.0, -3.0},
             fmt::format("{:.1f}\xC2\xB0", angle_rad / params::kDegree_rad),
             std::string(kChartText) + R"( text-anchor="end")");
  }
}

// The picture's frame: lights inside it are in the picture.
void draw_field(Svg& svg, const LightChart& chart) {
  std::vector<Vec2> outline;
  const auto add = [&](double x, double y) {
    const double angle = std::min(std::atan(std::hypot(x, y)), chart.map->to_rad);
    outline.push_back(chart_point(*chart.map, angle, std::atan2(y, x)));
  };
  const Vec2 half = chart.half_field;
  const auto side = [&](Vec2 from, Vec2 to) {
    for (int k = 0; k < kOutlinePoints; ++k) {
      const double t = static_cast<double>(k) / kOutlinePoints;
      add(from.x + t * (to.x - from.x), from.y + t * (to.y - from.y));
    }
  };
  side({-half.x, -half.y}, {half.x, -half.y});
  side({half.x, -half.y}, {half.x, half.y});
  side({half.x, half.y}, {-half.x, half.y});
  side({-half.x, half.y}, {-half.x, -half.y});
  outline.push_back(outline.front());
  svg.polyline(outline, R"(stroke="#fff" stroke-width="3.5" stroke-opacity="0.7")");
  svg.polyline(outline, R"(stroke="#111" stroke-width="1.5" stroke-dasharray="6 4")");
}

void draw_lights(Svg& svg, const LightChart& chart) {
  for (std::size_t k = 0; k < chart.lights.size(); ++k) {
    const Vec3 d = chart.lights[k].direction;
    const double angle = std::atan2(std::hypot(d.x, d.y), d.z);
    if (angle > chart.map->to_rad) continue;
    const Vec2 at = chart_point(*chart.map, angle, std::atan2(-d.y, -d.x));
    svg.circle(at, 5.0, R"(fill="#fff" stroke="#000" stroke-width="1.5")");
    svg.text(at + Vec2{8.0, 4.0}, fmt::format("{}", k + 1), std::string(kChartText) + R"( font-weight="bold")");
  }
}

void draw_legend(Svg& svg, const LightChart& chart, const std::vector<double>& values) {
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  const double left = kChartWidth - kLegendWidth + 10.0, height = 220.0, top = kChartCentre.y - 0.5 * height;
  constexpr int kSteps = 60;
  for (int k = 0; k < kSteps; ++k) {
    const double in_range = 1.0 - (k + 0.5) / kSteps;
    svg.rectangle({left, top + height * k / kSteps}, {18.0, height / kSteps + 0.5}, chart_colour(in_range, chart.safe));
  }
  const auto label = [&](double in_range, const char* word) {
    const double y = top + height * (1.0 - in_range);
    svg.line({left, y}, {left + 24.0, y}, R"(stroke="#222" stroke-width="1")");
    svg.text({left + 28.0, y + 4.0}, fmt::format("{:.3g} {}", *smallest + in_range * (*largest - *smallest), word),
             kChartText);
  };
  label(1.0, "worst");
  label(chart.safe, "safe");
  label(0.0, "");
  svg.text({left, top - 14.0}, std::string(kEstimatorNames[static_cast<std::size_t>(chart.estimator)]), kChartText);
  svg.text({left, top + height + 26.0}, "dashed: the picture", kChartText);
}

}  // namespace

std::string light_chart(const LightChart& chart) {
  const std::vector<double> values = values_of(*chart.map, chart.estimator);
  Svg svg(kChartWidth, kChartHeight);
  svg.rectangle({0.0, 0.0}, {kChartWidth, kChartHeight}, R"(fill="#fff")");
  svg.text({kChartMargin, 28.0}, chart.title, R"(font-family="sans-serif" font-size="16" fill="#111")");
  draw_cells(svg, chart, values);
  draw_rings(svg, *chart.map);
  draw_field(svg, chart);
  draw_lights(svg, chart);
  draw_legend(svg, chart, values);
  return svg.finish();
}

}  // namespace contrejour::cli
