// SPDX-License-Identifier: Apache-2.0
// Reads plates in the background, and finds their lights. Thread-safety: as of LatestJob.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/plate.h"
#include "contrejour/expert/session.h"
#include "contrejour/lens.h"
#include "studio/core/latest_job.h"
#include "studio/core/lights.h"

namespace contrejour::studio {

struct PlateOrder {
  SessionPlate reference;
  std::optional<int> frame = {};  // of a sequence; none: a still, or of a new sequence the first frame
  bool is_new = false;  // asked for by the user, in place of the document's
};

struct PlateAnswer {
  PlateOrder order;  // with the frame that was read
  std::shared_ptr<const Plate> plate;  // null where there is an error
  std::vector<int> frames;  // of a sequence, those whose files exist
  std::string error;
};

using PlateJob = LatestJob<PlateOrder, PlateAnswer>;
[[nodiscard]] PlateJob::Work plate_work();

// Errors: those of read_plate; Io for a frame without a file.
[[nodiscard]] Result<std::shared_ptr<const Plate>> plate_of(const SessionPlate& reference, int frame = 0);

struct DetectionOrder {
  std::shared_ptr<const Plate> plate;
  params::Values values;
  std::shared_ptr<const LensState> lens;
};

struct DetectionAnswer {
  std::vector<LightEntry> lights;  // points at the middles of bright areas, each with its sum as its value
  std::string error;
};

using DetectionJob = LatestJob<DetectionOrder, DetectionAnswer>;
[[nodiscard]] DetectionJob::Work detection_work();

// The bright areas that `apply` would take for lights with these values, whether they ask for a detection or not.
// Errors: those of plan_flare.
[[nodiscard]] Result<std::vector<LightEntry>> lights_in_plate(const Plate& plate, params::Values values,
                                                              const LensState& lens);

}  // namespace contrejour::studio
