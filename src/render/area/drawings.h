// The pictures that a frame of lights with a size is put together from.
#pragma once

#include <memory>
#include <vector>

#include "contrejour/frame_settings.h"
#include "render/area/area_survey.h"
#include "render/area/blur_classes.h"

namespace contrejour::area {

// A picture of some ghosts of some lights, and the kernel that it is blurred by.
struct Drawing {
  std::vector<PlannedLight> lights;
  std::vector<GhostOfLight> pairs;  // ghosts by their place in the plan, lights in `lights`
  std::shared_ptr<const LightPiece> piece = nullptr;  // null: it is sharp
  int level = 0;
  LinearMap px_from_tangents = kNowhere;
};

// In the order that layers want them. Ghosts of points, and those too little blurred to show it, are left as they are.
[[nodiscard]] std::vector<Drawing> drawings_of(const SurveyedFrame& frame, const FrameSettings& settings);

}  // namespace contrejour::area
