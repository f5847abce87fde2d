// Where packets of rays meet a step's surface, of lenses that are centred and of those that are not: one is compiled
// without what only the other needs. Compiled once per instruction set (foreach_target).
#if defined(CONTREJOUR_TRACE_MEETING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_TRACE_MEETING_INL_H_
#undef CONTREJOUR_TRACE_MEETING_INL_H_
#else
#define CONTREJOUR_TRACE_MEETING_INL_H_
#endif

#include <hwy/highway.h>

#include "kernels/surface-inl.h"
#include "optics/trace/packet_trace.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::HWY_NAMESPACE {

// The ray's coordinates begin at the vertex before; afterwards at the step's. own: the hit's place beside the surface's
// own axis. (Two results: compilers keep one large struct of vectors in memory, at half the speed.)
template <bool kCentred, class P>
HWY_INLINE kernels::HWY_NAMESPACE::Hit<P> meet(kernels::HWY_NAMESPACE::Ray3<P>& ray, const PacketStep& step,
                                               kernels::HWY_NAMESPACE::OwnPlace<P>& own) {
  namespace hk = kernels::HWY_NAMESPACE;
  const P c(step.curvature_per_mm);
  const P direction(step.direction);
  if constexpr (kCentred) {
    const auto hit = hk::intersect(ray, P(step.gap_mm), c, direction);
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
    const auto hit = hk::intersect_askew(ray, axis, c, direction);
    hk::move_to(ray, hit, P(0.0));
    own = hk::own_place(hit, axis, c);
    return hit;
  }
}

}  // namespace contrejour::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // toggling guard
