// SPDX-License-Identifier: Apache-2.0
#include "cli/section_svg.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/section_page.h"

namespace contrejour::cli {
namespace {

// A surface that is not a sphere, as straight lines whose deviation is not visible.
std::string curve(const SectionPage& page, const SurfaceState& s, double from) {
  constexpr int kPieces = 64;
  const double h = drawn_height_mm(s);
  std::string d;
  for (int k = 1; k <= kPieces; ++k) {
    const double y = from * h * (1.0 - 2.0 * k / kPieces);
    const Vec2 to = page.at({s.z_mm + sag_mm(s, y), y});
    d += fmt::format("L{:.2f} {:.2f} ", to.x, to.y);
  }
  return d;
}

// The arc of a surface from its rim at `from` (+1 top, -1 bottom) to the other.
std::string arc(const SectionPage& page, const SurfaceState& s, double from) {
  const double h = drawn_height_mm(s);
  const Vec2 end = page.at({s.z_mm + sag_mm(s, h), -from * h});
  if (!s.shape.is_sphere()) return curve(page, s, from);
  if (s.curvature_per_mm == 0.0) return fmt::format("L{:.2f} {:.2f} ", end.x, end.y);
  const double r = page.scale() / std::abs(s.curvature_per_mm);
  const bool clockwise = (s.curvature_per_mm > 0.0) == (from < 0.0);
  return fmt::format("A{0:.2f} {0:.2f} 0 0 {1} {2:.2f} {3:.2f} ", r, clockwise ? 1 : 0, end.x, end.y);
}

std::string move_or_line(char verb, Vec2 p) { return fmt::format("{}{:.2f} {:.2f} ", verb, p.x, p.y); }

// Both faces and the edge between them. Unless the faces cross there, a flat rim at right angles to the axis extends
// the smaller face to the height of the larger, as on a ground lens.
std::string outline(const SectionPage& page, const SurfaceState& front, const SurfaceState& rear) {
  const double front_h = drawn_height_mm(front);
  const double rear_h = drawn_height_mm(rear);
  const double front_z = front.z_mm + sag_mm(front, front_h);
  const double rear_z = rear.z_mm + sag_mm(rear, rear_h);
  const double edge_h = std::max(front_h, rear_h);
  std::string d = move_or_line('M', page.at({front_z, front_h})) + arc(page, front, +1.0);
  if (rear_z > front_z)
    d += move_or_line('L', page.at({front_z, -edge_h})) + move_or_line('L', page.at({rear_z, -edge_h}));
  d += move_or_line('L', page.at({rear_z, -rear_h})) + arc(page, rear, -1.0);
  if (rear_z > front_z)
    d += move_or_line('L', page.at({rear_z, edge_h})) + move_or_line('L', page.at({front_z, edge_h}));
  return d + "Z";
}

// Crown glasses are pale, dense flints deeper.
std::string glass_colour(const Glass& glass) {
  const double t = std::clamp((refractive_index(glass, kLineD_nm) - 1.45) / 0.45, 0.0, 1.0);
  const auto mix = [t](int a, int b) { return static_cast<int>(std::lround(a + t * (b - a))); };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(0xe9, 0x9f), mix(0xf3, 0xc0), mix(0xfa, 0xdd));
}

void draw_glass(Svg& svg, const SectionPage& page, const Section& section) {
  for (const Element& element : section.elements) {
    const SurfaceState& front = section.lens.surfaces[element.front];
    const SurfaceState& rear = section.lens.surfaces[element.rear];
    svg.path(outline(page, front, rear),
             fmt::format("fill=\"{}\" stroke=\"#54697c\" stroke-width=\"1.1\" stroke-linejoin=\"round\"",
                         glass_colour(front.after)));
  }
}

void draw_rays(Svg& svg, const SectionPage& page, const Section& section) {
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

// The obscuration before a surface's middle, as far as the section cuts it: along the surface.
void draw_obscurations(Svg& svg, const SectionPage& page, const LensState& lens) {
  for (const SurfaceState& s : lens.surfaces) {
    if (!s.obscuration.any()) continue;
    // The ellipse |A (p - c)| = 1 where it meets x = 0: a quadratic in y.
    const Rim rim = rim_of(s.obscuration);
    const Vec2 at = rim.coordinates({0.0, 0.0}), along = rim.coordinates({0.0, 1.0}) - at;
    const double b = dot(at, along), a = dot(along, along), under = b * b - a * (dot(at, at) - 1.0);
    if (!(under > 0.0)) continue;
    const double low = (-b - std::sqrt(under)) / a, high = (-b + std::sqrt(under)) / a;
    std::vector<Vec2> points;
    constexpr int kPieces = 24;
    for (int k = 0; k <= kPieces; ++k) {
      const double y = low + (high - low) * k / kPieces;
      points.push_back(page.at({s.z_mm + sag_mm(s, y), y}));
    }
    svg.polyline(points, fmt::format("stroke=\"{}\" stroke-width=\"3.5\"", kInk));
  }
}

void draw_stop_and_sensor(Svg& svg, const SectionPage& page, const Section& section) {
  const LensState& lens = section.lens;
  const SurfaceState& stop = lens.surfaces[static_cast<std::size_t>(lens.stop_index)];
  const double outer = std::max(1.25 * stop.semi_diameter_mm, lens.stop_radius_mm + 10.0 / page.scale());
  for (const double side : {1.0, -1.0}) {
    svg.line(page.at({stop.z_mm, side * lens.stop_radius_mm}), page.at({stop.z_mm, side * outer}),
             fmt::format("stroke=\"{}\" stroke-width=\"3.5\"", kInk));
  }
  const double half = 0.5 * std::hypot(lens.sensor_width_mm, lens.sensor_height_mm);
  svg.line(page.at({lens.sensor_z_mm, half}), page.at({lens.sensor_z_mm, -half}),
           fmt::format("stroke=\"{}\" stroke-width=\"4\" stroke-linecap=\"round\"", kInk));
}

}  // namespace

std::string draw_section(const Section& section) {
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
  draw_obscurations(svg, page, section.lens);
  draw_stop_and_sensor(svg, page, section);
  draw_surface_numbers(svg, page, section);
  draw_scale_bar(svg, page);
  return svg.finish();
}

}  // namespace contrejour::cli
