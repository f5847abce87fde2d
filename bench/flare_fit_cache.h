// SPDX-License-Identifier: Apache-2.0
// Simulated captures for the table of fitted flares, and what is right about them. Both take minutes to render, so a
// folder may keep them: files of floats in this machine's own order of bytes, to be deleted when the renderer changes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "contrejour/expert/fit_flare.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/sweep.h"
#include "contrejour/frame.h"
#include "contrejour/lens.h"

namespace contrejour {

struct SimulatedCapture {
  SweepSettings settings;
  std::vector<CapturedImage> pictures;
  std::vector<DirectImage> lights;
  std::vector<std::optional<DirectFlux>> direct;
};

// folder: where it is kept; empty: nowhere.
[[nodiscard]] Result<SimulatedCapture> simulated_capture(const LensState& lens, int stations, int raw_width,
                                                         const std::filesystem::path& folder);

struct DrawnGhost {
  Ghost ghost;
  Image picture;
};

// Each ghost by itself for a light at a tangent s on the x axis. Ghosts without light are left out.
[[nodiscard]] std::vector<DrawnGhost> drawn_ghosts(const LensState& lens, const Frame& frame, double s,
                                                   const std::filesystem::path& folder);

}  // namespace contrejour
