// SPDX-License-Identifier: Apache-2.0
#include "cli/layer_options.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/console.h"
#include "cli/options.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/picture_layers.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kLayersGroup = "Layers";

LayersBy layers_by(const std::string& name) {
  if (name == "light") return LayersBy::Light;
  if (name == "ghost") return LayersBy::Ghost;
  return name == "surface" ? LayersBy::Surface : LayersBy::Part;
}

}  // namespace

void add_layer_options(CLI::App& command, LayerChoice& layers) {
  command
      .add_option(
          "--layers", layers.by,
          "write the flare in layers that sum to it, as channels layer.R, layer.G and layer.B: a layer for each "
          "light, ghost or surface, or for ghosts, starburst and glare")
      ->check(CLI::IsMember({"light", "ghost", "part", "surface"}))
      ->option_text("light|ghost|part|surface")
      ->group(kLayersGroup);
  add_number(
      command, "--layer-count", layers.count, 0, 1000,
      "by ghost: the number of ghosts with a layer of their own, the brightest ones; the layer rest has the others")
      ->group(kLayersGroup);
  command
      .add_option(
          "--layer-share", layers.min_percent,
          "by ghost: the percentage of the flux of all ghosts that a ghost with a layer of its own has at least "
          "(default: 0)")
      ->check(CLI::Range(0.0, 100.0))
      ->option_text("PERCENT")
      ->group(kLayersGroup);
  command
      .add_option("--layer-ghosts", layers.ghosts,
                  "by ghost: the ghosts with layers of their own, e.g. 2-5,3-7, instead of the brightest ones")
      ->option_text("LIST")
      ->group(kLayersGroup);
}

Result<void> check_layer_options(const LayerChoice& layers, const std::string& file, const std::string& option) {
  if (!layers.ghosts.empty() && layers.by != "ghost")
    return failure(ErrorCode::InvalidArgument, "--layer-ghosts is for --layers ghost");
  if (!layers.on()) return {};
  if (lower_extension(file) != ".exr")
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("layers need an EXR file: give {} a name that ends in .exr", option), {file});
  const auto parsed = layer_options(layers);
  return parsed ? Result<void>() : tl::unexpected(parsed.error());
}

Result<LayerOptions> layer_options(const LayerChoice& layers, std::size_t light_count) {
  LayerOptions options{layers_by(layers.by), layers.count, layers.min_percent, {}, {}};
  if (!layers.ghosts.empty()) {
    auto ghosts = params::parse_ghosts(layers.ghosts);
    if (!ghosts) return tl::unexpected(ghosts.error());
    options.ghosts = std::move(*ghosts);
  }
  options.light_names.resize(light_count);
  options.light_names.insert(options.light_names.end(), layers.light_names.begin(), layers.light_names.end());
  return options;
}

bool chooses_ghosts(const LayerChoice& layers) { return layers.by == "ghost" && layers.ghosts.empty(); }

Result<void> choose_ghosts(LayerChoice& layers, const LensState& lens, std::vector<Light> lights,
                           const params::Values& values, const FrameSettings& settings) {
  if (lens.surfaces.empty())
    return failure(
        ErrorCode::InvalidArgument,
        "the layers of a measured flare by ghost are the brightest of each frame, and those of a sequence are "
        "the same in all; give --layers light or --layers part");
  const auto options = layer_options(layers);
  if (!options) return tl::unexpected(options.error());
  if (lights.empty()) {
    auto usual = params::lights(values, lens, settings.frame, settings.colour_space);
    if (!usual) return tl::unexpected(usual.error());
    lights = std::move(*usual);
  }
  const auto ghosts = brightest_ghosts(lens, lights, settings, *options);
  if (!ghosts) return tl::unexpected(ghosts.error());
  std::vector<std::string> names;
  for (const Ghost& ghost : *ghosts) names.push_back(ghost_name(ghost));
  layers.ghosts = fmt::format("{}", fmt::join(names, ","));
  print_warnings({fmt::format("layers of all frames: --layer-ghosts {}", layers.ghosts)});
  return {};
}

std::string layers_text(const LayerChoice& layers) {
  if (!layers.on()) return {};
  std::string text =
      fmt::format("layers = {}, {}, {}, {}\n", layers.by, layers.count, layers.min_percent, layers.ghosts);
  for (const std::string& name : layers.light_names) text += fmt::format("light name = {}\n", name);
  for (const std::string& name : layers.off_names) text += fmt::format("light off = {}\n", name);
  return text;
}

void add_layers(Picture& picture, std::vector<FlareLayer> layers, const LayerChoice& choice) {
  for (const std::string& off : choice.by == "light" ? choice.off_names : std::vector<std::string>()) {
    const std::string name = layer_name(off);
    if (std::ranges::find(layers, name, &FlareLayer::name) == layers.end()) layers.push_back({name, {}, 0, 0});
  }
  add_layer_channels(picture, layers);
}

}  // namespace contrejour::cli
