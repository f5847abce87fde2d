// SPDX-License-Identifier: Apache-2.0
// The ghosts of one light as panels show them: their figures, brightest first, and the section of the lens with
// the rays of chosen ones. Thread-safety: as of LatestJob.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/lens_section.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/ghost_figures.h"
#include "studio/core/ghost_footprint.h"
#include "studio/core/ghost_ranks.h"
#include "studio/core/latest_job.h"

namespace contrejour::studio {

struct FiguresOrder {
  std::uint64_t revision = 0;
  params::Values values;
  std::shared_ptr<const LensState> lens;
  std::size_t light = 0;  // index among the picture's lights
};

struct FiguresAnswer {
  std::uint64_t revision = 0;
  std::size_t light = 0;
  std::vector<GhostFigures> figures;  // pixels are those of --size
  std::vector<GhostFootprint> footprints;  // one for each of them (ghost_footprint.h)
  std::string error;
  std::shared_ptr<const GhostRanks> ranks;  // of a light elsewhere; null: not measured yet
};

// The figures are published first. The ranks take longer, and follow with them once the lens has them.
using FiguresJob = LatestJob<FiguresOrder, FiguresAnswer>;
[[nodiscard]] FiguresJob::Work figures_work();

struct SectionOrder {
  std::shared_ptr<const LensState> lens;
  std::optional<Ghost> ghost;  // none: the rays that form the image
  double light_rad = 0;  // elevation of the ghost's light in the plane of the section
};

struct SectionAnswer {
  std::shared_ptr<const LensSection> section;
  std::optional<Ghost> ghost;
};

using SectionJob = LatestJob<SectionOrder, SectionAnswer>;
[[nodiscard]] SectionJob::Work section_work();

// The direction of a light of the picture, and its angle from the axis, positive above it. Errors: no such light.
[[nodiscard]] Result<Light> light_of(const params::Values& values, const LensState& lens, std::size_t light);
[[nodiscard]] double angle_from_axis_rad(const Light& light);

}  // namespace contrejour::studio
