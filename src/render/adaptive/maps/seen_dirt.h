// Dirt as a ghost's rays come upon it.
#pragma once

#include "ghosts/light_frame.h"
#include "render/interface/dirt_field.h"

namespace contrejour::adaptive {

struct SeenDirt {
  const DirtField* field = nullptr;  // null: none is to be seen
  const LightFrame* light = nullptr;
  double entrance_z_mm = 0.0;  // of the plane that rays are counted in

  [[nodiscard]] explicit operator bool() const { return field != nullptr; }
  // entrance_mm: in the light's frame.
  [[nodiscard]] Vec2 front_place(Vec2 entrance_mm) const {
    return light->into_place(field->front_place(entrance_mm, entrance_z_mm, light->source));
  }
};

}  // namespace contrejour::adaptive
