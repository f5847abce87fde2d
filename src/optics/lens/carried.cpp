// SPDX-License-Identifier: Apache-2.0
#include "optics/lens/carried.h"

#include "optics/surface/shape-inl.h"

namespace contrejour::inline internal {

SurfacePose carried(const SurfacePose& body, double behind_mm, const SurfacePose& own) {
  if (own == SurfacePose{}) return {body.shift_mm + (body.axis - Vec3{0, 0, 1}) * behind_mm, body.axis};
  namespace hk = kernels::HWY_NAMESPACE;
  const auto rotated = [&](Vec3 v) {
    hk::rotate_back(hk::Axis3<double>{body.axis.x, body.axis.y, body.axis.z}, v.x, v.y, v.z);
    return v;
  };
  const Vec3 before_rotation{0.0, 0.0, behind_mm};
  return {body.shift_mm + rotated(own.shift_mm + before_rotation) - before_rotation, rotated(own.axis)};
}

}  // namespace contrejour::inline internal
