// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/picture_layers.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <utility>

#include "compositing/picture_flare.h"

namespace contrejour {

Result<std::vector<FlareLayer>> layers_of_picture(std::vector<FlareLayer> layers, const PixelGrid& grid) {
  for (FlareLayer& layer : layers) {
    if (layer.image.pixels.empty()) continue;
    if (!grid.is_square()) {
      layer.image = whole_image(layer, grid.frame.width, grid.frame.height);
      layer.left = layer.top = 0;
    }
    auto image = picture_of_flare(std::move(layer.image), grid);
    if (!image) return tl::unexpected(image.error());
    layer.image = std::move(*image);
  }
  return layers;
}

inline namespace internal {

Result<PictureLayers> layers_on_picture(LayeredFlare frame, const FlarePlan& plan, const Image& rgb) {
  if (plan.lights.empty()) return PictureLayers{flare_without_lights(plan), std::move(frame.layers)};
  auto flare = on_picture({std::move(frame.image), std::move(frame.statistics)}, plan, rgb);
  if (!flare) return tl::unexpected(flare.error());
  auto layers = layers_of_picture(std::move(frame.layers), plan.grid);
  if (!layers) return tl::unexpected(layers.error());
  return PictureLayers{std::move(*flare), std::move(*layers)};
}

}  // namespace internal

Result<PictureLayers> render_flare_layers(const FlarePlan& plan, const Image& rgb, const params::Values& values,
                                          Renderer& renderer, const LayerOptions& options, const Context& context) {
  auto rendered = renderer.render_layers(plan.lights, settings_of(plan, values), options, context);
  if (!rendered) return tl::unexpected(rendered.error());
  return layers_on_picture(std::move(*rendered), plan, rgb);
}

void add_layer_channels(Picture& picture, std::span<const FlareLayer> layers) {
  static constexpr std::array kChannels{"R", "G", "B"};
  const auto width = static_cast<std::size_t>(picture.data_window.width);
  const std::size_t pixels = width * static_cast<std::size_t>(picture.data_window.height);
  for (const FlareLayer& layer : layers) {
    for (std::size_t c = 0; c < kChannels.size(); ++c) {
      PictureChannel channel;
      channel.name = layer.name + "." + kChannels[c];
      channel.type = SampleType::Float;
      channel.samples.resize(pixels * sizeof(float));
      for (int y = 0; y < layer.image.height; ++y) {
        const auto row = layer.image.row(y);
        std::size_t at = static_cast<std::size_t>(layer.top + y) * width + static_cast<std::size_t>(layer.left);
        for (std::size_t k = c; k < row.size(); k += 3, ++at)
          std::memcpy(channel.samples.data() + at * sizeof(float), &row[k], sizeof(float));
      }
      picture.channels.push_back(std::move(channel));
    }
  }
}

}  // namespace contrejour
