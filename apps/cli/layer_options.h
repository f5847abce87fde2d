// SPDX-License-Identifier: Apache-2.0
// The options of a flare in layers: --layers and its companions.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "contrejour/expert/flare_layers.h"
#include "contrejour/image_io.h"

namespace contrejour::cli {

struct LayerChoice {
  std::string by;      // "light", "ghost", "part" or "surface"; empty: no layers
  std::string ghosts;  // a list of ghosts in place of the brightest
  int count = LayerOptions{}.ghost_count;
  double min_percent = LayerOptions{}.min_percent;
  std::vector<std::string> light_names;  // of a frame's lights, by their order; empty texts for lights without a name
  std::vector<std::string> off_names;  // of the lights that are off in the frame, whose layers are dark

  [[nodiscard]] bool on() const { return !by.empty(); }
};

void add_layer_options(CLI::App& command, LayerChoice& layers);

// Errors: a file that cannot hold layers; a list of ghosts, or their number, without layers by ghost.
[[nodiscard]] Result<void> check_layer_options(const LayerChoice& layers, const std::string& file,
                                               const std::string& option);

// The library's options. light_count: lights before those that have names.
[[nodiscard]] Result<LayerOptions> layer_options(const LayerChoice& layers, std::size_t light_count = 0);

// Whether the brightest ghosts of a frame are to be chosen.
[[nodiscard]] bool chooses_ghosts(const LayerChoice& layers);

// Chooses the ghosts for the frames of a shot: the brightest ones of these lights; without any, of the default light.
// Prints them as an option.
[[nodiscard]] Result<void> choose_ghosts(LayerChoice& layers, const LensState& lens, std::vector<Light> lights,
                                         const params::Values& values, const FrameSettings& settings);

// The choice as text, for a frame's record.
[[nodiscard]] std::string layers_text(const LayerChoice& layers);

// Adds the layers to the file's picture, and dark ones for the lights that are off.
void add_layers(Picture& picture, std::vector<FlareLayer> layers, const LayerChoice& choice);

}  // namespace contrejour::cli
