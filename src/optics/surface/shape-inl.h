// SPDX-License-Identifier: Apache-2.0
// Intersects one ray with one surface that is no sphere: docs/physics/surfaces.md. Newton's method solves F = 0, where
// F approximates the distance from the surface and stays smooth beyond the end of the sag's closed form.
// Compiled once per instruction set (foreach_target), as surface-inl.h.
#if defined(CONTREJOUR_KERNELS_SHAPE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_KERNELS_SHAPE_INL_H_
#undef CONTREJOUR_KERNELS_SHAPE_INL_H_
#else
#define CONTREJOUR_KERNELS_SHAPE_INL_H_
#endif

#include <cmath>
#include <type_traits>

#include <hwy/highway.h>

#include "base/inline_if_fast.h"
#include "optics/surface/shape_constants.h"
#include "optics/surface/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::kernels::HWY_NAMESPACE {

HWY_INLINE double smaller(double a, double b) { return a < b ? a : b; }
HWY_INLINE double select(bool use_a, double a, double b) { return use_a ? a : b; }

template <class T>
HWY_INLINE T magnitude(T a) {
  return larger(a, T(0.0) - a);
}

// Approximate height of a point above the surface, 0 on it and positive towards +z, and its gradient.
template <class T>
struct Level {
  T f, gx, gy, gz;
  T reaches;  // negative where the surface does not exist
};

// A polynomial in u = (h / reach)^2, mm, and its derivative by u.
template <class T>
struct Powers {
  T value, by_u;
};
template <class T>
HWY_INLINE Powers<T> powers_at(const ShapeConstants& s, T u) {
  Powers<T> p{T(0.0), T(0.0)};
  if (s.even_terms > 0) {
    T value(s.even[static_cast<std::size_t>(s.even_terms - 1)]);
    T slope(0.0);
    for (int k = s.even_terms - 2; k >= 0; --k) {
      slope = slope * u + value;
      value = value * u + T(s.even[static_cast<std::size_t>(k)]);
    }
    p = {value * u, value + slope * u};
  }
  if (s.odd_terms > 0) {
    constexpr double kAtTip = 1e-12;  // where a cone has no slope
    T value(s.odd[static_cast<std::size_t>(s.odd_terms - 1)]);
    T slope(0.0);
    for (int k = s.odd_terms - 2; k >= 0; --k) {
      slope = slope * u + value;
      value = value * u + T(s.odd[static_cast<std::size_t>(k)]);
    }
    const T root = square_root(larger(u, T(kAtTip)));
    p.value = p.value + root * value;
    p.by_u = p.by_u + root * slope + T(0.5) * value / root;
  }
  return p;
}

// The conic's equation without a square root: w - c (r^2 + (1 + k) w^2) / 2 = 0, with w the height above the
// polynomial.
template <class T>
HWY_INLINE Level<T> revolution_level(const ShapeConstants& s, T x, T y, T z) {
  const T c(s.curvature), q(s.quadratic), per_aperture_squared(s.per_aperture_squared);
  const T r_squared = x * x + y * y;
  const Powers<T> p = powers_at(s, r_squared * per_aperture_squared);
  const T w = z - p.value;
  const T upwards = T(1.0) - q * w;
  const T outwards = c + T(2.0) * per_aperture_squared * p.by_u * upwards;
  return {w - T(0.5) * (c * r_squared + q * w * w), T(0.0) - outwards * x, T(0.0) - outwards * y, upwards, T(1.0)};
}

// Lower limit of the squared root in the profile's sag, which bounds the slope near the profile's end.
inline constexpr double kMinSquaredRoot = 1e-6;

// z - c_x (x^2 + z^2) / 2 - w + c_x w^2 / 2 = 0, with w the profile at y.
template <class T>
HWY_INLINE Level<T> toroid_level(const ShapeConstants& s, T x, T y, T z) {
  const T one(1.0), half(0.5);
  const T c(s.curvature), cx(s.curvature_x), per_aperture_squared(s.per_aperture_squared);
  const T y_squared = y * y;
  const T root_squared = one - c * T(s.quadratic) * y_squared;
  const T root = square_root(larger(root_squared, T(kMinSquaredRoot)));
  const Powers<T> p = powers_at(s, y_squared * per_aperture_squared);
  const T w = c * y_squared / (one + root) + p.value;
  const T slope = y * (c / root + T(2.0) * per_aperture_squared * p.by_u);
  return {z - half * cx * (x * x + z * z) - w + half * cx * w * w, T(0.0) - cx * x, T(0.0) - slope * (one - cx * w),
          one - cx * z, root_squared};
}

template <class T>
HWY_INLINE Level<T> biconic_level(const ShapeConstants& s, T x, T y, T z) {
  const T one(1.0), two(2.0);
  const T cx(s.curvature_x), cy(s.curvature);
  const T by_x = cx * T(s.quadratic_x), by_y = cy * T(s.quadratic);
  const T root_squared = one - by_x * x * x - by_y * y * y;
  const T root = square_root(larger(root_squared, T(kMinSquaredRoot)));
  const T factor = one / (one + root);
  const T sag = (cx * x * x + cy * y * y) * factor;
  const T steeper = sag / root;
  return {z - sag, T(0.0) - x * factor * (two * cx + steeper * by_x), T(0.0) - y * factor * (two * cy + steeper * by_y),
          one, root_squared};
}

template <ShapeKind kKind, class T>
HWY_INLINE Level<T> level_at(const ShapeConstants& s, T x, T y, T z) {
  if constexpr (kKind == ShapeKind::Revolution) return revolution_level(s, x, y, z);
  if constexpr (kKind == ShapeKind::Toroid) return toroid_level(s, x, y, z);
  if constexpr (kKind == ShapeKind::Biconic) return biconic_level(s, x, y, z);
}

// Limits of Newton's method: the number of steps, and the largest accepted distance from the surface (mm). Packets take
// all steps; a scalar stops when it has converged.
struct NewtonLimits {
  int steps = 0;
  double residual_mm = 0;
};

// Lower limit of cos(incidence), which bounds the steps of grazing rays.
inline constexpr double kMinCosine = 1.0 / 64;
// Converged step over the reach: the next step would be below rounding.
inline constexpr double kConvergedStep = 1e-9;

// Intersects a ray from its point on the vertex plane, in the surface's own frame. The root is the one of the sphere's
// formula: on the vertex's side and crossed in the direction of the path, ahead of the ray or behind it.
template <ShapeKind kKind, class T>
CONTREJOUR_INLINE_IF_FAST Hit<T> search(const Ray3<T>& from, const ShapeConstants& s, T direction,
                                        const NewtonLimits& limits) {
  const T zero(0.0);
  const T sx(s.start_x), sy(s.start_y), sz(s.start_z);
  const T a = sx * from.dx * from.dx + sy * from.dy * from.dy + sz * from.dz * from.dz;
  const T b = from.dz - sx * from.x * from.dx - sy * from.y * from.dy;
  const T c = sx * from.x * from.x + sy * from.y * from.y;
  const T start_squared = b * b - a * c;
  const T longest(s.aperture_mm), farthest(8.0 * s.aperture_mm);
  T t = c / (b + direction * square_root(larger(start_squared, zero)));
  t = larger(smaller(t, farthest), zero - farthest);

  Level<T> level = level_at<kKind>(s, from.x + t * from.dx, from.y + t * from.dy, t * from.dz);
  bool there = false;
  for (int k = 0; k < limits.steps && !there; ++k) {
    const T rises = direction * (level.gx * from.dx + level.gy * from.dy + level.gz * from.dz);
    const T step = direction * level.f / larger(rises, T(kMinCosine));
    t = t - larger(smaller(step, longest), zero - longest);
    if constexpr (std::is_same_v<T, double>) there = std::abs(step) <= kConvergedStep * s.aperture_mm;
    level = level_at<kKind>(s, from.x + t * from.dx, from.y + t * from.dy, t * from.dz);
  }

  const T per_gradient = T(1.0) / square_root(level.gx * level.gx + level.gy * level.gy + level.gz * level.gz);
  const T cos_in = direction * per_gradient * (level.gx * from.dx + level.gy * from.dy + level.gz * from.dz);
  const T off = magnitude(level.f) * per_gradient;
  const T meets = smaller(cos_in * magnitude(cos_in), level.reaches);
  const T misses = select(zero > start_squared, start_squared, zero - smaller(off * T(1.0 / s.aperture_mm), T(1.0)));
  Hit<T> hit;
  hit.cos_in_squared = select(T(limits.residual_mm) > off, meets, misses);
  hit.cos_in = larger(cos_in, zero);
  hit.x = from.x + t * from.dx;
  hit.y = from.y + t * from.dy;
  hit.sag = t * from.dz;
  hit.nx = level.gx * per_gradient;
  hit.ny = level.gy * per_gradient;
  hit.nz = level.gz * per_gradient;
  return hit;
}

// As intersect(), for a surface about the z axis whose vertex is at z_vertex.
template <class T>
HWY_INLINE Hit<T> intersect_shape(const Ray3<T>& ray, T z_vertex, const ShapeConstants& s, T direction,
                                  const NewtonLimits& limits) {
  const T to_plane = (z_vertex - ray.z) / ray.dz;
  Ray3<T> from = ray;
  from.x = ray.x + to_plane * ray.dx;
  from.y = ray.y + to_plane * ray.dy;
  if (s.kind == ShapeKind::Revolution) return search<ShapeKind::Revolution>(from, s, direction, limits);
  const T cosine(s.cos_rotation), sine(s.sin_rotation);
  const auto rotate = [&](T& x, T& y, T sin_rotation) {
    const T rotated_x = cosine * x + sin_rotation * y;
    y = cosine * y - sin_rotation * x;
    x = rotated_x;
  };
  if (s.rotated) {
    rotate(from.x, from.y, sine);
    rotate(from.dx, from.dy, sine);
  }
  Hit<T> hit = s.kind == ShapeKind::Toroid ? search<ShapeKind::Toroid>(from, s, direction, limits)
                                           : search<ShapeKind::Biconic>(from, s, direction, limits);
  if (s.rotated) {
    rotate(hit.x, hit.y, T(0.0) - sine);
    rotate(hit.nx, hit.ny, T(0.0) - sine);
  }
  return hit;
}

// Limits for a single ray in double precision, which suffices for surfaces of any size.
HWY_INLINE NewtonLimits exact_limits(const ShapeConstants& s) {
  return {.steps = 50, .residual_mm = 1e-12 * (s.aperture_mm > 1.0 ? s.aperture_mm : 1.0)};
}

// The smallest rotation that takes n to +z, and its inverse.
template <class T>
HWY_INLINE void rotate_to_surface_frame(const Axis3<T>& n, T& x, T& y, T& z) {
  const T height = along(n, x, y, z);
  const T factor = (height + z) / (T(1.0) + n.z);
  x = x - n.x * factor;
  y = y - n.y * factor;
  z = height;
}
template <class T>
HWY_INLINE void rotate_back(const Axis3<T>& n, T& x, T& y, T& z) {
  const T across = n.x * x + n.y * y;
  const T factor = z - across / (T(1.0) + n.z);
  x = x + n.x * factor;
  y = y + n.y * factor;
  z = n.z * z - across;
}

}  // namespace contrejour::inline internal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggling guard
