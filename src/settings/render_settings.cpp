// SPDX-License-Identifier: Apache-2.0
// Values -> the options of the methods and the settings of a frame.
#include "contrejour/expert/polynomial_method.h"
#include "contrejour/expert/settings.h"
#include "settings/choice.h"

namespace contrejour::params {
namespace {

GridOptions grid_options(const Values& values) {
  return {.rays = values.integer("grid"),
          .scale = values.is_on("scale-grid"),
          .sigma = values.number("scale-grid-sigma"),
          .phi = values.number("scale-grid-phi")};
}

GhostOptions ghost_options(const Values& values) {
  GhostOptions options;
  options.gain = values.number("ghost-gain");
  options.edge_gain = values.number("ghost-edge-gain");
  for (const std::string& given : values.list("ghost")) options.adjustments.push_back(*parse_ghost_adjustment(given));
  if (const auto ramp = values.text("ghost-ramp")) options.ramp = *parse_ghost_ramp(*ramp);
  options.jitter = values.number("ghost-jitter");
  options.jitter_seed = static_cast<std::uint32_t>(values.integer("ghost-seed"));
  return options;
}

PolynomialRenderOptions polynomial_options(const Values& values) {
  return {.error = *parse_error_bound(*values.text("error")),
          .file = values.text("fit").value_or(""),
          .points = values.integer("points")};
}

RingingOptions ringing_options(const Values& values) {
  RingingOptions options;
  options.mode = choice<RingingMode>(values, "ringing");
  options.alpha = values.real("ringing-alpha");
  return options;
}

}  // namespace

ColourSpace colour_space(const Values& values, ColourSpace otherwise) {
  const auto name = values.text("colour-space");
  if (!name) return otherwise;
  return *name == "acescg" ? ColourSpace::AcesCg : ColourSpace::Rec709;
}

GhostScope ghost_scope(const Values& values) {
  return *values.text("ghosts") == "all" ? GhostScope::All : GhostScope::OneSideOfStop;
}

Reflections reflections(const Values& values) {
  return *values.text("reflections") == "4" ? Reflections::UpToFour : Reflections::Two;
}

AdaptiveOptions adaptive_options(const Values& values) { return {.error = *parse_error_bound(*values.text("error"))}; }

BundleOptions bundle_options(const Values& values) {
  return {.grid = grid_options(values),
          .smooth_shading = !values.is_on("flat-shading"),
          .grid_levels = values.is_on("grid-levels"),
          .mirror_symmetry = values.is_on("mirror-symmetry"),
          .precomputed_bounds = values.is_on("precomputed-pupils"),
          .spectral_filter = values.is_on("spectral-filter"),
          .anisotropic = choice<BundleOptions::Anisotropic>(values, "anisotropic")};
}

TiledOptions tiled_options(const Values& values) {
  return {.grid = grid_options(values),
          .merge_steps = values.integer("merge-steps"),
          .merge_threshold = values.number("merge-threshold"),
          .dense_tile = values.integer("tile"),
          .coarse_tile = values.integer("coarse-tile"),
          .interpolation = choice<TiledOptions::Interpolation>(values, "interpolation")};
}

ReferenceOptions reference_options(const Values& values) { return {.density = values.number("density")}; }

Result<MethodOptions> method_options(const Values& values, std::string_view method) {
  auto options = contrejour::method_options(method);
  if (!options) return options;
  if (auto* const adaptive = options->get_if<AdaptiveOptions>()) *adaptive = adaptive_options(values);
  if (auto* const polynomial = options->get_if<PolynomialRenderOptions>()) *polynomial = polynomial_options(values);
  if (auto* const bundle = options->get_if<BundleOptions>()) *bundle = bundle_options(values);
  if (auto* const tiled = options->get_if<TiledOptions>()) *tiled = tiled_options(values);
  if (auto* const reference = options->get_if<ReferenceOptions>()) *reference = reference_options(values);
  return options;
}

MethodOptions method_options(const Values& values) { return *method_options(values, *values.text("method")); }

FrameSettings frame_settings(const Values& values, const Frame& frame, ColourSpace space) {
  FrameSettings settings;
  settings.frame = frame;
  settings.scope = ghost_scope(values);
  settings.reflections = reflections(values);
  settings.selection = *parse_selection(*values.text("select"));
  settings.wavelengths = *parse_wavelengths(*values.text("wavelengths"));
  settings.colour_space = space;
  settings.area_error = *parse_error_bound(*values.text("error"));
  settings.starburst.on = values.is_on("starburst");
  settings.starburst.gain = values.number("starburst-gain");
  settings.glare.fraction = values.number("glare");
  settings.glare.width_rad = values.number("glare-width") * kDegree_rad;
  settings.ghosts = ghost_options(values);
  settings.ringing = ringing_options(values);
  return settings;
}

}  // namespace contrejour::params
