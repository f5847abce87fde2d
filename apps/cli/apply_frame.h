// SPDX-License-Identifier: Apache-2.0
// One photograph through `apply`, in the three steps of a sequence: read it and find its lights, render their flare,
// write its files. A still is a sequence of one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/frame_exposure.h"
#include "cli/layer_options.h"
#include "cli/outputs.h"
#include "cli/preset_choice.h"
#include "contrejour/apply.h"
#include "contrejour/context.h"
#include "contrejour/expert/plate.h"
#include "contrejour/expert/source_renderer.h"

namespace contrejour::cli {

struct ApplyOptions {
  std::string lens, input, output, flare_only, detected, preview, lights;
  bool json = false;
  ReadOptions read;
  PlateColour colour;
  ExrCompression compression = ExrCompression::AsRead;
  PresetOptions preset;
  LayerChoice layers;
  params::Values values;

  [[nodiscard]] std::vector<std::string> outputs() const { return {output, flare_only, detected, preview}; }
};

struct ApplyFiles {
  OutputFile* output = nullptr;
  OutputFile *flare_only = nullptr, *detected = nullptr, *preview = nullptr, *preset = nullptr;  // or null
};

struct PlannedPhotograph {
  ApplyOptions options;
  std::shared_ptr<const LensState> lens;
  Outputs outputs;
  ApplyFiles files;
  Picture picture;
  FlarePlan plan;
  std::shared_ptr<const PlateSource> source = nullptr;  // of the picture, for writing it back
  std::shared_ptr<const FrameExposure> exposure = nullptr;  // if more than lights changes while the shutter is open
};

struct FlaredPhotograph {
  PlannedPhotograph planned;
  PictureFlare flare;
  std::vector<FlareLayer> layers = {};
  int drawn = 1;  // how often, for motion blur
};

// Opens all outputs, so that a long rendering does not fail at its end, reads the photograph and plans its flare.
[[nodiscard]] Result<PlannedPhotograph> read_photograph(const ApplyOptions& options,
                                                        std::shared_ptr<const LensState> lens);
// The same for a picture in memory instead of the input's.
[[nodiscard]] Result<PlannedPhotograph> plan_photograph(const ApplyOptions& options,
                                                        std::shared_ptr<const LensState> lens, Plate plate);

// The plan's warnings then include those of lights beyond a measured flare's angles.
[[nodiscard]] Result<FlaredPhotograph> render_photograph(PlannedPhotograph&& planned, SourceRenderer& renderer,
                                                         const Context& context);

// Adds the flare to the photograph and writes all files: all appear, or none.
[[nodiscard]] Result<void> write_photograph(FlaredPhotograph& flared, const Context& context);

[[nodiscard]] Json frame_json(const FlaredPhotograph& flared);
[[nodiscard]] std::string frame_text(const FlaredPhotograph& flared);

}  // namespace contrejour::cli
