// SPDX-License-Identifier: Apache-2.0
#include "studio/core/frame_values.h"

#include <algorithm>

namespace contrejour::studio {
namespace {

constexpr int kComparedTimes = 9;  // as many as the command line compares

// Lights of the animation stand in place of the document's.
params::Values fixed_values(const Document& document) {
  Document fixed = document;
  if (!document.animation.lights.empty()) {
    fixed.texts.erase("light");
    fixed.texts.erase("light-at");
  }
  return fixed.values();
}

params::Values without_lights_at(const Document& document, int frame, double time) {
  return parameters_during(document.animation, frame, time).over(fixed_values(document));
}

}  // namespace

Shutter shutter_of_frame(const Document& document, int frame) {
  const params::Values values = without_lights_at(document, frame, frame);
  return {values.number("shutter-angle"), values.text("shutter-offset") == "centre"};
}

params::Values values_of_frame(const Document& document, int frame) {
  params::Values values = without_lights_at(document, frame, frame);
  add_lights_at(document.animation, frame, values, shutter_of_frame(document, frame));
  return values;
}

params::Values values_during_frame(const Document& document, int frame, const ExposureTimes& times) {
  const Shutter shutter = shutter_of_frame(document, frame);
  params::Values values = without_lights_at(document, frame, time_of_exposure(frame, shutter, times.parameters));
  add_lights_at(document.animation, frame, values, shutter, {times.lights_from, times.lights_to});
  return values;
}

bool parameters_change_during(const Document& document, int frame) {
  const Shutter shutter = shutter_of_frame(document, frame);
  if (!(shutter.angle_deg > 0)) return false;
  const auto text_at_time = [&](const std::string& name, int k) {
    const double time = time_of_exposure(frame, shutter, k / (kComparedTimes - 1.0));
    return parameters_during(document.animation, frame, time).text(name);
  };
  return std::ranges::any_of(document.animation.parameters, [&](const auto& parameter) {
    for (int k = 1; k < kComparedTimes; ++k)
      if (text_at_time(parameter.first, k) != text_at_time(parameter.first, 0)) return true;
    return false;
  });
}

}  // namespace contrejour::studio
