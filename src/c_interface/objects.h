// SPDX-License-Identifier: Apache-2.0
// The contents of the C interface's opaque types. Thread-safety: plain values, but for cj_cancel, which any thread may
// set.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <contrejour.h>

#include "contrejour/contrejour.h"
#include "contrejour/expert/light_detection.h"
#include "contrejour/expert/parameter_values.h"

struct cj_cancel {
  std::atomic<bool> stop{false};
};

struct cj_settings {
  contrejour::params::Values values;
  std::string lens;  // of the preset
};

struct cj_lens {
  contrejour::Prescription prescription;
  std::vector<std::string> coatings;  // a text for each surface
};

struct cj_lens_state {
  contrejour::LensState state;
};

struct cj_renderer {
  contrejour::Renderer renderer;
  std::optional<contrejour::LensState> lens = std::nullopt;
};

struct cj_light_list {
  contrejour::Detection detection;
};

struct cj_ghost_list {
  std::vector<contrejour::GhostFigures> ghosts;
};

namespace contrejour::inline internal {

// The values of settings, which may be NULL.
[[nodiscard]] inline params::Values values_of(const cj_settings* settings) {
  return settings != nullptr ? settings->values : params::Values();
}

}  // namespace contrejour::inline internal
