// SPDX-License-Identifier: Apache-2.0
// One ray at a surface that is no sphere: the formulas of optics/surface/shape-inl.h under the same names. A shape is
// read where it lies: its constants as numbers, their layout as written by layout.cpp.
#define SHAPE_CURVATURE 0
#define SHAPE_CURVATURE_X 1
#define SHAPE_QUADRATIC 2
#define SHAPE_QUADRATIC_X 3
#define SHAPE_APERTURE 4
#define SHAPE_PER_APERTURE_SQUARED 5
#define SHAPE_COS 6
#define SHAPE_SIN 7
#define SHAPE_START_X 8
#define SHAPE_START_Y 9
#define SHAPE_START_Z 10
#define SHAPE_EVEN 11

struct Shape {
  int reals, kind, even_terms, odd_terms;  // reals: where the numbers begin
  bool rotated;
};
struct Level {
  real f, gx, gy, gz, reaches;
};
struct Powers {
  real value, by_u;
};

#ifdef DOUBLE
#define NEWTON_STEPS 5
#define NEWTON_RESIDUAL_MM 1e-6
#else
#define NEWTON_STEPS 4
#define NEWTON_RESIDUAL_MM 1e-4
#endif
#define MIN_SQUARED_ROOT 1e-6
#define MIN_COSINE 0.015625
#define AT_TIP 1e-12

real constant(Shape s, int k) { return path_number(uint(s.reals + k)); }

void polynomial(int first, int terms, real u, out real value, out real slope) {
  value = path_number(uint(first + terms - 1));
  slope = real(0.0);
  for (int k = terms - 2; k >= 0; --k) {
    slope = slope * u + value;
    value = value * u + path_number(uint(first + k));
  }
}

Powers powers_at(Shape s, real u) {
  Powers sum = Powers(real(0.0), real(0.0));
  real value, slope;
  if (s.even_terms > 0) {
    polynomial(s.reals + SHAPE_EVEN, s.even_terms, u, value, slope);
    sum = Powers(value * u, value + slope * u);
  }
  if (s.odd_terms > 0) {
    polynomial(s.reals + SHAPE_EVEN + s.even_terms, s.odd_terms, u, value, slope);
    real root = square_root(max(u, real(AT_TIP)));
    sum.value += root * value;
    sum.by_u += root * slope + real(0.5) * value / root;
  }
  return sum;
}

Level revolution_level(Shape s, real x, real y, real z) {
  real c = constant(s, SHAPE_CURVATURE), q = constant(s, SHAPE_QUADRATIC);
  real per_aperture_squared = constant(s, SHAPE_PER_APERTURE_SQUARED);
  real r_squared = x * x + y * y;
  Powers sum = powers_at(s, r_squared * per_aperture_squared);
  real w = z - sum.value;
  real upwards = real(1.0) - q * w;
  real outwards = c + real(2.0) * per_aperture_squared * sum.by_u * upwards;
  return Level(w - real(0.5) * (c * r_squared + q * w * w), -outwards * x, -outwards * y, upwards, real(1.0));
}

Level toroid_level(Shape s, real x, real y, real z) {
  real c = constant(s, SHAPE_CURVATURE), cx = constant(s, SHAPE_CURVATURE_X);
  real per_aperture_squared = constant(s, SHAPE_PER_APERTURE_SQUARED);
  real y_squared = y * y;
  real root_squared = real(1.0) - c * constant(s, SHAPE_QUADRATIC) * y_squared;
  real root = square_root(max(root_squared, real(MIN_SQUARED_ROOT)));
  Powers sum = powers_at(s, y_squared * per_aperture_squared);
  real w = c * y_squared / (real(1.0) + root) + sum.value;
  real slope = y * (c / root + real(2.0) * per_aperture_squared * sum.by_u);
  return Level(z - real(0.5) * cx * (x * x + z * z) - w + real(0.5) * cx * w * w, -cx * x, -slope * (real(1.0) - cx * w),
               real(1.0) - cx * z, root_squared);
}

Level biconic_level(Shape s, real x, real y, real z) {
  real cx = constant(s, SHAPE_CURVATURE_X), cy = constant(s, SHAPE_CURVATURE);
  real by_x = cx * constant(s, SHAPE_QUADRATIC_X), by_y = cy * constant(s, SHAPE_QUADRATIC);
  real root_squared = real(1.0) - by_x * x * x - by_y * y * y;
  real root = square_root(max(root_squared, real(MIN_SQUARED_ROOT)));
  real factor = real(1.0) / (real(1.0) + root);
  real sag = (cx * x * x + cy * y * y) * factor;
  real steeper = sag / root;
  return Level(z - sag, -x * factor * (real(2.0) * cx + steeper * by_x), -y * factor * (real(2.0) * cy + steeper * by_y),
               real(1.0), root_squared);
}

Level level_at(Shape s, real x, real y, real z) {
  if (s.kind == 0) return revolution_level(s, x, y, z);
  if (s.kind == 1) return toroid_level(s, x, y, z);
  return biconic_level(s, x, y, z);
}

Hit search(Ray3 from, Shape s, real direction) {
  real sx = constant(s, SHAPE_START_X), sy = constant(s, SHAPE_START_Y), sz = constant(s, SHAPE_START_Z);
  real a = sx * from.dx * from.dx + sy * from.dy * from.dy + sz * from.dz * from.dz;
  real b = from.dz - sx * from.x * from.dx - sy * from.y * from.dy;
  real c = sx * from.x * from.x + sy * from.y * from.y;
  real start_squared = b * b - a * c;
  real longest = constant(s, SHAPE_APERTURE), farthest = real(8.0) * longest;
  real t = c / (b + direction * square_root(max(start_squared, real(0.0))));
  t = max(min(t, farthest), -farthest);

  Level level = level_at(s, from.x + t * from.dx, from.y + t * from.dy, t * from.dz);
  for (int k = 0; k < NEWTON_STEPS; ++k) {
    real rises = direction * (level.gx * from.dx + level.gy * from.dy + level.gz * from.dz);
    real by = direction * level.f / max(rises, real(MIN_COSINE));
    t -= max(min(by, longest), -longest);
    level = level_at(s, from.x + t * from.dx, from.y + t * from.dy, t * from.dz);
  }

  real per_gradient = real(1.0) / square_root(level.gx * level.gx + level.gy * level.gy + level.gz * level.gz);
  real cos_in = direction * per_gradient * (level.gx * from.dx + level.gy * from.dy + level.gz * from.dz);
  real off = abs(level.f) * per_gradient;
  real meets = min(cos_in * abs(cos_in), level.reaches);
  real misses = start_squared < real(0.0) ? start_squared : -min(off / longest, real(1.0));
  Hit hit;
  hit.cos_in_squared = real(NEWTON_RESIDUAL_MM) > off ? meets : misses;
  hit.cos_in = max(cos_in, real(0.0));
  hit.x = from.x + t * from.dx;
  hit.y = from.y + t * from.dy;
  hit.sag = t * from.dz;
  hit.nx = level.gx * per_gradient;
  hit.ny = level.gy * per_gradient;
  hit.nz = level.gz * per_gradient;
  return hit;
}

void rotate_about_axis(inout real x, inout real y, real cosine, real sine) {
  real rotated_x = cosine * x + sine * y;
  y = cosine * y - sine * x;
  x = rotated_x;
}

Hit intersect_shape(Ray3 ray, real z_vertex, Shape s, real direction) {
  real to_plane = (z_vertex - ray.z) / ray.dz;
  Ray3 from = ray;
  from.x = ray.x + to_plane * ray.dx;
  from.y = ray.y + to_plane * ray.dy;
  real cosine = constant(s, SHAPE_COS), sine = constant(s, SHAPE_SIN);
  bool rotates = s.kind != 0 && s.rotated;
  if (rotates) {
    rotate_about_axis(from.x, from.y, cosine, sine);
    rotate_about_axis(from.dx, from.dy, cosine, sine);
  }
  Hit hit = search(from, s, direction);
  if (rotates) {
    rotate_about_axis(hit.x, hit.y, cosine, -sine);
    rotate_about_axis(hit.nx, hit.ny, cosine, -sine);
  }
  return hit;
}
