// SPDX-License-Identifier: Apache-2.0
// The exit pupil's outline as circles and lines: the far field of a starburst, beyond what the mask's samples resolve,
// is computed from it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "contrejour/expert/iris.h"
#include "contrejour/expert/starburst.h"
#include "render/starburst/pupil_rays.h"

namespace contrejour::inline internal {

struct OutlineRays {
  const std::vector<std::size_t>& rims;  // those that cut the pupil, or nearly, with obscurations
  const std::vector<std::size_t>& open;
  const std::vector<std::size_t>& used;  // those that get through or nearly do, or are obscured
};

// The iris, cut by the rims and with obscurations; nullopt if its area differs much from the mask's open area (in
// squared cosines), or if the iris is a picture.
[[nodiscard]] std::optional<PupilOutline> outline_of(const PupilRays& pupil, const OutlineRays& of, const Iris& iris,
                                                     double open_area);

}  // namespace contrejour::inline internal
