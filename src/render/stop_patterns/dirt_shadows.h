// SPDX-License-Identifier: Apache-2.0
// The transmittance of a lens's dirt for one ghost at one wavelength, by point in the plane that the dirt lies in: its
// shadows are sharp, or have the fringes that the ghost's defocus gives them. Light meets dirt in the stop at every
// crossing of the stop, dirt on the front once, where it enters. A renderer multiplies a ghost's light by level(), and
// by transmission() at points that are not clean.
// Units: mm of the dirt's plane. Thread-safety: const members may run at once.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "render/planning/dirt_field.h"
#include "render/stop_patterns/dirt_diffraction.h"

namespace contrejour::inline internal {

class DirtShadows {
 public:
  // Sharp shadows.
  explicit DirtShadows(std::shared_ptr<const DirtField> field) : DirtShadows(std::move(field), {}) {}
  // fringes: the plane at each crossing of the stop, or at the front; null: shadows there are sharp.
  DirtShadows(std::shared_ptr<const DirtField> field,
              std::vector<std::shared_ptr<const stop_patterns::DirtDiffraction>> fringes);

  [[nodiscard]] const DirtSite& site() const { return field_->site(); }
  [[nodiscard]] bool is_sharp() const { return fringes_.empty(); }

  // The transmittance where the plane is clean: 1, or less where weak shadows all over the plane are replaced by their
  // mean.
  [[nodiscard]] double level() const { return level_; }
  // The mean transmittance over the square about the point, relative to level(); above 1 on bright fringes.
  [[nodiscard]] double transmission(const DirtPoint& point, std::size_t crossing) const;
  // The product over all crossings.
  [[nodiscard]] double transmission(std::span<const DirtPoint> points) const {
    double all = 1.0;
    for (std::size_t c = 0; c < points.size() && all > 0.0; ++c) all *= transmission(points[c], c);
    return all;
  }
  // Whether transmission() is 1 all over a disc. A large disc counts as not clean where dirt comes near its bounds.
  [[nodiscard]] bool is_clean(Vec2 middle_mm, double radius_mm, std::size_t crossing) const;
  [[nodiscard]] DirtEdges edges() const;
  // Not null only where the shadows may be drawn as the shapes' outlines.
  [[nodiscard]] const DirtField* outlines() const { return is_sharp() ? field_->outlines() : nullptr; }

 private:
  [[nodiscard]] const stop_patterns::DirtDiffraction* fringes_at(std::size_t crossing) const {
    return is_sharp() ? nullptr : fringes_[std::min(crossing, fringes_.size() - 1)].get();
  }

  std::shared_ptr<const DirtField> field_;
  std::vector<std::shared_ptr<const stop_patterns::DirtDiffraction>> fringes_;
  double level_ = 1.0;
};

}  // namespace contrejour::inline internal
