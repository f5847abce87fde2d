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
#include "contrejour/expert/source_renderer.h"

struct cj_cancel {
  std::atomic<bool> stop{false};
};

struct cj_settings {
  contrejour::params::Values values;
  std::string lens;  // of the preset
};

struct cj_lens {
  contrejour::Prescription prescription;  // of a measured flare: its name and source
  std::vector<std::string> coatings;  // a text for each surface
  std::optional<contrejour::MeasuredFlare> measured = std::nullopt;
};

struct cj_lens_state {
  contrejour::LensState state;  // of a measured flare: the ideal lens
  std::optional<contrejour::MeasuredFlare> measured = std::nullopt;
};

struct cj_renderer {
  contrejour::SourceRenderer renderer;
  std::optional<contrejour::LensState> lens = std::nullopt;  // none of a measured flare
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

// A lens with the texts of its coatings.
[[nodiscard]] Result<cj_lens> lens_with_texts(Result<Prescription> read);

// Errors: InvalidArgument for NULL, Unsupported for a measured flare, which has no surfaces.
[[nodiscard]] Result<void> require_lens(const cj_lens* lens);
[[nodiscard]] Result<void> require_surfaces(const cj_lens_state* state);

// The lens or the measured flare.
[[nodiscard]] inline FlareSource source_of(const cj_lens_state& state) {
  return state.measured ? FlareSource(*state.measured) : FlareSource(state.state);
}

}  // namespace contrejour::inline internal
