// SPDX-License-Identifier: Apache-2.0
// The words and numbers of a drawn section, and its scale.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "drawing/section_page.h"
#include "drawing/section_shapes.h"

namespace contrejour {
namespace {

constexpr double kLabelGap_px = 19, kLegendColumn_px = 210;

// The ghosts' colours; after the last the first is used again.
constexpr std::array kGhostInks{"#d5482c", "#8e44ad", "#c98a00", "#138d75", "#c2185b", "#6d4c41"};

// Positions that are at least `gap` apart and deviate least from the desired ones: isotonic regression by the pool
// adjacent violators algorithm.
std::vector<double> spaced(const std::vector<double>& desired, double gap) {
  struct Pool {
    double sum = 0;
    int count = 0;
    [[nodiscard]] double mean() const { return sum / count; }
  };
  std::vector<Pool> pools;
  for (std::size_t k = 0; k < desired.size(); ++k) {
    pools.push_back({desired[k] - gap * static_cast<double>(k), 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean() > pools.back().mean()) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back().sum += last.sum;
      pools.back().count += last.count;
    }
  }
  std::vector<double> positions;
  for (const Pool& pool : pools) {
    for (int k = 0; k < pool.count; ++k) positions.push_back(pool.mean() + gap * static_cast<double>(positions.size()));
  }
  return positions;
}

struct SurfaceLabel {
  std::string number;
  Vec2 rim;  // where its line begins
  bool is_stop = false;
  const char* ghost_colour = nullptr;  // null: the surface does not reflect
};

std::vector<SurfaceLabel> labels_of(const SectionPage& page, const LensSection& section) {
  std::vector<SurfaceLabel> labels;
  for (const SurfaceState& s : section.lens.surfaces) {
    const bool is_stop = s.kind == SurfaceKind::Stop;
    const double h = is_stop ? std::max(1.25 * s.semi_diameter_mm, section.lens.stop_radius_mm) : drawn_height_mm(s);
    const int number = static_cast<int>(labels.size()) + 1;
    SurfaceLabel label{fmt::format("{}", number), page.at({s.z_mm + (is_stop ? 0.0 : sag_mm(s, h)), -h}), is_stop};
    const auto ghost = std::ranges::find_if(section.ghosts, [&](const Ghost& g) { return g.reflects_at(number); });
    if (ghost != section.ghosts.end())
      label.ghost_colour =
          style_of(SectionRayKind::Ghost, static_cast<std::size_t>(ghost - section.ghosts.begin())).colour;
    labels.push_back(std::move(label));
  }
  return labels;
}

void draw_label(Svg& svg, const SectionPage& page, const SurfaceLabel& label, Vec2 position) {
  svg.polyline({label.rim, {label.rim.x, page.bottom() + 4}, {position.x, position.y - 12}},
               fmt::format("stroke=\"{}\" stroke-width=\"0.6\" stroke-opacity=\"0.7\"", kPaleInk));
  svg.text(
      position, label.number,
      fmt::format("font-size=\"12\" text-anchor=\"middle\" fill=\"{}\"{}",
                  label.ghost_colour ? label.ghost_colour : kInk, label.ghost_colour ? " font-weight=\"bold\"" : ""));
  if (label.is_stop) {
    svg.text({position.x, position.y + 15}, "stop",
             fmt::format("font-size=\"11\" text-anchor=\"middle\" font-style=\"italic\" fill=\"{}\"", kInk));
  }
}

struct LegendEntry {
  RayStyle style;
  std::string text;
};

std::vector<LegendEntry> legend_of(const LensSection& section) {
  const RayStyle axis = style_of(SectionRayKind::Axis);
  if (section.ghosts.empty()) return {{axis, "axis"}, {style_of(SectionRayKind::Field), "corner of the field"}};
  std::vector<LegendEntry> entries{{axis, fmt::format("image of a light {:.1f}° up", section.ghost_light_deg)}};
  for (std::size_t g = 0; g < section.ghosts.size(); ++g) {
    const auto is_blocked = [&](const SectionRay& ray) {
      return ray.kind == SectionRayKind::Ghost && ray.ghost == g && ray.blocked;
    };
    const bool blocked = std::any_of(section.rays.begin(), section.rays.end(), is_blocked);
    entries.push_back(
        {style_of(SectionRayKind::Ghost, g), "ghost " + ghost_name(section.ghosts[g]) + (blocked ? " (blocked)" : "")});
  }
  return entries;
}

}  // namespace

inline namespace internal {

RayStyle style_of(SectionRayKind kind, std::size_t ghost) {
  switch (kind) {
    case SectionRayKind::Axis: return {"#2f6fb5", 1.1, 0.85};
    case SectionRayKind::Field: return {"#2d8f6a", 1.1, 0.85};
    case SectionRayKind::Ghost: return {kGhostInks[ghost % kGhostInks.size()], 1.2, 0.9};
  }
  return {kInk, 1, 1};
}

void draw_surface_numbers(Svg& svg, const SectionPage& page, const LensSection& section) {
  const std::vector<SurfaceLabel> labels = labels_of(page, section);
  std::vector<double> desired;
  for (const SurfaceLabel& label : labels) desired.push_back(label.rim.x);
  const double gap = std::min(kLabelGap_px, (kPageWidth_px - 2 * kPageMargin_px) / static_cast<double>(labels.size()));
  const std::vector<double> positions = spaced(desired, gap);
  const double label_y = page.bottom() + 30;
  for (std::size_t k = 0; k < labels.size(); ++k) draw_label(svg, page, labels[k], {positions[k], label_y});
  const Vec2 sensor = page.at({section.lens.sensor_z_mm, 0});
  svg.text({sensor.x, label_y}, "sensor",
           fmt::format("font-size=\"11\" text-anchor=\"end\" font-style=\"italic\" fill=\"{}\"", kInk));
}

void draw_legend(Svg& svg, const LensSection& section) {
  double y = 40;
  double right = kPageWidth_px - kPageMargin_px;
  for (const LegendEntry& entry : legend_of(section)) {
    svg.line({right - 28, y - 4}, {right, y - 4},
             fmt::format("stroke=\"{}\" stroke-width=\"2.4\"", entry.style.colour));
    svg.text({right - 36, y}, entry.text, fmt::format("font-size=\"13\" text-anchor=\"end\" fill=\"{}\"", kInk));
    y += 18;
    if (y > kPageTop_px - 4) {  // next column, to the left
      y = 40;
      right -= kLegendColumn_px;
    }
  }
}

// A bar of 1, 2 or 5 times a power of ten, about a tenth of the width.
void draw_scale_bar(Svg& svg, const SectionPage& page) {
  const double desired_mm = 0.1 * kPageWidth_px / page.scale();
  const double decade = std::pow(10.0, std::floor(std::log10(desired_mm)));
  const double mantissa = desired_mm / decade;
  const double length_mm = decade * (mantissa >= 5 ? 5 : mantissa >= 2 ? 2 : 1);
  const Vec2 from{kPageMargin_px, page.height() - 22};
  const Vec2 to{from.x + length_mm * page.scale(), from.y};
  const std::string style = fmt::format("stroke=\"{}\" stroke-width=\"1.4\"", kPaleInk);
  svg.line(from, to, style);
  for (const Vec2 end : {from, to}) svg.line({end.x, end.y - 4}, {end.x, end.y + 4}, style);
  svg.text({to.x + 8, to.y + 4}, fmt::format("{:g} mm", length_mm),
           fmt::format("font-size=\"12\" fill=\"{}\"", kPaleInk));
}

void draw_title(Svg& svg, const LensState& lens) {
  svg.text({kPageMargin_px, 44}, lens.name, fmt::format("font-size=\"22\" font-weight=\"bold\" fill=\"{}\"", kInk));
  svg.text({kPageMargin_px, 66}, fmt::format("{:.1f} mm, f/{:g}", lens.focal_length_mm, lens.f_number),
           fmt::format("font-size=\"14\" fill=\"{}\"", kPaleInk));
}

}  // namespace internal

}  // namespace contrejour
