// SPDX-License-Identifier: Apache-2.0
// Traces a grid of rays along a path, one ray an invocation: optics/trace/packet_trace.cpp under the same names.
// Compiled in float and, with DOUBLE, in double.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "surface.glsl"
#include "shape.glsl"

#define TABLE_INTERVALS 2048
#define BEYOND_EQUATOR_SQUARED 4.0

// The start of a path, then its steps: numbers as written by layout.cpp.
#define START_REALS 18
#define STEP_REALS 20
#define STEP_INTEGERS 12
#define EVENT_REFRACT 0
#define EVENT_REFLECT 1
#define STEP_FROM_DENSER 1
#define STEP_BLOCKS_WITHIN 2
#define STEP_GENERAL 4

struct PacketState {
  Ray3 ray;
  real transmission, relative_height_squared;
  bool alive;
};

real step_real(uint step, int k) { return reals[p.reals_at + START_REALS + step * STEP_REALS + k]; }
int step_integer(uint step, int k) { return integers[p.integers_at + step * STEP_INTEGERS + k]; }
real start_real(int k) { return reals[p.reals_at + k]; }

real look_up(int table, real u) {
  real position = min((u > real(0.0) ? u : real(0.0)) * real(TABLE_INTERVALS), real(TABLE_INTERVALS));
  int index = min(int(position), TABLE_INTERVALS - 1);
  float low = tables[table + index];
  float high = tables[table + index + 1];
  return real(low) + (position - real(index)) * real(high - low);
}

Hit meet(inout Ray3 ray, uint step, bool general, real c, real direction, out SurfaceFramePoint own) {
  int shape_at = step_integer(step, 5);
  Shape shape;
  if (shape_at >= 0)
    shape = Shape(shape_at, step_integer(step, 6), step_integer(step, 7), step_integer(step, 8),
                  step_integer(step, 9) != 0);
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

void advance(inout PacketState s, uint step, uint ray) {
  int event = step_integer(step, 0), flags = step_integer(step, 2);
  bool general = (flags & STEP_GENERAL) != 0;
  real direction = step_real(step, 4);
  real from_z = s.ray.z;
  SurfaceFramePoint own;
  Hit hit = meet(s.ray, step, general, step_real(step, 1), direction, own);
  s.alive = s.alive && hit.cos_in_squared > real(0.0);
  if (general && step_real(step, 16) != real(0.0)) absorb(s, step, from_z);
  if (event != EVENT_REFRACT && event != EVENT_REFLECT) {
    real inverse_radius = start_real(13);
    crossings[ray * MAX_CROSSINGS + uint(step_integer(step, 1))] =
        vec2(float(s.ray.x * inverse_radius), float(s.ray.y * inverse_radius));
    return;
  }
  s.relative_height_squared =
      max(s.relative_height_squared, height_squared_at(step, general, (flags & STEP_BLOCKS_WITHIN) != 0, own));

  real eta = step_real(step, 3);
  int reflectance = step_integer(step, 3), transmittance = step_integer(step, 4);
  real cos_in = min(hit.cos_in, real(1.0));
  bool from_denser = (flags & STEP_FROM_DENSER) != 0;
  if (event == EVENT_REFLECT) {
    real cos_out_squared = real(1.0) - eta * eta * (real(1.0) - cos_in * cos_in);
    real u = from_denser ? square_root(max(cos_out_squared, real(0.0))) : cos_in;
    s.transmission *= look_up(reflectance, u);
    reflect_ray(s.ray, hit, direction);
    if (general && step_real(step, 19) != real(1.0)) deflect_by_grating(s, step);
    return;
  }
  real cos_out_squared = refract_ray(s.ray, hit, eta, direction);
  s.alive = s.alive && cos_out_squared > real(0.0);
  real u = from_denser ? square_root(max(cos_out_squared, real(0.0))) : cos_in;
  s.transmission *= transmittance >= 0 ? look_up(transmittance, u) : real(1.0) - look_up(reflectance, u);
}

PacketState enter(real x, real y) {
  PacketState s;
  s.ray = Ray3(start_real(0) + x, start_real(1) + y, real(0.0), start_real(2), start_real(3), start_real(4));
  s.transmission = real(1.0);
  if (start_real(7) != real(0.0)) {
    real per_distance = start_real(5);
    real ratio = perturb_direction(s.ray, x * per_distance, y * per_distance);
    s.transmission = start_real(6) * ratio * ratio * ratio;
  }
  s.relative_height_squared = real(0.0);
  s.alive = true;
  return s;
}

void land(PacketState s, uint ray) {
  real t = (start_real(10) - s.ray.z) / s.ray.dz;
  if (!(s.alive && s.ray.dz > real(0.0))) {
    rays[ray] = vec4(0.0, 0.0, 0.0, FAILED);
    return;
  }
  real x = s.ray.x + t * s.ray.dx - start_real(11);
  real y = s.ray.y + t * s.ray.dy - start_real(12);
  rays[ray] = vec4(float(start_real(14) + start_real(16) * x), float(start_real(15) + start_real(17) * y),
                   float(s.transmission), float(square_root(s.relative_height_squared)));
}

void main() {
  uint k = linear_invocation();
  if (k >= p.side * p.side) return;
  uint ray = p.first_ray + k;
  PacketState s = enter(real(k % p.side) * start_real(8), real(k / p.side) * start_real(9));
  for (uint step = 0; step < p.step_count; ++step) advance(s, step, ray);
  land(s, ray);
}
