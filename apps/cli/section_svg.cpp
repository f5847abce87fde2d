// SPDX-License-Identifier: Apache-2.0
#include "cli/section_svg.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cli/svg.h"

namespace contrejour::cli {
namespace {

constexpr double kWidth_px = 1400, kMargin_px = 48, kTop_px = 96, kBottom_px = 84, kTallest_px = 760;
constexpr double kLabelGap_px = 19, kLegendColumn_px = 210;
constexpr const char* kInk = "#26323d";
constexpr const char* kQuiet = "#8a97a3";

struct RayStyle {
  const char* colour;
  double width;
  double opacity;
};

// The ghosts' colours; after the last the first is used again.
constexpr std::array kGhostInks{"#d5482c", "#8e44ad", "#c98a00", "#138d75", "#c2185b", "#6d4c41"};

RayStyle style_of(RayKind kind, std::size_t ghost = 0) {
  switch (kind) {
    case RayKind::Axis: return {"#2f6fb5", 1.1, 0.85};
    case RayKind::Field: return {"#2d8f6a", 1.1, 0.85};
    case RayKind::Ghost: return {kGhostInks[ghost % kGhostInks.size()], 1.2, 0.9};
  }
  return {kInk, 1, 1};
}

// Millimetres of the section -> pixels of the drawing.
class Page {
 public:
  explicit Page(const Section& section) : section_(section) {
    const double length_mm = section.right_mm - section.left_mm;
    scale_ = std::min((kWidth_px - 2 * kMargin_px) / length_mm, kTallest_px / (2 * section.half_height_mm));
    left_px_ = 0.5 * (kWidth_px - scale_ * length_mm);
    axis_px_ = kTop_px + scale_ * section.half_height_mm;
  }
  [[nodiscard]] Vec2 at(Vec2 mm) const {
    return {left_px_ + (mm.x - section_.left_mm) * scale_, axis_px_ - mm.y * scale_};
  }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] double bottom() const { return axis_px_ + scale_ * section_.half_height_mm; }
  [[nodiscard]] double height() const { return bottom() + kBottom_px; }
  [[nodiscard]] double left() const { return left_px_; }

 private:
  const Section& section_;
  double scale_ = 1, left_px_ = 0, axis_px_ = 0;
};

// A surface that is not a sphere, as straight lines whose deviation is not visible.
std::string curve(const Page& page, const SurfaceState& s, double from) {
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
std::string arc(const Page& page, const SurfaceState& s, double from) {
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
std::string outline(const Page& page, const SurfaceState& front, const SurfaceState& rear) {
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

void draw_glass(Svg& svg, const Page& page, const Section& section) {
  for (const Element& element : section.elements) {
    const SurfaceState& front = section.lens.surfaces[element.front];
    const SurfaceState& rear = section.lens.surfaces[element.rear];
    svg.path(outline(page, front, rear),
             fmt::format("fill=\"{}\" stroke=\"#54697c\" stroke-width=\"1.1\" stroke-linejoin=\"round\"",
                         glass_colour(front.after)));
  }
}

void draw_rays(Svg& svg, const Page& page, const Section& section) {
  svg.begin_clip({page.left(), kTop_px}, {kWidth_px - 2 * page.left() + 2, page.bottom() - kTop_px});
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
void draw_obscurations(Svg& svg, const Page& page, const LensState& lens) {
  for (const SurfaceState& s : lens.surfaces) {
    if (!s.obscuration.any()) continue;
    // The ellipse |A (p - c)| = 1 where it meets x = 0: a quadratic in y.
    const Rim rim = rim_of(s.obscuration);
    const Vec2 at = rim.place({0.0, 0.0}), along = rim.place({0.0, 1.0}) - at;
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

void draw_stop_and_sensor(Svg& svg, const Page& page, const Section& section) {
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

// Positions at least a gap apart, each as close to the wanted one as that allows (pool adjacent violators).
std::vector<double> spread(const std::vector<double>& wanted, double gap) {
  struct Pool {
    double sum = 0;
    int count = 0;
    [[nodiscard]] double mean() const { return sum / count; }
  };
  std::vector<Pool> pools;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    pools.push_back({wanted[k] - gap * static_cast<double>(k), 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean() > pools.back().mean()) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back().sum += last.sum;
      pools.back().count += last.count;
    }
  }
  std::vector<double> places;
  for (const Pool& pool : pools) {
    for (int k = 0; k < pool.count; ++k) places.push_back(pool.mean() + gap * static_cast<double>(places.size()));
  }
  return places;
}

void draw_numbers(Svg& svg, const Page& page, const Section& section) {
  const auto& surfaces = section.lens.surfaces;
  std::vector<Vec2> rims;
  std::vector<double> wanted;
  for (const SurfaceState& s : surfaces) {
    const bool stop = s.kind == SurfaceKind::Stop;
    const double h = stop ? std::max(1.25 * s.semi_diameter_mm, section.lens.stop_radius_mm) : drawn_height_mm(s);
    rims.push_back(page.at({s.z_mm + (stop ? 0.0 : sag_mm(s, h)), -h}));
    wanted.push_back(rims.back().x);
  }
  const double gap = std::min(kLabelGap_px, (kWidth_px - 2 * kMargin_px) / static_cast<double>(surfaces.size()));
  const std::vector<double> places = spread(wanted, gap);
  const double label_y = page.bottom() + 30;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const int number = static_cast<int>(k) + 1;
    const auto& ghosts = section.ghosts;
    const auto first =
        std::find_if(ghosts.begin(), ghosts.end(), [&](const Ghost& g) { return g.reflects_at(number); });
    const bool reflects = first != ghosts.end();
    const char* colour =
        reflects ? style_of(RayKind::Ghost, static_cast<std::size_t>(first - ghosts.begin())).colour : kInk;
    svg.polyline({rims[k], {rims[k].x, page.bottom() + 4}, {places[k], label_y - 12}},
                 fmt::format("stroke=\"{}\" stroke-width=\"0.6\" stroke-opacity=\"0.7\"", kQuiet));
    svg.text({places[k], label_y}, fmt::format("{}", k + 1),
             fmt::format("font-size=\"12\" text-anchor=\"middle\" fill=\"{}\"{}", colour,
                         reflects ? " font-weight=\"bold\"" : ""));
    if (surfaces[k].kind == SurfaceKind::Stop) {
      svg.text({places[k], label_y + 15}, "stop",
               fmt::format("font-size=\"11\" text-anchor=\"middle\" font-style=\"italic\" fill=\"{}\"", kInk));
    }
  }
  const Vec2 sensor = page.at({section.lens.sensor_z_mm, 0});
  svg.text({sensor.x, label_y}, "sensor",
           fmt::format("font-size=\"11\" text-anchor=\"end\" font-style=\"italic\" fill=\"{}\"", kInk));
}

struct LegendEntry {
  RayStyle style;
  std::string words;
};

std::vector<LegendEntry> legend_of(const Section& section) {
  const RayStyle axis = style_of(RayKind::Axis);
  if (section.ghosts.empty()) return {{axis, "axis"}, {style_of(RayKind::Field), "corner of the field"}};
  std::vector<LegendEntry> entries{{axis, fmt::format("image of a light {:.1f}° up", section.ghost_light_deg)}};
  for (std::size_t g = 0; g < section.ghosts.size(); ++g) {
    const auto is_blocked = [&](const SectionRay& ray) {
      return ray.kind == RayKind::Ghost && ray.ghost == g && ray.blocked;
    };
    const bool blocked = std::any_of(section.rays.begin(), section.rays.end(), is_blocked);
    entries.push_back(
        {style_of(RayKind::Ghost, g), "ghost " + ghost_name(section.ghosts[g]) + (blocked ? " (blocked)" : "")});
  }
  return entries;
}

void draw_legend(Svg& svg, const Section& section) {
  double y = 40;
  double right = kWidth_px - kMargin_px;
  for (const LegendEntry& entry : legend_of(section)) {
    svg.line({right - 28, y - 4}, {right, y - 4},
             fmt::format("stroke=\"{}\" stroke-width=\"2.4\"", entry.style.colour));
    svg.text({right - 36, y}, entry.words, fmt::format("font-size=\"13\" text-anchor=\"end\" fill=\"{}\"", kInk));
    y += 18;
    if (y > kTop_px - 4) {  // next column, to the left
      y = 40;
      right -= kLegendColumn_px;
    }
  }
}

// A bar of 1, 2 or 5 times a power of ten, about a tenth of the width.
void draw_scale_bar(Svg& svg, const Page& page) {
  const double aim_mm = 0.1 * kWidth_px / page.scale();
  const double decade = std::pow(10.0, std::floor(std::log10(aim_mm)));
  const double lead = aim_mm / decade;
  const double length_mm = decade * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
  const Vec2 from{kMargin_px, page.height() - 22};
  const Vec2 to{from.x + length_mm * page.scale(), from.y};
  const std::string style = fmt::format("stroke=\"{}\" stroke-width=\"1.4\"", kQuiet);
  svg.line(from, to, style);
  for (const Vec2 end : {from, to}) svg.line({end.x, end.y - 4}, {end.x, end.y + 4}, style);
  svg.text({to.x + 8, to.y + 4}, fmt::format("{:g} mm", length_mm),
           fmt::format("font-size=\"12\" fill=\"{}\"", kQuiet));
}

void draw_title(Svg& svg, const LensState& lens) {
  svg.text({kMargin_px, 44}, lens.name, fmt::format("font-size=\"22\" font-weight=\"bold\" fill=\"{}\"", kInk));
  svg.text({kMargin_px, 66}, fmt::format("{:.1f} mm, f/{:g}", lens.focal_length_mm, lens.f_number),
           fmt::format("font-size=\"14\" fill=\"{}\"", kQuiet));
}

}  // namespace

std::string draw_section(const Section& section) {
  const Page page(section);
  Svg svg(kWidth_px, page.height());
  svg.rectangle({0, 0}, {kWidth_px, page.height()}, "fill=\"#ffffff\"");
  draw_title(svg, section.lens);
  draw_legend(svg, section);
  draw_glass(svg, page, section);
  const Vec2 axis_left = page.at({section.left_mm, 0});
  const Vec2 axis_right = page.at({section.right_mm, 0});
  svg.line(axis_left, {axis_right.x + 12, axis_right.y},
           fmt::format("stroke=\"{}\" stroke-width=\"0.8\" stroke-dasharray=\"14 4 2 4\"", kQuiet));
  draw_rays(svg, page, section);
  draw_obscurations(svg, page, section.lens);
  draw_stop_and_sensor(svg, page, section);
  draw_numbers(svg, page, section);
  draw_scale_bar(svg, page);
  return svg.finish();
}

}  // namespace contrejour::cli
