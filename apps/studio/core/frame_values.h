// SPDX-License-Identifier: Apache-2.0
// The values of a document's frames, as `contrejour render --session FILE --frames RANGE` has them.
// Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/exposure.h"
#include "studio/core/document.h"

namespace contrejour::studio {

[[nodiscard]] Shutter shutter_of_frame(const Document& document, int frame);
// With the lights' ways while the shutter is open.
[[nodiscard]] params::Values values_of_frame(const Document& document, int frame);
[[nodiscard]] params::Values values_during_frame(const Document& document, int frame, const ExposureTimes& times);
// Whether anything but lights changes while the shutter is open.
[[nodiscard]] bool parameters_change_during(const Document& document, int frame);

}  // namespace contrejour::studio
