// SPDX-License-Identifier: Apache-2.0
#include "cli/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include "contrejour/expert/svg.h"

namespace contrejour::cli {
namespace {

constexpr double kMapLeft = 84.0, kMapRight = 116.0, kMapTop = 64.0, kMapBottom = 56.0;
constexpr double kRowHeight = 14.0, kMinColumnWidth = 34.0, kMinMapWidth = 420.0;
constexpr double kDecades = 5.0;  // the range of the colours, below the largest value
constexpr const char* kLabelStyle = R"(fill="#26323d" font-size="11")";
constexpr const char* kZeroColour = "#101014";  // no light reaches the sensor

// From dark to bright in perceptually even steps: matplotlib's "inferno", every eighth of it.
constexpr std::array<std::array<double, 3>, 9> kInferno{{{0, 0, 4},
                                                         {31, 12, 72},
                                                         {85, 15, 109},
                                                         {136, 34, 106},
                                                         {186, 54, 85},
                                                         {227, 89, 51},
                                                         {249, 140, 10},
                                                         {249, 201, 50},
                                                         {252, 255, 164}}};

std::string colour_at(double t) {
  const double position = std::clamp(t, 0.0, 1.0) * (kInferno.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(position), kInferno.size() - 2);
  std::array<int, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c)
    rgb[c] =
        static_cast<int>(std::lround(std::lerp(kInferno[k][c], kInferno[k + 1][c], position - static_cast<double>(k))));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

class HeatMap {
 public:
  HeatMap(const GhostSweep& sweep, SweepQuantity quantity) : sweep_(sweep), quantity_(quantity) {
    rows_ = std::min(sweep.ghosts.size(), kMaxHeatMapRows);
    const auto columns = static_cast<double>(sweep.value.size());
    column_ = std::max(kMinColumnWidth, kMinMapWidth / columns);
    width_ = kMapLeft + column_ * columns + kMapRight;
    height_ = std::max(kMapTop + kRowHeight * static_cast<double>(rows_), kMapTop + 180.0) + kMapBottom;
    for (std::size_t row = 0; row < rows_; ++row)
      for (const double value : quantity_of(sweep.ghosts[row], quantity)) largest_ = std::max(largest_, value);
  }

  [[nodiscard]] std::string draw() const {
    Svg svg(width_, height_);
    svg.rectangle({0, 0}, {width_, height_}, R"(fill="#ffffff")");
    draw_title(svg);
    for (std::size_t row = 0; row < rows_; ++row) draw_row(svg, row);
    draw_axis(svg);
    draw_scale(svg);
    return svg.finish();
  }

 private:
  [[nodiscard]] Vec2 corner(std::size_t row, std::size_t column) const {
    return {kMapLeft + column_ * static_cast<double>(column), kMapTop + kRowHeight * static_cast<double>(row)};
  }
  [[nodiscard]] std::string fill_of(double value) const {
    if (!(value > 0.0)) return kZeroColour;
    return colour_at(1.0 + std::log10(value / largest_) / kDecades);
  }

  void draw_title(Svg& svg) const {
    svg.text({kMapLeft, 26}, sweep_.lens, R"(font-size="16" font-weight="bold" fill="#26323d")");
    const std::string what = quantity_ == SweepQuantity::Flux ? "flux relative to the direct image"
                                                              : "peak irradiance relative to the front of the lens";
    const std::string of = rows_ < sweep_.ghosts.size()
                               ? fmt::format(", the worst {} of {} ghosts", rows_, sweep_.ghosts.size())
                               : fmt::format(", {} ghosts", rows_);
    svg.text({kMapLeft, 46}, what + of, R"(font-size="12" fill="#5c6873")");
  }

  void draw_row(Svg& svg, std::size_t row) const {
    const SweptGhost& ghost = sweep_.ghosts[row];
    const auto& values = quantity_of(ghost, quantity_);
    const std::size_t worst = worst_step(ghost, quantity_);
    svg.text(corner(row, 0) + Vec2{-8.0, kRowHeight - 3.0}, ghost_name(ghost.ghost),
             std::string(kLabelStyle) + R"( text-anchor="end")");
    for (std::size_t k = 0; k < values.size(); ++k)
      svg.rectangle(corner(row, k), {column_ + 0.2, kRowHeight + 0.2}, fmt::format("fill=\"{}\"", fill_of(values[k])));
    if (values[worst] > 0.0)
      svg.circle(corner(row, worst) + Vec2{0.5 * column_, 0.5 * kRowHeight}, 2.2,
                 R"(fill="#ffffff" stroke="#26323d" stroke-width="0.7")");
  }

  void draw_axis(Svg& svg) const {
    const double y = corner(rows_, 0).y;
    for (std::size_t k = 0; k < sweep_.value.size(); ++k)
      svg.text({corner(0, k).x + 0.5 * column_, y + 16.0}, fmt::format("{:.3g}", sweep_.value[k]),
               std::string(kLabelStyle) + R"( text-anchor="middle")");
    svg.text({kMapLeft + 0.5 * column_ * static_cast<double>(sweep_.value.size()), y + 36.0}, axis_name(sweep_.axis),
             R"(fill="#26323d" font-size="12" text-anchor="middle")");
  }

  // A logarithmic colour scale with the largest value at the top.
  void draw_scale(Svg& svg) const {
    constexpr double kHeight = 160.0, kBarWidth = 14.0;
    constexpr int kPieces = 64;
    const double x = width_ - kMapRight + 24.0;
    for (int k = 0; k < kPieces; ++k)
      svg.rectangle({x, kMapTop + kHeight * k / kPieces}, {kBarWidth, kHeight / kPieces + 0.3},
                    fmt::format("fill=\"{}\"", colour_at(1.0 - (k + 0.5) / kPieces)));
    for (int decade = 0; decade <= static_cast<int>(kDecades); ++decade)
      svg.text({x + kBarWidth + 6.0, kMapTop + kHeight * decade / kDecades + 4.0},
               fmt::format("{:.2g}", largest_ * std::pow(10.0, -decade)), kLabelStyle);
    svg.circle({x + 0.5 * kBarWidth, kMapTop + kHeight + 20.0}, 2.2,
               R"(fill="#ffffff" stroke="#26323d" stroke-width="0.7")");
    svg.text({x + kBarWidth + 6.0, kMapTop + kHeight + 24.0}, "worst", kLabelStyle);
  }

  const GhostSweep& sweep_;
  SweepQuantity quantity_;
  std::size_t rows_ = 0;
  double column_ = kMinColumnWidth, width_ = 0.0, height_ = 0.0, largest_ = 0.0;
};

}  // namespace

std::string heat_map(const GhostSweep& sweep, SweepQuantity quantity) { return HeatMap(sweep, quantity).draw(); }

}  // namespace contrejour::cli
