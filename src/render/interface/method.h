// What a renderer is to the registry (render/driver/registry.h): a name, traits, and a function that draws a plan.
#pragma once

#include <string_view>

#include "render/interface/frame_plan.h"

namespace contrejour {

struct Method {
  std::string_view name;
  MethodTraits traits;
  PlannedRenderer draw;
};

}  // namespace contrejour
