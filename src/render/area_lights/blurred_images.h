// SPDX-License-Identifier: Apache-2.0
// The images that a frame of lights with a size is composed of.
#pragma once

#include <memory>
#include <vector>

#include "contrejour/frame_settings.h"
#include "render/area_lights/blur_clusters.h"
#include "render/area_lights/fine_window.h"
#include "render/area_lights/ghost_survey.h"

namespace contrejour::inline internal::area {

// An image of some ghosts of some lights, and the map that determines its blur.
struct BlurredImage {
  std::vector<PlannedLight> lights;
  std::vector<GhostOfLight> pairs;  // ghosts by their index in the plan, lights by theirs in `lights`
  std::shared_ptr<const LightPiece> piece = nullptr;  // null: the image is sharp
  int level = 0;
  LinearMap px_from_tangents = kZeroMap;
  FineWindow window;  // for negative levels
  double error_fraction = 1.0;  // of the frame's squared error: what drawing the image may make
};

// In the order in which Layers takes them. Ghosts of point lights, and those whose blur is not visible, stay sharp.
[[nodiscard]] std::vector<BlurredImage> blurred_images(const SurveyedFrame& frame, const FrameSettings& settings);

}  // namespace contrejour::inline internal::area
