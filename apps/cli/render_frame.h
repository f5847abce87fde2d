// SPDX-License-Identifier: Apache-2.0
// One frame through `render`, in the three steps of a sequence: plan it, render it, write its files. A still is a
// sequence of one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/frame_exposure.h"
#include "cli/layer_options.h"
#include "cli/outputs.h"
#include "cli/preset_choice.h"
#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/plate.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/source_renderer.h"

namespace contrejour::cli {

struct RenderOptions {
  std::string lens, output, preview, stats, lights;
  bool json = false;
  PresetOptions preset;
  LayerChoice layers;
  PlateColour colour;
  ExrCompression compression = ExrCompression::AsRead;
  params::Values values;
  bool needs_light = true;  // where the values give no light: the default one, rather than a black frame

  [[nodiscard]] std::vector<std::string> outputs() const { return {output, preview, stats}; }
};

struct RenderFiles {
  OutputFile* output = nullptr;
  OutputFile *preview = nullptr, *stats = nullptr, *preset = nullptr;  // null where not requested
};

struct PlannedFrame {
  RenderOptions options;
  std::shared_ptr<const LensState> lens;
  Outputs outputs;
  RenderFiles files;
  PictureRequest request;
  std::shared_ptr<const FrameExposure> exposure = nullptr;  // if more than lights changes while the shutter is open
};

struct RenderedFrame {
  PlannedFrame planned;
  Flare flare;
  std::vector<FlareLayer> layers = {};
  int drawn = 1;  // how often, for motion blur
};

// Opens all outputs, so that a long rendering does not fail at its end, and takes the lights and settings from the
// values. lens: that of the source as these values configure it.
[[nodiscard]] Result<PlannedFrame> plan_frame(const RenderOptions& options, const FlareSource& source,
                                              std::shared_ptr<const LensState> lens);

[[nodiscard]] Result<RenderedFrame> render_frame(PlannedFrame&& planned, SourceRenderer& renderer,
                                                 const Context& context);

// Writes all files: all appear, or none.
[[nodiscard]] Result<void> write_frame(RenderedFrame& rendered, const Context& context);

[[nodiscard]] Json frame_json(const RenderedFrame& rendered);
[[nodiscard]] std::string frame_text(const RenderedFrame& rendered);

}  // namespace contrejour::cli
