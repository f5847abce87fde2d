// SPDX-License-Identifier: Apache-2.0
// A ray along a path: optics/trace/packet_trace.cpp under the same names. Whoever includes this file includes
// buffers.glsl and defines start_real(k), one of the numbers START_..., and path_number(k), path_word(k) and
// table_pair(k), the numbers of paths and two reflectances, before it, and sets the path. With GEOMETRY_ONLY
// transmissions are left out.
#include "surface.glsl"
#include "shape.glsl"

#define TABLE_INTERVALS 2048
#define BEYOND_EQUATOR_SQUARED 4.0

// The path's numbers may be given as step_quarter(step, k) and step_words(step, k), four at a time, with PATH_QUARTERS.

// A path, then its steps: numbers as written by layout.cpp.
#define PATH_REALS 4u
#define STEP_REALS 20u
#define STEP_INTEGERS 8u
#define EVENT_REFRACT 0
#define EVENT_REFLECT 1
// The bits of a step's first word: the event, what else is to be known of it, and the crossing of the stop.
#define STEP_EVENT 3
#define STEP_FROM_DENSER 4
#define STEP_BLOCKS_WITHIN 8
#define STEP_GENERAL 16
#define STEP_BACKWARDS 32   // light runs towards smaller z
#define STEP_COMPLEMENT 64  // the table has reflectances where the transmittance counts
#define STEP_CROSSING_SHIFT 7

// The surfaces of the path, as PathGeometry: code for others is left out.
layout(constant_id = 0) const uint GEOMETRY = 2u;
#define WITH_SHAPES (GEOMETRY != 0u)
#define WITH_GENERAL (GEOMETRY == 2u)

uint path_reals, path_integers, path_steps;  // where the path's numbers begin; their number
vec2 stop_points[MAX_CROSSINGS];             // where the last ray crossed the stop, stop radii

struct PacketState {
  Ray3 ray;
  real transmission, relative_height_squared;
  bool alive;
};

#ifdef PATH_QUARTERS
real step_real(uint step, int k) { return step_quarter(step, k >> 2)[k & 3]; }
int step_integer(uint step, int k) { return step_words(step, k >> 2)[k & 3]; }
#else
real step_real(uint step, int k) { return path_number(path_reals + PATH_REALS + step * STEP_REALS + uint(k)); }
int step_integer(uint step, int k) { return path_word(path_integers + step * STEP_INTEGERS + uint(k)); }
#endif
// The sensor's gap and offset; 1 over the stop's radius.
real path_real(int k) { return path_number(path_reals + uint(k)); }

real look_up(int table, real u) {
  real position = min((u > real(0.0) ? u : real(0.0)) * real(TABLE_INTERVALS), real(TABLE_INTERVALS));
  int index = min(int(position), TABLE_INTERVALS - 1);
  vec2 about = table_pair(table + index);
  return real(about.x) + (position - real(index)) * real(about.y - about.x);
}

Hit meet(inout Ray3 ray, uint step, bool general, real c, real direction, out SurfaceFramePoint own) {
  int shape_at = WITH_SHAPES ? step_integer(step, 2) : -1;
  Shape shape;
  if (shape_at >= 0)
    shape = Shape(shape_at, step_integer(step, 3), step_integer(step, 4), step_integer(step, 5),
                  step_integer(step, 6) != 0);
  real gap = step_real(step, 0);
  Hit hit;
  if (!general) {
    if (shape_at >= 0)
      hit = intersect_shape(ray, gap, shape, direction);
    else
      hit = intersect(ray, gap, c, direction);
    move_to(ray, hit, real(0.0));
    own = SurfaceFramePoint(hit.x, hit.y, hit.nz);
    return hit;
  }
  Axis3 axis = Axis3(step_real(step, 5), step_real(step, 6), step_real(step, 7));
  ray.x -= step_real(step, 8);
  ray.y -= step_real(step, 9);
  ray.z -= gap;
  if (shape_at >= 0) {
    Ray3 upright = ray;
    rotate_to_surface_frame(axis, upright.x, upright.y, upright.z);
    rotate_to_surface_frame(axis, upright.dx, upright.dy, upright.dz);
    hit = intersect_shape(upright, real(0.0), shape, direction);
    own = SurfaceFramePoint(hit.x, hit.y, hit.nz);
    rotate_back(axis, hit.x, hit.y, hit.sag);
    rotate_back(axis, hit.nx, hit.ny, hit.nz);
  } else {
    hit = intersect_tilted(ray, axis, c, direction);
    own = surface_frame_point(hit, axis, c);
  }
  move_to(ray, hit, real(0.0));
  return hit;
}

// Squared distance from the axis over the clear semi-diameter; 2 minus the height at something that blocks within.
real height_squared_at(uint step, bool general, bool blocks_within, SurfaceFramePoint own) {
  real beyond = own.nz > real(0.0) ? real(0.0) : real(BEYOND_EQUATOR_SQUARED);
  if (!general) return max((own.x * own.x + own.y * own.y) * step_real(step, 2), beyond);
  real x = own.x - step_real(step, 10), y = own.y - step_real(step, 11);
  real u = step_real(step, 12) * x + step_real(step, 13) * y;
  real v = step_real(step, 14) * x + step_real(step, 15) * y;
  real r_squared = u * u + v * v;
  if (!blocks_within) return max(r_squared, beyond);
  real height = max(real(2.0) - square_root(r_squared), real(0.0));
  return max(height * height, beyond);
}

void deflect_by_grating(inout PacketState s, uint step) {
  s.transmission *= step_real(step, 19);
  s.ray.dx += step_real(step, 17);
  s.ray.dy += step_real(step, 18);
  real along_squared = real(1.0) - s.ray.dx * s.ray.dx - s.ray.dy * s.ray.dy;
  s.alive = s.alive && along_squared > real(0.0);
  real upright = square_root(max(along_squared, real(0.0)));
  s.ray.dz = s.ray.dz > real(0.0) ? upright : -upright;
}

void absorb(inout PacketState s, uint step, real from_z) {
  real distance = (s.ray.z + step_real(step, 0) - from_z) / s.ray.dz;
  s.transmission *= real(exp(float(-step_real(step, 16) * distance)));
}

void advance(inout PacketState s, uint step, inout vec2 stops[MAX_CROSSINGS]) {
  int word = step_integer(step, 0), event = word & STEP_EVENT;
  bool general = WITH_GENERAL && (word & STEP_GENERAL) != 0;
  real direction = (word & STEP_BACKWARDS) != 0 ? real(-1.0) : real(1.0);
  real from_z = s.ray.z;
  SurfaceFramePoint own;
  Hit hit = meet(s.ray, step, general, step_real(step, 1), direction, own);
  s.alive = s.alive && hit.cos_in_squared > real(0.0);
  if (general && step_real(step, 16) != real(0.0)) absorb(s, step, from_z);
  if (event != EVENT_REFRACT && event != EVENT_REFLECT) {
    real inverse_radius = path_real(3);
    vec2 at = vec2(float(s.ray.x * inverse_radius), float(s.ray.y * inverse_radius));
    // An index that varies would keep the points in memory.
    int crossed = word >> STEP_CROSSING_SHIFT;
    stops[0] = crossed == 0 ? at : stops[0];
    stops[1] = crossed == 1 ? at : stops[1];
    stops[2] = crossed == 2 ? at : stops[2];
    return;
  }
  s.relative_height_squared =
      max(s.relative_height_squared, height_squared_at(step, general, (word & STEP_BLOCKS_WITHIN) != 0, own));

  real eta = step_real(step, 3);
#ifdef GEOMETRY_ONLY
  if (event == EVENT_REFLECT) {
    reflect_ray(s.ray, hit, direction);
    if (general && step_real(step, 19) != real(1.0)) deflect_by_grating(s, step);
    return;
  }
  real cos_out_squared = cosine_out_squared(eta, hit.cos_in);
  s.alive = s.alive && cos_out_squared > real(0.0);
  refract_ray(s.ray, hit, eta, direction, square_root(max(cos_out_squared, real(0.0))));
#else
  // Roots and tables are found at one place, since lavapipe evaluates both sides of a branch.
  bool reflects = event == EVENT_REFLECT;
  real cos_in = min(hit.cos_in, real(1.0));
  exactly real cos_out_squared = cosine_out_squared(eta, reflects ? cos_in : hit.cos_in);
  real cos_out = square_root(max(cos_out_squared, real(0.0)));
  s.alive = s.alive && (reflects || cos_out_squared > real(0.0));
  if (reflects)
    reflect_ray(s.ray, hit, direction);
  else
    refract_ray(s.ray, hit, eta, direction, cos_out);
  real u = (word & STEP_FROM_DENSER) != 0 ? cos_out : cos_in;
  real found = look_up(step_integer(step, 1), u);
  s.transmission *= (word & STEP_COMPLEMENT) != 0 ? real(1.0) - found : found;
  if (general && reflects && step_real(step, 19) != real(1.0)) deflect_by_grating(s, step);
#endif
}

PacketState enter(real x, real y) {
  PacketState s;
  s.ray = Ray3(start_real(START_X) + x, start_real(START_Y) + y, real(0.0), start_real(START_DX), start_real(START_DY),
               start_real(START_DZ));
  s.transmission = real(1.0);
  if (start_real(START_DIVERGES) != real(0.0)) {
    real per_distance = start_real(START_PER_DISTANCE);
    real ratio = perturb_direction(s.ray, x * per_distance, y * per_distance);
    s.transmission = start_real(START_FLUX) * ratio * ratio * ratio;
  }
  s.relative_height_squared = real(0.0);
  s.alive = true;
  return s;
}

// Pixel coordinates, transmission and relative height.
vec4 land(PacketState s) {
  real t = (path_real(0) - s.ray.z) / s.ray.dz;
  if (!(s.alive && s.ray.dz > real(0.0))) return vec4(0.0, 0.0, 0.0, FAILED);
  real x = s.ray.x + t * s.ray.dx - path_real(1);
  real y = s.ray.y + t * s.ray.dy - path_real(2);
  return vec4(float(start_real(START_PIXEL_X) + start_real(START_SCALE_X) * x),
              float(start_real(START_PIXEL_Y) + start_real(START_SCALE_Y) * y),
              float(s.transmission), float(square_root(s.relative_height_squared)));
}

// The ray that enters at an offset from the path's first point, mm; sets stop_points.
vec4 trace_ray(real x, real y) {
  PacketState s = enter(x, y);
  for (uint step = 0u; step < path_steps; ++step) advance(s, step, stop_points);
  return land(s);
}
