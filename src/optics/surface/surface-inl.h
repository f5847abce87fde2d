// SPDX-License-Identifier: Apache-2.0
// Formulas of one ray at one surface: intersection, refraction, reflection, Fresnel and single-film reflectance.
// Templated on the number type T: double, or a packet of floats. Compiled once per instruction set (Highway's
// foreach_target), hence the toggling guard in place of an ordinary one.
#if defined(CONTREJOUR_KERNELS_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_KERNELS_SURFACE_INL_H_
#undef CONTREJOUR_KERNELS_SURFACE_INL_H_
#else
#define CONTREJOUR_KERNELS_SURFACE_INL_H_
#endif

#include <cmath>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::kernels::HWY_NAMESPACE {

// Functions that T needs besides + - * /; packets define their own.
HWY_INLINE double square_root(double x) { return std::sqrt(x); }
HWY_INLINE double cosine(double x) { return std::cos(x); }
HWY_INLINE double larger(double a, double b) { return a > b ? a : b; }

template <class T>
struct Ray3 {
  T x, y, z;     // mm
  T dx, dy, dz;  // unit
};

// Changes the direction of a ray of a light at a finite distance to that of a ray displaced by (offset_x, offset_y), in
// units of the first ray's distance from the light. Returns the first ray's distance over the other's.
template <class T>
HWY_INLINE T perturb_direction(Ray3<T>& ray, T offset_x, T offset_y) {
  ray.dx = ray.dx + offset_x;
  ray.dy = ray.dy + offset_y;
  const T ratio = T(1.0) / square_root(ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz);
  ray.dx = ray.dx * ratio;
  ray.dy = ray.dy * ratio;
  ray.dz = ray.dz * ratio;
  return ratio;
}

// The intersection of a ray with a surface, whose own z axis points to +z.
template <class T>
struct Hit {
  T x, y, sag;  // mm; sag from the vertex plane
  T nx, ny, nz;  // unit normal, nz > 0 on the near half of the sphere
  T cos_in_squared;  // of the angle of incidence; negative: the ray misses
  T cos_in;
};

// Intersects a sphere or plane of curvature c with its vertex at z_vertex. The root is the one on the vertex's side of
// the sphere, whether it lies ahead of the ray or behind it: hullin2011 4.1, "strict in-order intersection".
// direction is the sign of dz the path expects. Welford, Aberrations of Optical Systems, 4.3.
template <class T>
HWY_INLINE Hit<T> intersect(const Ray3<T>& ray, T z_vertex, T c, T direction) {
  const T to_plane = (z_vertex - ray.z) / ray.dz;
  const T x = ray.x + to_plane * ray.dx;
  const T y = ray.y + to_plane * ray.dy;
  const T f = c * (x * x + y * y);
  const T g = ray.dz - c * (x * ray.dx + y * ray.dy);
  Hit<T> hit;
  hit.cos_in_squared = g * g - c * f;
  hit.cos_in = square_root(larger(hit.cos_in_squared, T(0.0)));
  const T t = f / (g + direction * hit.cos_in);
  hit.x = x + t * ray.dx;
  hit.y = y + t * ray.dy;
  hit.sag = t * ray.dz;
  hit.nx = T(0.0) - c * hit.x;
  hit.ny = T(0.0) - c * hit.y;
  hit.nz = T(1.0) - c * hit.sag;
  return hit;
}

// A direction.
template <class T>
struct Axis3 {
  T x, y, z;
};

template <class T>
HWY_INLINE T along(const Axis3<T>& axis, T x, T y, T z) {
  return axis.x * x + axis.y * y + axis.z * z;
}

// The same for a tilted surface, with its own axis n (unit, nz > 0) through its vertex, the origin of the ray's
// coordinates. c p.p / 2 = n.p is that sphere or plane; with n = (0, 0, 1) it is the formula above.
template <class T>
HWY_INLINE Hit<T> intersect_tilted(const Ray3<T>& ray, const Axis3<T>& n, T c, T direction) {
  const T towards = along(n, ray.dx, ray.dy, ray.dz);
  const T to_plane = (T(0.0) - along(n, ray.x, ray.y, ray.z)) / towards;
  const T x = ray.x + to_plane * ray.dx;
  const T y = ray.y + to_plane * ray.dy;
  const T z = ray.z + to_plane * ray.dz;
  const T f = c * (x * x + y * y + z * z);
  const T g = towards - c * (x * ray.dx + y * ray.dy + z * ray.dz);
  Hit<T> hit;
  hit.cos_in_squared = g * g - c * f;
  hit.cos_in = square_root(larger(hit.cos_in_squared, T(0.0)));
  const T t = f / (g + direction * hit.cos_in);
  hit.x = x + t * ray.dx;
  hit.y = y + t * ray.dy;
  hit.sag = z + t * ray.dz;
  hit.nx = n.x - c * hit.x;
  hit.ny = n.y - c * hit.y;
  hit.nz = n.z - c * hit.sag;
  return hit;
}

// The hit's x and y in the surface's own frame, and the normal's component along its axis: > 0 on the near half of the
// sphere. The smallest rotation that takes n to +z takes p to p - (n + z) (n + z).p / (1 + nz) + 2 z n.p.
template <class T>
struct SurfaceFramePoint {
  T x, y, nz;
};
template <class T>
HWY_INLINE SurfaceFramePoint<T> surface_frame_point(const Hit<T>& hit, const Axis3<T>& n, T c) {
  const T height = along(n, hit.x, hit.y, hit.sag);
  const T factor = (height + hit.sag) / (T(1.0) + n.z);
  return {hit.x - n.x * factor, hit.y - n.y * factor, T(1.0) - c * height};
}

template <class T>
HWY_INLINE void move_to(Ray3<T>& ray, const Hit<T>& hit, T z_vertex) {
  ray.x = hit.x;
  ray.y = hit.y;
  ray.z = z_vertex + hit.sag;
}

// Snell's law in vector form, eta = n_in / n_out. Returns cos^2 of the angle of refraction; negative for total
// reflection, which leaves an undefined direction.
template <class T>
HWY_INLINE T refract(Ray3<T>& ray, const Hit<T>& hit, T eta, T direction) {
  const T cos_out_squared = T(1.0) - eta * eta * (T(1.0) - hit.cos_in * hit.cos_in);
  const T along_normal = direction * (square_root(larger(cos_out_squared, T(0.0))) - eta * hit.cos_in);
  ray.dx = eta * ray.dx + along_normal * hit.nx;
  ray.dy = eta * ray.dy + along_normal * hit.ny;
  ray.dz = eta * ray.dz + along_normal * hit.nz;
  return cos_out_squared;
}

template <class T>
HWY_INLINE void reflect(Ray3<T>& ray, const Hit<T>& hit, T direction) {
  const T twice = T(2.0) * direction * hit.cos_in;
  ray.dx = ray.dx - twice * hit.nx;
  ray.dy = ray.dy - twice * hit.ny;
  ray.dz = ray.dz - twice * hit.nz;
}

// Amplitude reflection coefficients of one interface; hullin2011 3.1. p in the convention r_p = -r_s at
// normal incidence.
template <class T>
struct Amplitudes {
  T s, p;
};
template <class T>
HWY_INLINE Amplitudes<T> fresnel(T n1, T cos1, T n2, T cos2) {
  return {(n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2), (n2 * cos1 - n1 * cos2) / (n2 * cos1 + n1 * cos2)};
}

template <class T>
HWY_INLINE T mean_power(const Amplitudes<T>& r) {
  return T(0.5) * (r.s * r.s + r.p * r.p);
}

// Two interfaces with a lossless film of phase thickness delta between them, all orders summed (Airy):
// |r01 + r12 e^(2i delta)|^2 / |1 + r01 r12 e^(2i delta)|^2. The same as the film's transfer matrix.
template <class T>
HWY_INLINE T airy_power(T r01, T r12, T cos_two_delta) {
  const T cross = T(2.0) * r01 * r12 * cos_two_delta;
  return (r01 * r01 + r12 * r12 + cross) / (T(1.0) + r01 * r01 * r12 * r12 + cross);
}

// Unpolarised reflectance of one lossless film n1 of phase thickness two_delta_normal / 2 at normal incidence
// between n0 and n2; all three cosines real.
template <class T>
HWY_INLINE T single_film_power(T n0, T cos0, T n1, T cos1, T n2, T cos2, T two_delta_normal) {
  const Amplitudes<T> front = fresnel(n0, cos0, n1, cos1);
  const Amplitudes<T> back = fresnel(n1, cos1, n2, cos2);
  const T phase = cosine(two_delta_normal * cos1);
  return T(0.5) * (airy_power(front.s, back.s, phase) + airy_power(front.p, back.p, phase));
}

}  // namespace contrejour::inline internal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggling guard
