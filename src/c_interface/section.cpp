// SPDX-License-Identifier: Apache-2.0
// Sections of lenses for C callers.
#include <utility>

#include <fmt/format.h>

#include "c_interface/boundary.h"
#include "c_interface/optics_objects.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour {
namespace {

using Line = cj_section::Line;

Line line_of(cj_line_kind kind, std::size_t index, const std::vector<Vec2>& points) {
  Line line{kind, false, index, {}};
  for (const Vec2 p : points) {
    line.points_mm.push_back(p.x);
    line.points_mm.push_back(p.y);
  }
  return line;
}

cj_line_kind kind_of_ray(SectionRayKind kind) {
  switch (kind) {
    case SectionRayKind::Axis: return CJ_LINE_AXIS_RAY;
    case SectionRayKind::Field: return CJ_LINE_FIELD_RAY;
    case SectionRayKind::Ghost: return CJ_LINE_GHOST_RAY;
  }
  return CJ_LINE_GHOST_RAY;
}

std::vector<Line> lines_of(const LensSection& section) {
  std::vector<Line> lines;
  for (const SectionElement& element : section.elements)
    lines.push_back(line_of(CJ_LINE_ELEMENT, element.front, polyline(element.outline)));
  for (const SectionSurface& surface : section.surfaces)
    lines.push_back(line_of(CJ_LINE_SURFACE, surface.surface, polyline(surface.curve)));
  for (std::size_t k = 0; k < section.obscurations.size(); ++k)
    lines.push_back(line_of(CJ_LINE_OBSCURATION, k, polyline(section.obscurations[k])));
  const auto& [stop_z, opening, outer] = section.stop;
  const auto stop_index = static_cast<std::size_t>(section.lens.stop_index);
  for (const double side : {1.0, -1.0})
    lines.push_back(line_of(CJ_LINE_STOP, stop_index, {{stop_z, side * opening}, {stop_z, side * outer}}));
  const auto& [sensor_z, half] = section.sensor;
  lines.push_back(line_of(CJ_LINE_SENSOR, 0, {{sensor_z, half}, {sensor_z, -half}}));
  for (const SectionRay& ray : section.rays) {
    lines.push_back(line_of(kind_of_ray(ray.kind), ray.ghost, ray.points_mm));
    lines.back().is_blocked = ray.blocked;
  }
  return lines;
}

Result<SectionRequest> request_of(const LensState& lens, const cj_section_options& options) {
  SectionRequest request;
  const auto lambda_nm = wavelength_of(lens, options.wavelength_nm);
  if (!lambda_nm) return tl::unexpected(lambda_nm.error());
  request.lambda_nm = *lambda_nm;
  if (options.ghosts != nullptr && *options.ghosts != '\0') {
    auto ghosts = params::parse_ghosts(options.ghosts);
    if (!ghosts) return tl::unexpected(ghosts.error());
    for (const Ghost& ghost : *ghosts)
      if (!has_ghost(lens, ghost)) return invalid_argument(fmt::format("the lens has no ghost {}", ghost_name(ghost)));
    request.ghosts = std::move(*ghosts);
  }
  if (options.has_ghost_light != 0) request.ghost_light_rad = options.ghost_light_rad;
  return request;
}

}  // namespace
}  // namespace contrejour

cj_status cj_section_create(const cj_lens_state* state, const cj_section_options* options, cj_section** section,
                            cj_error* error) {
  using namespace contrejour;
  return guarded_create(section, error, [&]() -> Result<cj_section> {
    if (const auto given = require_surfaces(state); !given) return tl::unexpected(given.error());
    cj_section_options given{};
    if (options != nullptr) {
      if (const auto good = check_struct(options, sizeof(cj_section_options), "cj_section_options"); !good)
        return tl::unexpected(good.error());
      given = in_this_version(*options);
    }
    const auto request = request_of(state->state, given);
    if (!request) return tl::unexpected(request.error());
    const LensSection drawn = lens_section(state->state, *request);
    return cj_section{section_svg(drawn), lines_of(drawn)};
  });
}

void cj_section_destroy(cj_section* section) { delete section; }

const char* cj_section_svg(const cj_section* section) { return section != nullptr ? section->svg.c_str() : nullptr; }

size_t cj_section_line_count(const cj_section* section) { return section != nullptr ? section->lines.size() : 0; }

cj_status cj_section_get_line(const cj_section* section, size_t index, cj_section_line* line, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(section, "section"); !given) return given;
    if (const auto good = check_struct(line, sizeof(cj_section_line), "cj_section_line"); !good) return good;
    if (index >= section->lines.size())
      return invalid_argument(fmt::format("there is no line {} of {}", index, section->lines.size()));
    const cj_section::Line& found = section->lines[index];
    cj_section_line ours{};
    ours.kind = found.kind;
    ours.is_blocked = found.is_blocked ? 1 : 0;
    ours.index = found.index;
    ours.points_mm = found.points_mm.data();
    ours.point_count = found.points_mm.size() / 2;
    write_struct(ours, line);
    return {};
  });
}
