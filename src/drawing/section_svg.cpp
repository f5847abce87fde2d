// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "contrejour/expert/lens_section.h"
#include "drawing/section_page.h"

namespace contrejour {
namespace {

std::string move_or_line(char verb, Vec2 p) { return fmt::format("{}{:.2f} {:.2f} ", verb, p.x, p.y); }

std::string arc(const SectionPage& page, Vec2 from_mm, const SectionPiece& piece) {
  const Vec2 end = page.at(piece.to_mm);
  const double r = page.scale() / std::abs(piece.curvature_per_mm);
  const bool clockwise = (piece.curvature_per_mm > 0.0) == (from_mm.y < piece.to_mm.y);
  return fmt::format("A{0:.2f} {0:.2f} 0 0 {1} {2:.2f} {3:.2f} ", r, clockwise ? 1 : 0, end.x, end.y);
}

// An element's outline; its last piece closes it.
std::string closed_path(const SectionPage& page, const SectionCurve& curve) {
  std::string d = move_or_line('M', page.at(curve.from_mm));
  Vec2 from_mm = curve.from_mm;
  for (std::size_t k = 0; k + 1 < curve.pieces.size(); ++k) {
    const SectionPiece& piece = curve.pieces[k];
    d += piece.curvature_per_mm == 0.0 ? move_or_line('L', page.at(piece.to_mm)) : arc(page, from_mm, piece);
    from_mm = piece.to_mm;
  }
  return d + "Z";
}

// Crown glasses are pale, dense flints deeper.
std::string glass_colour(double index_d) {
  const double t = std::clamp((index_d - 1.45) / 0.45, 0.0, 1.0);
  const auto mix = [t](int a, int b) { return static_cast<int>(std::lround(a + t * (b - a))); };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(0xe9, 0x9f), mix(0xf3, 0xc0), mix(0xfa, 0xdd));
}

void draw_glass(Svg& svg, const SectionPage& page, const LensSection& section) {
  for (const SectionElement& element : section.elements) {
    svg.path(closed_path(page, element.outline),
             fmt::format("fill=\"{}\" stroke=\"#54697c\" stroke-width=\"1.1\" stroke-linejoin=\"round\"",
                         glass_colour(element.index_d)));
  }
}

void draw_rays(Svg& svg, const SectionPage& page, const LensSection& section) {
  svg.begin_clip({page.left(), kPageTop_px}, {kPageWidth_px - 2 * page.left() + 2, page.bottom() - kPageTop_px});
  for (const SectionRay& ray : section.rays) {
    std::vector<Vec2> points;
    for (const Vec2 p : ray.points_mm) points.push_back(page.at(p));
    const RayStyle style = style_of(ray.kind, ray.ghost);
    svg.polyline(points,
                 fmt::format("stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{}\" stroke-linejoin=\"round\"{}",
                             style.colour, style.width, style.opacity, ray.blocked ? " stroke-dasharray=\"5 4\"" : ""));
    for (const Vec2 p : ray.reflections_mm) svg.circle(page.at(p), 2.4, fmt::format("fill=\"{}\"", style.colour));
  }
  svg.end_clip();
}

void draw_obscurations(Svg& svg, const SectionPage& page, const LensSection& section) {
  for (const SectionCurve& curve : section.obscurations) {
    std::vector<Vec2> points;
    for (const Vec2 p : polyline(curve)) points.push_back(page.at(p));
    svg.polyline(points, fmt::format("stroke=\"{}\" stroke-width=\"3.5\"", kInk));
  }
}

void draw_stop_and_sensor(Svg& svg, const SectionPage& page, const LensSection& section) {
  const auto& [stop_z, opening, blade] = section.stop;
  const double outer = std::max(blade, opening + 10.0 / page.scale());
  for (const double side : {1.0, -1.0}) {
    svg.line(page.at({stop_z, side * opening}), page.at({stop_z, side * outer}),
             fmt::format("stroke=\"{}\" stroke-width=\"3.5\"", kInk));
  }
  const auto& [sensor_z, half] = section.sensor;
  svg.line(page.at({sensor_z, half}), page.at({sensor_z, -half}),
           fmt::format("stroke=\"{}\" stroke-width=\"4\" stroke-linecap=\"round\"", kInk));
}

}  // namespace

std::string section_svg(const LensSection& section) {
  const SectionPage page(section);
  Svg svg(kPageWidth_px, page.height());
  svg.rectangle({0, 0}, {kPageWidth_px, page.height()}, "fill=\"#ffffff\"");
  draw_title(svg, section.lens);
  draw_legend(svg, section);
  draw_glass(svg, page, section);
  const Vec2 axis_left = page.at({section.left_mm, 0});
  const Vec2 axis_right = page.at({section.right_mm, 0});
  svg.line(axis_left, {axis_right.x + 12, axis_right.y},
           fmt::format("stroke=\"{}\" stroke-width=\"0.8\" stroke-dasharray=\"14 4 2 4\"", kPaleInk));
  draw_rays(svg, page, section);
  draw_obscurations(svg, page, section);
  draw_stop_and_sensor(svg, page, section);
  draw_surface_numbers(svg, page, section);
  draw_scale_bar(svg, page);
  return svg.finish();
}

}  // namespace contrejour
