// SPDX-License-Identifier: Apache-2.0
// One picture of a document with the values of a still or of a frame, drawn and written as the command line does it:
// without a plate as `contrejour render`, with one as `contrejour apply`. Errors: those of rendering and of writing.
// Thread-safety: pure functions, but for the renderer and the file.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "contrejour/context.h"
#include "contrejour/expert/flare_plan.h"
#include "contrejour/expert/output_file.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/plate.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/session.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"
#include "contrejour/renderer.h"

namespace contrejour::studio {

struct PictureInput {
  params::Values values;
  std::shared_ptr<const LensState> lens;
  std::shared_ptr<const Plate> plate;  // null: the flare on black
  SessionPlate reference = {};  // the plate's
  WithoutLights without = WithoutLights::DefaultLight;  // where there is no plate
};

struct DrawnPicture {
  PictureInput input;
  Image flare;
  bool has_lights = true;
};

// The renderer has the lens and the method.
[[nodiscard]] Result<DrawnPicture> draw_picture(const PictureInput& input, Renderer& renderer, const Context& context);
// The plate with the flare, or the flare.
[[nodiscard]] Image picture_of(const DrawnPicture& drawn);

// By the file's extension: .exr, scene-linear; .png, a preview in the values' exposure; with a plate also the others of
// is_plate_name(). The caller commits it.
[[nodiscard]] Result<void> write_drawn(OutputFile& file, const DrawnPicture& drawn, const Context& context);
[[nodiscard]] Result<void> check_picture_name(const std::string& file, bool has_plate);

}  // namespace contrejour::studio
