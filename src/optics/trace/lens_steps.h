// SPDX-License-Identifier: Apache-2.0
// A lens at one wavelength: all steps that a ghost's path can contain, prepared for packets.
#pragma once

#include <array>
#include <vector>

#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal {

class LensSteps {
 public:
  // Both must outlive this.
  LensSteps(const LensState& lens, const ReflectanceTables& tables);

  // The steps of a surface for light from the front or from behind, its own rims first. Lengths from the preceding
  // vertex are not set: they depend on the path.
  struct AtSurface {
    std::vector<PacketStep> steps;
    Vec3 vertex_mm;
    PathGeometry geometry = PathGeometry::Spheres;
    std::vector<std::shared_ptr<const ShapeConstants>> shapes;  // that steps point to
  };
  [[nodiscard]] const AtSurface& at(int surface, int direction) const {
    return surfaces_[static_cast<std::size_t>(surface)][direction > 0 ? 0 : 1];
  }
  [[nodiscard]] const LensState& lens() const { return lens_; }
  [[nodiscard]] const ReflectanceTables& tables() const { return tables_; }

 private:
  const LensState& lens_;
  const ReflectanceTables& tables_;
  std::vector<std::array<AtSurface, 2>> surfaces_;
};

}  // namespace contrejour::inline internal
