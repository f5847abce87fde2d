// SPDX-License-Identifier: Apache-2.0
#include "render/radiometry/lens_tables.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMaxKept = 2048;  // 160 MB for a lens with ten kinds of surfaces; a frame has at most 1024

}  // namespace

LensTables::Key::Key(const LensState& lens) {
  for (const SurfaceState& s : lens.surfaces) {
    SurfaceState surface;
    surface.kind = s.kind;
    surface.before = s.before;
    surface.after = s.after;
    surface.coating = s.coating;
    surface.aperture = s.aperture;
    surface.obscuration = s.obscuration;
    lens_.surfaces.push_back(std::move(surface));
  }
}

LensTables::LensTables(const Key& key) : lens_(std::make_shared<const LensState>(key.lens())), tables_(lens_) {}

GhostReflectances LensTables::reflectances(std::span<const double> lambda_nm) {
  reflectances_.add(*lens_, lambda_nm);
  return reflectances_;
}

void LensTables::next_frame() {
  if (tables_.size() > kMaxKept) tables_ = TablesByWavelength(lens_);
  if (reflectances_.size() > kMaxKept) reflectances_ = GhostReflectances();
}

std::size_t LensTables::memory_bytes() const {
  return tables_.bytes() + reflectances_.size() * lens_->surfaces.size() * sizeof(double);
}

}  // namespace contrejour::inline internal
