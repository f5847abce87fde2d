// SPDX-License-Identifier: Apache-2.0
// Lists the polygons of a part of a cell that is cut by rims or the iris, or is not smooth: half a part an invocation, as
// ../cells.comp. Edges of ghosts are finer than the grid: the corners of parts lie between the rays.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "common.glsl"
#include "grid.glsl"
#include "../iris.glsl"
#include "../polygon.glsl"
#include "../cell.glsl"
#include "list.glsl"
#include "state.glsl"
#include "between.glsl"

vec3 transmissions;
vec2 pixels[3];

void list_part(float flux, float fraction, vec2 gradient) {
  float area = abs(0.5 * cross2(pixels[1] - pixels[0], pixels[2] - pixels[0]));
  if (in_one_pixel()) {
    list_point(polygon[0], flux * fraction);
    return;
  }
  vec2 from, to;
  farthest_corners(from, to);
  if (area < SLIVER * dot(to - from, to - from)) {
    list_line(from, to, flux * fraction);
    return;
  }
  float value = flux / area;
  list_polygon(Density((pixels[0] + pixels[1] + pixels[2]) * (1.0 / 3.0), value, gradient * value));
}

void list_triangle(vec2 gradient) {
  clip_triangle(crossings_of(item));
  if (corner_count < 3) return;
  float fraction = abs(twice_polygon_area());  // in (u, v) the whole triangle's area is 1/2
  for (int k = 0; k < corner_count; ++k)
    polygon[k] = pixels[0] + (pixels[1] - pixels[0]) * polygon[k].x + (pixels[2] - pixels[0]) * polygon[k].y;
  list_part(triangle_weight * (transmissions.x + transmissions.y + transmissions.z) / 3.0, fraction, gradient);
}

// Sets the corners of half a part of the cell.
void set_part(vec2 low, float size, bool is_second) {
  const vec2 corners[4] = vec2[4](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0));
  for (int k = 0; k < 3; ++k) {
    vec2 at = low + size * corners[k == 0 ? 0 : is_second ? k + 1 : k];
    set_weights(at, true, true);
    vec4 ray = ray_between();
    transmissions[k] = max(ray.z, 0.0);
    heights_of_triangle[k] = ray.w;
    for (uint c = 0u; c < crossings_of(item); ++c) stops_of_triangle[c][k] = crossing_between(c);
    if (is_on_straight_row(at) || is_on_straight_column(at)) {
      set_weights(at, !is_on_straight_row(at), !is_on_straight_column(at));
      ray.xy = ray_between().xy;
    }
    pixels[k] = ray.xy - vec2(base);
  }
}

bool set_whole(uvec3 t) {
  for (int k = 0; k < 3; ++k) {
    vec4 ray = rays[t[k]];
    if (failed(ray)) return false;
    pixels[k] = ray.xy - vec2(base);
    transmissions[k] = ray.z;
  }
  set_triangle(t, crossings_of(item));
  return true;
}

void main() {
  uint k = linear_group() * 64u + gl_LocalInvocationID.x;
  if (k / 2u >= min(counters[COUNT_CUT], p.cut_capacity)) return;
  uvec2 part = cut_cells[k / 2u];
  item = part.x;
  own = part.y & CUT_CELL_MASK;
  uint parts = 1u + (part.y >> CUT_PARTS_SHIFT), number = (part.y >> CUT_PART_SHIFT) & 15u;
  side = cells_of(item) + 1u;
  first_ray = 64u * offsets[item];
  uvec4 v = first_ray + own + uvec4(0u, 1u, side + 1u, side);
  set_cell(v);
  bool any_failed = failed(rays[v.x]) || failed(rays[v.y]) || failed(rays[v.z]) || failed(rays[v.w]);
  vec4 e = vec4(irradiance_at(v.x), irradiance_at(v.y), irradiance_at(v.z), irradiance_at(v.w));
  float area = any_failed ? 0.0 : 0.5 * cross2(rays[v.z].xy - rays[v.x].xy, rays[v.w].xy - rays[v.y].xy);
  bool is_shaded = all(greaterThan(e, vec4(0.0))) && abs(area) >= SHADED_CELL_PX;
  vec2 gradient = is_shaded ? gradient_of(v, e) : vec2(0.0);
  bool is_second = k % 2u != 0u;
  if (any_failed) {
    if (!set_whole(is_second ? v.xzw : v.xyz)) return;
  } else {
    float size = 1.0 / float(parts);
    find_around();
    set_part(vec2(number % parts, number / parts) * size, size, is_second);
    triangle_weight *= size * size;
  }
  list_triangle(gradient);
}
