// SPDX-License-Identifier: Apache-2.0
// Barycentric coordinates of a point in a convex quadrilateral, or in the two triangles it is split into:
// bodonyi2023 3.4. Templated on the number type T: double, or a packet of floats. Compiled once per instruction
// set (Highway's foreach_target), hence the toggling guard in place of an ordinary one.
#if defined(CONTREJOUR_KERNELS_BARYCENTRIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_KERNELS_BARYCENTRIC_INL_H_
#undef CONTREJOUR_KERNELS_BARYCENTRIC_INL_H_
#else
#define CONTREJOUR_KERNELS_BARYCENTRIC_INL_H_
#endif

#include <cmath>

#include <hwy/highway.h>

#include "optics/surface/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::kernels::HWY_NAMESPACE {

// The scalar counterpart of the packets' select (packet-inl.h).
HWY_INLINE double select(bool use_a, double a, double b) { return use_a ? a : b; }

// Corners are in order, so that the shoelace area is positive. A triangle repeats its first corner as the fourth.
template <class T>
struct Quad {
  T x[4], y[4];
};

// A quadrilateral relative to a point v: the corners minus v, and edge[i] = 2 A(v, v_i, v_i+1). All four are >= 0 when
// v is inside. Reversing an edge negates the expression exactly, so of two neighbours that share an edge exactly one
// contains a point next to it.
template <class T>
struct RelativeQuad {
  T x[4], y[4], edge[4];
};

template <class T>
HWY_INLINE RelativeQuad<T> relative_to(const Quad<T>& quad, T x, T y) {
  RelativeQuad<T> s;
  for (int i = 0; i < 4; ++i) {
    s.x[i] = quad.x[i] - x;
    s.y[i] = quad.y[i] - y;
  }
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    s.edge[i] = s.x[i] * s.y[j] - s.x[j] * s.y[i];
  }
  return s;
}

// The coordinates are w[i] / total.
template <class T>
struct Weights {
  T w[4], total;
};

template <class T>
HWY_INLINE T weighted_sum(const Weights<T>& weights, const T (&value)[4]) {
  return (weights.w[0] * value[0] + weights.w[1] * value[1]) + (weights.w[2] * value[2] + weights.w[3] * value[3]);
}

// Each method below is constructed for a quadrilateral and then evaluated at points inside it.

// The triangles (0, 1, 2) and (0, 2, 3), each by its inverse matrix: bodonyi2023 eq. 3 and 4.
template <class T>
class TriangleByMatrix {
 public:
  HWY_INLINE explicit TriangleByMatrix(const Quad<T>& q) : first_(q, 1, 2), second_(q, 2, 3) {}

  HWY_INLINE Weights<T> at(const RelativeQuad<T>& s) const {
    const T zero(0.0);
    const T one(1.0);
    const auto is_second = zero > s.x[2] * s.y[0] - s.x[0] * s.y[2];
    const T bx = zero - s.x[0];
    const T by = zero - s.y[0];
    const T a = select(is_second, second_.xx, first_.xx) * bx + select(is_second, second_.xy, first_.xy) * by;
    const T b = select(is_second, second_.yx, first_.yx) * bx + select(is_second, second_.yy, first_.yy) * by;
    return {{one - a - b, select(is_second, zero, a), select(is_second, a, b), select(is_second, b, zero)}, one};
  }

 private:
  struct Inverse {
    T xx, xy, yx, yy;

    HWY_INLINE Inverse(const Quad<T>& q, int i, int j) {
      const T ax = q.x[i] - q.x[0];
      const T ay = q.y[i] - q.y[0];
      const T bx = q.x[j] - q.x[0];
      const T by = q.y[j] - q.y[0];
      const T scale = T(1.0) / (ax * by - bx * ay);
      xx = by * scale;
      xy = T(0.0) - bx * scale;
      yx = T(0.0) - ay * scale;
      yy = ax * scale;
    }
  };

  Inverse first_, second_;
};

// The same two triangles by the cross product in homogeneous coordinates: skala2008, bodonyi2023 eq. 5 and 6.
// Its components are twice the areas of the triangles of the point and the edges; the only division is at the end.
template <class T>
class TriangleByCrossProduct {
 public:
  HWY_INLINE explicit TriangleByCrossProduct(const Quad<T>&) {}

  HWY_INLINE Weights<T> at(const RelativeQuad<T>& s) const {
    const T zero(0.0);
    const T diagonal = s.x[2] * s.y[0] - s.x[0] * s.y[2];
    const auto is_second = zero > diagonal;
    Weights<T> out;
    out.w[0] = select(is_second, s.edge[2], s.edge[1]);
    out.w[1] = select(is_second, zero, diagonal);
    out.w[2] = select(is_second, s.edge[3], s.edge[0]);
    out.w[3] = select(is_second, zero - diagonal, zero);
    out.total = (out.w[0] + out.w[1]) + (out.w[2] + out.w[3]);
    return out;
  }
};

// Mean value coordinates: hormann2004, bodonyi2023 eq. 7.
template <class T>
class MeanValue {
 public:
  HWY_INLINE explicit MeanValue(const Quad<T>&) {}

  HWY_INLINE Weights<T> at(const RelativeQuad<T>& s) const {
    // In squared pixels and in pixels: replaces 0 for a point on an edge or a corner.
    const T tiny(1e-30);
    const T corner(1e-12);
    const T all(1e30);
    T r[4], tangent[4];
    for (int i = 0; i < 4; ++i) r[i] = square_root(s.x[i] * s.x[i] + s.y[i] * s.y[i]);
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      const T product = r[i] * r[j];
      const T dot = s.x[i] * s.x[j] + s.y[i] * s.y[j];
      // tan(alpha / 2) = sin / (1 + cos) = (1 - cos) / sin: the form without cancellation is used.
      const auto is_acute = dot > T(0.0);
      tangent[i] =
          select(is_acute, s.edge[i], product - dot) / larger(select(is_acute, product + dot, s.edge[i]), tiny);
    }
    Weights<T> out;
    for (int i = 0; i < 4; ++i) {
      out.w[i] = select(corner > r[i], all, (tangent[(i + 3) % 4] + tangent[i]) / larger(r[i], corner));
    }
    out.total = (out.w[0] + out.w[1]) + (out.w[2] + out.w[3]);
    return out;
  }
};

// wachspress1975: w_i = A(v_i-1, v_i, v_i+1) * product of A(v, v_j, v_j+1) over the two edges j not at v_i.
// bodonyi2023 eq. 9 prints v_j+1 in the first factor, where j has no meaning yet: it must be v_i+1.
template <class T>
class Wachspress {
 public:
  HWY_INLINE explicit Wachspress(const Quad<T>& q) {
    for (int i = 0; i < 4; ++i) {
      const int before = (i + 3) % 4;
      const int after = (i + 1) % 4;
      corner_[i] = (q.x[i] - q.x[before]) * (q.y[after] - q.y[i]) - (q.x[after] - q.x[i]) * (q.y[i] - q.y[before]);
    }
  }

  HWY_INLINE Weights<T> at(const RelativeQuad<T>& s) const {
    Weights<T> out;
    for (int i = 0; i < 4; ++i) out.w[i] = corner_[i] * (s.edge[(i + 1) % 4] * s.edge[(i + 2) % 4]);
    out.total = (out.w[0] + out.w[1]) + (out.w[2] + out.w[3]);
    return out;
  }

 private:
  T corner_[4];
};

// loop1989, bodonyi2023 eq. 10: Wachspress without the corners' areas. Linear functions come out exactly in
// parallelograms only, where those are equal.
template <class T>
class LoopDeRose {
 public:
  HWY_INLINE explicit LoopDeRose(const Quad<T>&) {}

  HWY_INLINE Weights<T> at(const RelativeQuad<T>& s) const {
    Weights<T> out;
    for (int i = 0; i < 4; ++i) out.w[i] = s.edge[(i + 1) % 4] * s.edge[(i + 2) % 4];
    out.total = (out.w[0] + out.w[1]) + (out.w[2] + out.w[3]);
    return out;
  }
};

}  // namespace contrejour::inline internal::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggling guard
