// SPDX-License-Identifier: Apache-2.0
// The layers of a photograph's flare (flare_layers.h), and how a file holds them: one part with the channels
// "layer.R", "layer.G" and "layer.B" beside R, G and B, which are the whole flare. All hosts read this form; many read
// only the first part of a file with several parts.
// Thread-safety: pure functions, which use the renderer.
#pragma once

#include <span>
#include <vector>

#include "contrejour/apply.h"
#include "contrejour/expert/flare_layers.h"
#include "contrejour/export.h"

namespace contrejour {

struct PictureLayers {
  PictureFlare flare;              // the sum of the layers
  std::vector<FlareLayer> layers;  // dark where there are no lights
};

// As render_flare(), in layers. Errors: also those of render_layers().
[[nodiscard]] CONTREJOUR_API Result<PictureLayers> render_flare_layers(const FlarePlan& plan, const Image& rgb,
                                                                       const params::Values& values, Renderer& renderer,
                                                                       const LayerOptions& options,
                                                                       const Context& context = {});

// The layers of a rendered frame, as those of the picture. Errors: those of picture_of_flare().
[[nodiscard]] CONTREJOUR_API Result<std::vector<FlareLayer>> layers_of_picture(std::vector<FlareLayer> layers,
                                                                               const PixelGrid& grid);

// Adds the channels of layers, 32-bit floats, to a picture of their size. The picture has none of these names yet.
CONTREJOUR_API void add_layer_channels(Picture& picture, std::span<const FlareLayer> layers);

}  // namespace contrejour
