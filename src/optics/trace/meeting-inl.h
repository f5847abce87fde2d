// SPDX-License-Identifier: Apache-2.0
// Intersects packets of rays with a step's surface. Each geometry is compiled separately, without what only the others
// need. Compiled once per instruction set (foreach_target).
#if defined(CONTREJOUR_TRACE_MEETING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_TRACE_MEETING_INL_H_
#undef CONTREJOUR_TRACE_MEETING_INL_H_
#else
#define CONTREJOUR_TRACE_MEETING_INL_H_
#endif

#include <hwy/highway.h>

#include "optics/surface/packet-inl.h"
#include "optics/surface/shape-inl.h"
#include "optics/surface/surface-inl.h"
#include "optics/trace/packet_trace.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::HWY_NAMESPACE {

// Newton's limits for packets. Float is accurate to 2e-5 mm on the steepest surfaces, with approximate quotients;
// results of double are stored as float.
template <class P>
inline constexpr kernels::HWY_NAMESPACE::NewtonLimits kPacketLimits{.steps = 4, .residual_mm = 1e-4};
#if HWY_HAVE_FLOAT64
template <>
inline constexpr kernels::HWY_NAMESPACE::NewtonLimits kPacketLimits<kernels::HWY_NAMESPACE::Packet<double>>{
    .steps = 5, .residual_mm = 1e-6};
#endif

template <class P>
struct RimPoint {
  P x, y;
};

// As Rim::coordinates().
template <class P>
HWY_INLINE RimPoint<P> rim_point(const kernels::HWY_NAMESPACE::SurfaceFramePoint<P>& own, const Rim& rim) {
  const P x = own.x - P(rim.centre_mm.x), y = own.y - P(rim.centre_mm.y);
  return {P(rim.u_per_mm.x) * x + P(rim.u_per_mm.y) * y, P(rim.v_per_mm.x) * x + P(rim.v_per_mm.y) * y};
}

// The origin of the ray's coordinates is the preceding vertex; afterwards it is the step's. own: the hit in the
// surface's own frame. (There are two results because compilers keep one large struct of vectors in memory, at half the
// speed.)
template <PathGeometry kGeometry, class P>
HWY_INLINE kernels::HWY_NAMESPACE::Hit<P> meet(kernels::HWY_NAMESPACE::Ray3<P>& ray, const PacketStep& step,
                                               kernels::HWY_NAMESPACE::SurfaceFramePoint<P>& own) {
  namespace hk = kernels::HWY_NAMESPACE;
  const P c(step.curvature_per_mm);
  const P direction(step.direction);
  if constexpr (kGeometry != PathGeometry::General) {
    hk::Hit<P> hit;
    if (kGeometry == PathGeometry::Shapes && step.shape != nullptr) {
      hit = hk::intersect_shape(ray, P(step.gap_mm), *step.shape, direction, kPacketLimits<P>);
    } else {
      hit = hk::intersect(ray, P(step.gap_mm), c, direction);
    }
    hk::move_to(ray, hit, P(0.0));
    own.x = hit.x;
    own.y = hit.y;
    own.nz = hit.nz;
    return hit;
  } else {
    const hk::Axis3<P> axis{P(step.axis.x), P(step.axis.y), P(step.axis.z)};
    ray.x = ray.x - P(step.offset_mm.x);
    ray.y = ray.y - P(step.offset_mm.y);
    ray.z = ray.z - P(step.gap_mm);
    hk::Hit<P> hit;
    if (step.shape != nullptr) {
      hk::Ray3<P> upright = ray;
      hk::rotate_to_surface_frame(axis, upright.x, upright.y, upright.z);
      hk::rotate_to_surface_frame(axis, upright.dx, upright.dy, upright.dz);
      hit = hk::intersect_shape(upright, P(0.0), *step.shape, direction, kPacketLimits<P>);
      own.x = hit.x;
      own.y = hit.y;
      own.nz = hit.nz;
      hk::rotate_back(axis, hit.x, hit.y, hit.sag);
      hk::rotate_back(axis, hit.nx, hit.ny, hit.nz);
    } else {
      hit = hk::intersect_tilted(ray, axis, c, direction);
      own = hk::surface_frame_point(hit, axis, c);
    }
    hk::move_to(ray, hit, P(0.0));
    return hit;
  }
}

}  // namespace contrejour::inline internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggling guard
