// SPDX-License-Identifier: Apache-2.0
#include "optics/trace/clearance.h"

#include "base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics/trace/clearance.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/inline_if_fast.h"
#include "optics/surface/packet-inl.h"
#include "optics/surface/quick_packet-inl.h"
#include "optics/trace/meeting-inl.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

namespace hk = kernels::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;

template <class P>
struct Clearance {
  hk::Ray3<P> ray;
  P alive;                      // 1 or 0
  P passed;                     // number of tests passed while alive
  P margin;                     // of the last test while alive; <= 0: the ray failed
  P rim_x, rim_y, rim_squared;  // where the relative height is largest
};

template <class P>
HWY_INLINE void test(Clearance<P>& s, P must_be_positive) {
  const P zero(0.0);
  s.margin = select(s.alive > zero, must_be_positive, s.margin);
  s.alive = select(must_be_positive > zero, s.alive, zero);
  s.passed = s.passed + s.alive;
}

template <class P>
HWY_INLINE void deflect_by_grating(Clearance<P>& s, const PacketStep& step) {
  const P zero(0.0);
  s.ray.dx = s.ray.dx + P(step.grating_shift.x);
  s.ray.dy = s.ray.dy + P(step.grating_shift.y);
  const P along_squared = P(1.0) - s.ray.dx * s.ray.dx - s.ray.dy * s.ray.dy;
  test(s, along_squared);
  const P along = square_root(larger(along_squared, zero));
  s.ray.dz = select(s.ray.dz > zero, along, zero - along);
}

// Rays that fail continue with meaningless numbers.
template <PathGeometry kGeometry, class P>
CONTREJOUR_INLINE_IF_FAST void advance(Clearance<P>& s, const PacketStep& step) {
  const P direction(step.direction);
  hk::SurfaceFramePoint<P> own;
  const auto hit = meet<kGeometry>(s.ray, step, own);
  test(s, smaller(hit.cos_in_squared, own.nz));
  if (step.event == PathEvent::Stop) return;
  P rim_x, rim_y;
  if constexpr (kGeometry == PathGeometry::General) {
    if (step.blocks_within) return;
    const auto point = rim_point(own, step.rim);
    rim_x = point.x;
    rim_y = point.y;
  } else {
    const P per_mm(step.inverse_semi_diameter_per_mm);
    rim_x = own.x * per_mm;
    rim_y = own.y * per_mm;
  }
  const P rim_squared = rim_x * rim_x + rim_y * rim_y;
  const auto farther = rim_squared > s.rim_squared;
  s.rim_x = select(farther, rim_x, s.rim_x);
  s.rim_y = select(farther, rim_y, s.rim_y);
  s.rim_squared = larger(s.rim_squared, rim_squared);
  if (step.event == PathEvent::Reflect) {
    hk::reflect(s.ray, hit, direction);
    if constexpr (kGeometry == PathGeometry::General) {
      if (step.efficiency != 1.0) deflect_by_grating(s, step);
    }
    return;
  }
  test(s, hk::refract(s.ray, hit, P(step.eta), direction));
}

template <class P>
HWY_INLINE Clearance<P> enter(const PacketStart& start, const float* x_mm, const float* y_mm) {
  const typename P::Tag d;
  const P x(hk::load_floats(d, x_mm));
  const P y(hk::load_floats(d, y_mm));
  Clearance<P> s{{P(start.origin_mm.x) + x, P(start.origin_mm.y) + y, P(0.0), P(start.direction.x),
                  P(start.direction.y), P(start.direction.z)},
                 P(1.0),
                 P(0.0),
                 P(1.0),
                 P(0.0),
                 P(0.0),
                 P(0.0)};
  if (start.diverges) hk::perturb_direction(s.ray, x * P(start.per_distance_mm), y * P(start.per_distance_mm));
  return s;
}

template <class P>
HWY_INLINE void leave(Clearance<P>& s, std::size_t at, const ClearanceArrays& out) {
  test(s, s.ray.dz);
  store_floats(select(s.alive > P(0.0), P(0.0), P(0.0) - s.margin), out.failing + at);
  store_floats(s.passed, out.passed + at);
  store_floats(s.rim_x, out.rim_x + at);
  store_floats(s.rim_y, out.rim_y + at);
}

// Two packets at once: a single one waits for its own results most of the time.
template <PathGeometry kGeometry, class P>
void trace_all(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
               const ClearanceArrays& out) {
  const std::size_t lanes = hn::Lanes(typename P::Tag());
  const P per_radius(path.inverse_stop_radius_per_mm());
  for (std::size_t at = 0; at < count; at += 2 * lanes) {
    Clearance<P> a = enter<P>(path.start(), x_mm + at, y_mm + at);
    Clearance<P> b = enter<P>(path.start(), x_mm + at + lanes, y_mm + at + lanes);
    for (const PacketStep& step : path.steps()) {
      advance<kGeometry>(a, step);
      advance<kGeometry>(b, step);
      if (step.event != PathEvent::Stop) continue;
      float* x = out.stop_x[static_cast<std::size_t>(step.crossing)] + at;
      float* y = out.stop_y[static_cast<std::size_t>(step.crossing)] + at;
      store_floats(a.ray.x * per_radius, x);
      store_floats(a.ray.y * per_radius, y);
      store_floats(b.ray.x * per_radius, x + lanes);
      store_floats(b.ray.y * per_radius, y + lanes);
    }
    leave(a, at, out);
    leave(b, at + lanes, out);
  }
}

template <class P>
void trace_any(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
               const ClearanceArrays& out) {
  switch (path.geometry()) {
    case PathGeometry::Spheres: return trace_all<PathGeometry::Spheres, P>(path, x_mm, y_mm, count, out);
    case PathGeometry::Shapes: return trace_all<PathGeometry::Shapes, P>(path, x_mm, y_mm, count, out);
    case PathGeometry::General: return trace_all<PathGeometry::General, P>(path, x_mm, y_mm, count, out);
  }
}

void clearance_float(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
                     const ClearanceArrays& out) {
  trace_any<hk::QuickPacket>(path, x_mm, y_mm, count, out);
}

void clearance_double(const PacketPath& path, const float* x_mm, const float* y_mm, std::size_t count,
                      const ClearanceArrays& out) {
  trace_any<hk::PrecisePacket>(path, x_mm, y_mm, count, out);
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace contrejour::inline internal {

HWY_EXPORT(clearance_float);
HWY_EXPORT(clearance_double);

static_assert(kClearancePadding * sizeof(float) >= 2 * HWY_MAX_BYTES);

void trace_clearance(const PacketPath& path, PacketPrecision precision, const float* x_mm, const float* y_mm,
                     std::size_t count, const ClearanceArrays& out) {
  if (precision == PacketPrecision::Double) {
    HWY_DYNAMIC_DISPATCH(clearance_double)(path, x_mm, y_mm, count, out);
  } else {
    HWY_DYNAMIC_DISPATCH(clearance_float)(path, x_mm, y_mm, count, out);
  }
}

}  // namespace contrejour::inline internal
#endif  // HWY_ONCE
