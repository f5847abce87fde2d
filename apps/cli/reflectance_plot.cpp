// SPDX-License-Identifier: Apache-2.0
#include "cli/reflectance_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "cli/reflected_colour.h"
#include "cli/svg.h"
#include "contrejour/expert/colour.h"

namespace contrejour::cli {
namespace {

constexpr double kWidth = 760.0, kHeight = 460.0;
constexpr double kLeft = 64.0, kRight = 96.0, kTop = 44.0, kBottom = 64.0, kBar = 8.0;
constexpr double kPlotFirst_nm = 380.0, kPlotLast_nm = 780.0, kPlotStep_nm = 2.0;
constexpr std::array kPlotAngles_deg{0, 15, 30, 45, 60};
constexpr std::array kInks{"#111111", "#2f6fb0", "#2c9a5b", "#d08a1e", "#c2402f"};
constexpr const char* kSmall = R"(font-family="sans-serif" font-size="12" fill="#333")";

// 1, 2 or 5 times a power of ten, such that a few ticks reach `most`.
double tick_for(double most) {
  const double rough = most / 5.0, ten = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double times : {1.0, 2.0, 5.0})
    if (times * ten >= rough) return times * ten;
  return 10.0 * ten;
}

class Plot {
 public:
  explicit Plot(double most_percent) : tick_(tick_for(most_percent)), most_(tick_ * std::ceil(most_percent / tick_)) {}

  [[nodiscard]] double tick() const { return tick_; }
  [[nodiscard]] double most() const { return most_; }
  [[nodiscard]] Vec2 at(double nm, double percent) const {
    return {kLeft + (kWidth - kLeft - kRight) * (nm - kPlotFirst_nm) / (kPlotLast_nm - kPlotFirst_nm),
            kHeight - kBottom - (kHeight - kTop - kBottom) * percent / most_};
  }

 private:
  double tick_, most_;
};

void draw_axes(Svg& svg, const Plot& plot) {
  constexpr const char* kGrid = R"(stroke="#ddd" stroke-width="1")";
  for (double v = 0.0; v <= plot.most() * 1.0001; v += plot.tick()) {
    svg.line(plot.at(kPlotFirst_nm, v), plot.at(kPlotLast_nm, v), kGrid);
    svg.text(plot.at(kPlotFirst_nm, v) + Vec2{-8.0, 4.0}, fmt::format("{:g} %", v),
             std::string(kSmall) + R"( text-anchor="end")");
  }
  for (double nm = 400.0; nm < kPlotLast_nm; nm += 50.0) {
    svg.line(plot.at(nm, 0.0), plot.at(nm, plot.most()), kGrid);
    svg.text(plot.at(nm, 0.0) + Vec2{0.0, 30.0}, fmt::format("{:g}", nm),
             std::string(kSmall) + R"( text-anchor="middle")");
  }
  svg.text({kLeft + 0.5 * (kWidth - kLeft - kRight), kHeight - 12.0}, "wavelength, nm",
           std::string(kSmall) + R"( text-anchor="middle")");
}

// The spectrum's colours below the axis, with the eye's relative brightness.
void draw_spectrum(Svg& svg, const Plot& plot) {
  const double width = plot.at(kPlotFirst_nm + kPlotStep_nm, 0.0).x - plot.at(kPlotFirst_nm, 0.0).x;
  for (double nm = kPlotFirst_nm; nm < kPlotLast_nm; nm += kPlotStep_nm) {
    svg.rectangle(plot.at(nm, 0.0) + Vec2{0.0, 4.0}, {width + 0.3, kBar},
                  fmt::format("fill=\"{}\"", shown_as(colour_matching(nm + 0.5 * kPlotStep_nm))));
  }
}

}  // namespace

std::string reflectance_plot(const Coating& coating, const Glass& glass, const std::string& title) {
  std::array<std::vector<double>, kPlotAngles_deg.size()> percent;
  double most = 0.0;
  for (std::size_t a = 0; a < kPlotAngles_deg.size(); ++a) {
    const double cos_in = std::cos(kPlotAngles_deg[a] * std::numbers::pi / 180.0);
    for (double nm = kPlotFirst_nm; nm <= kPlotLast_nm; nm += kPlotStep_nm) {
      percent[a].push_back(100.0 *
                           reflectance(at_wavelength(coating, nm), 1.0, refractive_index(glass, nm), cos_in, nm));
      most = std::max(most, percent[a].back());
    }
  }
  const Plot plot(std::max(most, 0.01));
  Svg svg(kWidth, kHeight);
  svg.rectangle({0.0, 0.0}, {kWidth, kHeight}, R"(fill="#fff")");
  svg.text({kLeft, 26.0}, title, R"(font-family="sans-serif" font-size="15" fill="#111")");
  draw_axes(svg, plot);
  draw_spectrum(svg, plot);
  for (std::size_t a = 0; a < kPlotAngles_deg.size(); ++a) {
    std::vector<Vec2> line;
    for (std::size_t k = 0; k < percent[a].size(); ++k)
      line.push_back(plot.at(kPlotFirst_nm + kPlotStep_nm * static_cast<double>(k), percent[a][k]));
    svg.polyline(line, fmt::format("stroke=\"{}\" stroke-width=\"2\"", kInks[a]));
    const double y = kTop + 18.0 * static_cast<double>(a + 1);
    svg.line({kWidth - kRight + 14.0, y}, {kWidth - kRight + 38.0, y},
             fmt::format("stroke=\"{}\" stroke-width=\"2\"", kInks[a]));
    svg.text({kWidth - kRight + 46.0, y + 4.0}, fmt::format("{}\xC2\xB0", kPlotAngles_deg[a]), kSmall);
  }
  return svg.finish();
}

}  // namespace contrejour::cli
