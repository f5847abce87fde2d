// SPDX-License-Identifier: Apache-2.0
#include "cli/reflectance_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "cli/reflected_colour.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/svg.h"

namespace contrejour::cli {
namespace {

constexpr double kPlotWidth = 760.0, kPlotHeight = 460.0;
constexpr double kPlotLeft = 64.0, kPlotRight = 96.0, kPlotTop = 44.0, kPlotBottom = 64.0, kSpectrumHeight = 8.0;
constexpr double kPlotFirst_nm = 380.0, kPlotLast_nm = 780.0, kPlotStep_nm = 2.0;
constexpr std::array kPlotAngles_deg{0, 15, 30, 45, 60};
constexpr std::array kCurveColours{"#111111", "#2f6fb0", "#2c9a5b", "#d08a1e", "#c2402f"};
constexpr const char* kPlotLabelStyle = R"(font-family="sans-serif" font-size="12" fill="#333")";

// The spacing of about five ticks up to `max`: 1, 2 or 5 times a power of ten.
double tick_spacing(double max) {
  const double fifth = max / 5.0, decade = std::pow(10.0, std::floor(std::log10(fifth)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= fifth) return factor * decade;
  return 10.0 * decade;
}

class ReflectanceAxes {
 public:
  explicit ReflectanceAxes(double max_percent)
      : tick_(tick_spacing(max_percent)), max_(tick_ * std::ceil(max_percent / tick_)) {}

  [[nodiscard]] double tick() const { return tick_; }
  [[nodiscard]] double max() const { return max_; }
  [[nodiscard]] Vec2 at(double nm, double percent) const {
    return {kPlotLeft + (kPlotWidth - kPlotLeft - kPlotRight) * (nm - kPlotFirst_nm) / (kPlotLast_nm - kPlotFirst_nm),
            kPlotHeight - kPlotBottom - (kPlotHeight - kPlotTop - kPlotBottom) * percent / max_};
  }

 private:
  double tick_, max_;
};

void draw_axes(Svg& svg, const ReflectanceAxes& plot) {
  constexpr const char* kGrid = R"(stroke="#ddd" stroke-width="1")";
  for (double v = 0.0; v <= plot.max() * 1.0001; v += plot.tick()) {
    svg.line(plot.at(kPlotFirst_nm, v), plot.at(kPlotLast_nm, v), kGrid);
    svg.text(plot.at(kPlotFirst_nm, v) + Vec2{-8.0, 4.0}, fmt::format("{:g} %", v),
             std::string(kPlotLabelStyle) + R"( text-anchor="end")");
  }
  for (double nm = 400.0; nm < kPlotLast_nm; nm += 50.0) {
    svg.line(plot.at(nm, 0.0), plot.at(nm, plot.max()), kGrid);
    svg.text(plot.at(nm, 0.0) + Vec2{0.0, 30.0}, fmt::format("{:g}", nm),
             std::string(kPlotLabelStyle) + R"( text-anchor="middle")");
  }
  svg.text({kPlotLeft + 0.5 * (kPlotWidth - kPlotLeft - kPlotRight), kPlotHeight - 12.0}, "wavelength, nm",
           std::string(kPlotLabelStyle) + R"( text-anchor="middle")");
}

// The colours of the spectrum, below the axis.
void draw_spectrum(Svg& svg, const ReflectanceAxes& plot) {
  const double width = plot.at(kPlotFirst_nm + kPlotStep_nm, 0.0).x - plot.at(kPlotFirst_nm, 0.0).x;
  for (double nm = kPlotFirst_nm; nm < kPlotLast_nm; nm += kPlotStep_nm) {
    svg.rectangle(plot.at(nm, 0.0) + Vec2{0.0, 4.0}, {width + 0.3, kSpectrumHeight},
                  fmt::format("fill=\"{}\"", srgb_text(colour_matching(nm + 0.5 * kPlotStep_nm))));
  }
}

}  // namespace

std::string reflectance_plot(const Coating& coating, const Glass& glass, const std::string& title) {
  std::array<std::vector<double>, kPlotAngles_deg.size()> percent;
  double max_percent = 0.0;
  for (std::size_t a = 0; a < kPlotAngles_deg.size(); ++a) {
    const double cos_in = std::cos(kPlotAngles_deg[a] * std::numbers::pi / 180.0);
    for (double nm = kPlotFirst_nm; nm <= kPlotLast_nm; nm += kPlotStep_nm) {
      percent[a].push_back(100.0 *
                           reflectance(at_wavelength(coating, nm), 1.0, refractive_index(glass, nm), cos_in, nm));
      max_percent = std::max(max_percent, percent[a].back());
    }
  }
  const ReflectanceAxes plot(std::max(max_percent, 0.01));
  Svg svg(kPlotWidth, kPlotHeight);
  svg.rectangle({0.0, 0.0}, {kPlotWidth, kPlotHeight}, R"(fill="#fff")");
  svg.text({kPlotLeft, 26.0}, title, R"(font-family="sans-serif" font-size="15" fill="#111")");
  draw_axes(svg, plot);
  draw_spectrum(svg, plot);
  for (std::size_t a = 0; a < kPlotAngles_deg.size(); ++a) {
    std::vector<Vec2> line;
    for (std::size_t k = 0; k < percent[a].size(); ++k)
      line.push_back(plot.at(kPlotFirst_nm + kPlotStep_nm * static_cast<double>(k), percent[a][k]));
    svg.polyline(line, fmt::format("stroke=\"{}\" stroke-width=\"2\"", kCurveColours[a]));
    const double y = kPlotTop + 18.0 * static_cast<double>(a + 1);
    svg.line({kPlotWidth - kPlotRight + 14.0, y}, {kPlotWidth - kPlotRight + 38.0, y},
             fmt::format("stroke=\"{}\" stroke-width=\"2\"", kCurveColours[a]));
    svg.text({kPlotWidth - kPlotRight + 46.0, y + 4.0}, fmt::format("{}\xC2\xB0", kPlotAngles_deg[a]), kPlotLabelStyle);
  }
  return svg.finish();
}

}  // namespace contrejour::cli
