// SPDX-License-Identifier: Apache-2.0
// A flare in layers, each of which is graded by itself: by light, by ghost, by part or by surface. Every layer is drawn
// at the error of the whole frame, and the flare is the sum of its layers: render() gives the same one to 1e-6 of the
// peak. Names are as hosts write them, `layer.channel` without the channel: letters, digits and underscores.
//
//   by light    one for each light, with its ghosts, its starburst and its glare
//   by ghost    "ghost_2_5" for the ghost 2-5, the brightest ones first, then "rest"
//   by part     "ghosts"
//   by surface  "surface_5" for the ghosts whose first reflection is at surface 5: each ghost is in one layer
//
// Except by light, layers "starburst" and "glare" follow where the settings add them.
// Errors: InvalidArgument, Cancelled. The result is the same for any number of threads. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/ghost_id.h"
#include "contrejour/export.h"
#include "contrejour/frame_settings.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/method_options.h"
#include "contrejour/render.h"
#include "contrejour/result.h"

namespace contrejour {

enum class LayersBy { Light, Ghost, Part, Surface };

// Lights beyond this number share the layer "rest": those with the smallest values.
inline constexpr std::size_t kMaxLightLayers = 64;

struct LayerOptions {
  LayersBy by = LayersBy::Part;
  // By ghost: the number of ghosts that have a layer of their own, the brightest ones of this frame (as SelectBrightest
  // ranks them), and the percentage of the flux of all ghosts that such a ghost has at least.
  int ghost_count = 10;
  double min_percent = 0.0;
  // By ghost, instead of the brightest: these, so that all frames of a shot have the same layers. A ghost that a frame
  // does not have is a dark layer.
  std::vector<Ghost> ghosts = {};
  // By light: their names. A light without one is "light3", by its number. Other characters become underscores.
  std::vector<std::string> light_names = {};
};

struct FlareLayer {
  std::string name;
  Image image;  // the part of the frame that the layer's light reaches; without pixels in a dark layer
  int left = 0, top = 0;  // where that part begins
};

struct LayeredFlare {
  Image image;  // the sum of the layers, added in their order
  std::vector<FlareLayer> layers;
  RenderStatistics statistics;
};

// By one of the methods of render.h. Costs the tracing of one frame, and pixels for each layer. Errors: also a ghost
// that the lens does not have, a negative number or percentage.
[[nodiscard]] CONTREJOUR_API Result<LayeredFlare> render_layers(const MethodOptions& method, const LensState& lens,
                                                                std::span<const Light> lights,
                                                                const FrameSettings& settings,
                                                                const LayerOptions& options,
                                                                const Context& context = {});

// The ghosts that would have layers of their own, the brightest first, to be kept for the frames of a shot.
[[nodiscard]] CONTREJOUR_API Result<std::vector<Ghost>> brightest_ghosts(const LensState& lens,
                                                                         std::span<const Light> lights,
                                                                         const FrameSettings& settings,
                                                                         const LayerOptions& options,
                                                                         const Context& context = {});

// A layer in an image of the whole frame.
[[nodiscard]] CONTREJOUR_API Image whole_image(const FlareLayer& layer, int width, int height);

// A name for a layer from any text: characters that hosts do not allow become underscores.
[[nodiscard]] CONTREJOUR_API std::string layer_name(const std::string& text);
[[nodiscard]] CONTREJOUR_API std::string layer_name(const Ghost& ghost);

}  // namespace contrejour
