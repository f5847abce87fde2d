// SPDX-License-Identifier: Apache-2.0
// One ray at one surface: the formulas of optics/surface/surface-inl.h under the same names.
// With LIKE_CPU, operations are neither contracted nor reordered, so that rays fall on the same side of a pixel's edge
// as on the CPU.
#ifdef LIKE_CPU
#define exactly precise
#else
#define exactly
#endif

struct Ray3 {
  real x, y, z, dx, dy, dz;
};
struct Hit {
  real x, y, sag, nx, ny, nz, cos_in_squared, cos_in;
};
struct Axis3 {
  real x, y, z;
};
struct SurfaceFramePoint {
  real x, y, nz;
};

real square_root(real x) { return sqrt(x); }

// From RayGrid's origin to another point of the entrance plane. Returns the ratio of distances from the light.
real perturb_direction(exactly inout Ray3 ray, real offset_x, real offset_y) {
  ray.dx += offset_x;
  ray.dy += offset_y;
  real ratio = real(1.0) / square_root(ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz);
  ray.dx *= ratio;
  ray.dy *= ratio;
  ray.dz *= ratio;
  return ratio;
}

Hit intersect(Ray3 ray, real z_vertex, real c, real direction) {
  real to_plane = (z_vertex - ray.z) / ray.dz;
  real x = ray.x + to_plane * ray.dx;
  real y = ray.y + to_plane * ray.dy;
  real f = c * (x * x + y * y);
  real g = ray.dz - c * (x * ray.dx + y * ray.dy);
  exactly Hit hit;
  hit.cos_in_squared = g * g - c * f;
  hit.cos_in = square_root(max(hit.cos_in_squared, real(0.0)));
  real t = f / (g + direction * hit.cos_in);
  hit.x = x + t * ray.dx;
  hit.y = y + t * ray.dy;
  hit.sag = t * ray.dz;
  hit.nx = -c * hit.x;
  hit.ny = -c * hit.y;
  hit.nz = real(1.0) - c * hit.sag;
  return hit;
}

real along(Axis3 axis, real x, real y, real z) { return axis.x * x + axis.y * y + axis.z * z; }

Hit intersect_tilted(Ray3 ray, Axis3 n, real c, real direction) {
  real towards = along(n, ray.dx, ray.dy, ray.dz);
  real to_plane = -along(n, ray.x, ray.y, ray.z) / towards;
  real x = ray.x + to_plane * ray.dx;
  real y = ray.y + to_plane * ray.dy;
  real z = ray.z + to_plane * ray.dz;
  real f = c * (x * x + y * y + z * z);
  real g = towards - c * (x * ray.dx + y * ray.dy + z * ray.dz);
  exactly Hit hit;
  hit.cos_in_squared = g * g - c * f;
  hit.cos_in = square_root(max(hit.cos_in_squared, real(0.0)));
  real t = f / (g + direction * hit.cos_in);
  hit.x = x + t * ray.dx;
  hit.y = y + t * ray.dy;
  hit.sag = z + t * ray.dz;
  hit.nx = n.x - c * hit.x;
  hit.ny = n.y - c * hit.y;
  hit.nz = n.z - c * hit.sag;
  return hit;
}

SurfaceFramePoint surface_frame_point(Hit hit, Axis3 n, real c) {
  real height = along(n, hit.x, hit.y, hit.sag);
  real factor = (height + hit.sag) / (real(1.0) + n.z);
  return SurfaceFramePoint(hit.x - n.x * factor, hit.y - n.y * factor, real(1.0) - c * height);
}

void move_to(exactly inout Ray3 ray, Hit hit, real z_vertex) {
  ray.x = hit.x;
  ray.y = hit.y;
  ray.z = z_vertex + hit.sag;
}

// Negative for total reflection.
real cosine_out_squared(real eta, real cos_in) {
  exactly real squared = real(1.0) - eta * eta * (real(1.0) - cos_in * cos_in);
  return squared;
}

// cos_out: of the angle of refraction. The GLSL function of the name differs.
void refract_ray(exactly inout Ray3 ray, Hit hit, real eta, real direction, real cos_out) {
  real along_normal = direction * (cos_out - eta * hit.cos_in);
  ray.dx = eta * ray.dx + along_normal * hit.nx;
  ray.dy = eta * ray.dy + along_normal * hit.ny;
  ray.dz = eta * ray.dz + along_normal * hit.nz;
}

void reflect_ray(exactly inout Ray3 ray, Hit hit, real direction) {
  real twice = real(2.0) * direction * hit.cos_in;
  ray.dx -= twice * hit.nx;
  ray.dy -= twice * hit.ny;
  ray.dz -= twice * hit.nz;
}

void rotate_to_surface_frame(Axis3 n, inout real x, inout real y, inout real z) {
  real height = along(n, x, y, z);
  real factor = (height + z) / (real(1.0) + n.z);
  x -= n.x * factor;
  y -= n.y * factor;
  z = height;
}

void rotate_back(Axis3 n, inout real x, inout real y, inout real z) {
  real across = n.x * x + n.y * y;
  real factor = z - across / (real(1.0) + n.z);
  x += n.x * factor;
  y += n.y * factor;
  z = n.z * z - across;
}
