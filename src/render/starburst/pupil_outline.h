// The exit pupil's outline as circles and lines: what starbursts go on from beyond the mask's samples.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "contrejour/iris.h"
#include "contrejour/starburst.h"
#include "render/starburst/pupil_rays.h"

namespace contrejour {

struct OutlineRays {
  const std::vector<std::size_t>& rims;  // that cut the pupil, or nearly, obscurations among them
  const std::vector<std::size_t>& open;
  const std::vector<std::size_t>& used;  // that get through or all but do, or are obscured
};

// The iris, cut by the rims, with what stands before it; none where that is far from the mask, whose open area (in
// squared cosines) is given, or a picture is the iris.
[[nodiscard]] std::optional<PupilOutline> outline_of(const PupilRays& pupil, const OutlineRays& of, const Iris& iris,
                                                     double open_area);

}  // namespace contrejour
