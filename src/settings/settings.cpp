// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/settings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/trace.h"
#include "settings/mask_images.h"
#include "settings/photometry.h"
#include "settings/sensor_format.h"

namespace contrejour::params {
namespace {

constexpr double kMaxLightAngle_deg = 89.9;  // beyond, no light meets the front of a lens
constexpr Vec2 kUsualPlace{0.70, 0.33};      // bodonyi2023's light

Result<Vec3> direction_of_angles(Vec2 angles_deg) {
  if (std::abs(angles_deg.x) > kMaxLightAngle_deg || std::abs(angles_deg.y) > kMaxLightAngle_deg) {
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("a light at {},{} degrees is beside or behind the camera; stay within {}", angles_deg.x,
                               angles_deg.y, kMaxLightAngle_deg));
  }
  return direction_from_angles(angles_deg.x * kDegree_rad, angles_deg.y * kDegree_rad);
}

Result<Light> finish_light(Light light, const LightValue& value, const LightColour& colour, ColourSpace space) {
  light.spectrum = colour.spectrum;
  light.value = value.rgb;
  if (value.per_channel) {
    if (!colour.rgb) return light;
    return failure(ErrorCode::InvalidArgument,
                   "a light's value and colour are both R,G,B; give one as a single number or name");
  }
  const Rgb tint = colour.rgb ? *colour.rgb : rgb_of(colour.spectrum, space);
  for (std::size_t c = 0; c < tint.size(); ++c) light.value[c] *= tint[c];
  return light;
}

// A parameter with a choice of words, as the enumerator of the same position.
template <class Enum>
Enum choice(const Values& values, std::string_view name) {
  const auto& words = parameter(name).choices;
  return static_cast<Enum>(std::find(words.begin(), words.end(), *values.text(name)) - words.begin());
}

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
  options.scatter = values.number("ghost-scatter");
  options.scatter_seed = static_cast<std::uint32_t>(values.integer("ghost-seed"));
  return options;
}

Result<Dirt> dirt(const Values& values) {
  Dirt dirt;
  dirt.dust_per_cm2 = values.number("dust");
  dirt.dust_mm = values.number("dust-size");
  dirt.scratches_per_cm2 = values.number("scratches");
  dirt.scratch_length_mm = values.number("scratch-length");
  dirt.scratch_width_mm = values.number("scratch-width");
  dirt.scratch_angle_rad = values.number("scratch-angle") * kDegree_rad;
  dirt.scratch_spread_rad = values.number("scratch-spread") * kDegree_rad;
  dirt.plane = choice<DirtPlane>(values, "dirt-on");
  dirt.seed = static_cast<std::uint32_t>(values.integer("dirt-seed"));
  dirt.time = values.number("dirt-time");
  if (const auto file = values.text("dirt-image")) {
    auto picture = read_dirt_image(*file);
    if (!picture) return tl::unexpected(picture.error());
    dirt.picture = std::move(*picture);
  }
  return dirt;
}

RingingOptions ringing_options(const Values& values) {
  RingingOptions options;
  options.mode = choice<RingingMode>(values, "ringing");
  options.alpha = values.real("ringing-alpha");
  return options;
}

}  // namespace

Result<LensSettings> lens_settings(const Values& values) {
  LensSettings settings;
  settings.focal_length_mm = values.real("focal");
  settings.f_number = values.real("fnumber");
  settings.object_distance_mm = *parse_distance_mm(*values.text("focus"));
  if (const auto coating = values.text("coating")) settings.coating = *parse_coating(*coating);
  for (const std::string& text : values.list("coating-at")) {
    auto coating = parse_coating_at(text);  // a file may have been removed since it was checked
    if (!coating) return tl::unexpected(coating.error());
    settings.coating_at.push_back(std::move(*coating));
  }
  settings.build = {values.number("tilt") * kDegree_rad, values.number("decentre"),
                    static_cast<std::uint32_t>(values.integer("build-seed"))};
  settings.iris.blades = values.integer("blades");
  settings.iris.rotation_rad = values.number("blade-rotation") * kDegree_rad;
  settings.iris.curvature = values.number("blade-curvature");
  settings.iris.asymmetry = values.number("blade-asymmetry");
  settings.iris.seed = static_cast<std::uint32_t>(values.integer("blade-seed"));
  settings.iris.slope_spread = values.number("blade-spread");
  settings.iris_closing = choice<IrisClosing>(values, "blade-closing");
  if (const auto file = values.text("iris-image")) {
    auto field = read_iris_image(*file);
    if (!field) return tl::unexpected(field.error());
    settings.iris.field = std::move(*field);
  }
  auto lying = dirt(values);
  if (!lying) return tl::unexpected(lying.error());
  settings.dirt = std::move(*lying);
  settings.absorption = values.is_on("absorption");
  for (const std::string& text : values.list("cover-glass")) {
    const auto plate = parse_cover_glass(text);
    if (!plate) return tl::unexpected(plate.error());
    settings.sensor.plates.push_back(*plate);
  }
  settings.sensor.reflectance = values.number("sensor-reflectance");
  settings.sensor.orders = values.integer("sensor-orders");
  settings.sensor.pitch_mm = values.number("sensor-pitch") * 1e-3;
  settings.sensor.fill = values.number("sensor-fill");
  return settings;
}

Result<LensState> lens_of(Prescription lens, const Values& values) {
  const auto settings = lens_settings(values);
  if (!settings) return tl::unexpected(settings.error());
  if (const auto sensor = values.text("sensor")) {
    const SensorFormat format = *parse_sensor(*sensor);
    lens.sensor_width_mm = format.width_mm;
    lens.sensor_height_mm = format.height_mm;
  }
  return configure_lens(lens, *settings);
}

double pixel_pitch_mm(const Values& values, const LensState& lens, Vec2 square_pixels) {
  const auto hfov_deg = values.real("hfov");
  if (!hfov_deg) return std::min(lens.sensor_width_mm / square_pixels.x, lens.sensor_height_mm / square_pixels.y);
  const double focal_length_mm =
      lens.has_axial_symmetry() ? lens.focal_length_mm : first_order(lens, lens.design_wavelength_nm).focal_length_x_mm;
  return 2.0 * focal_length_mm * std::tan(0.5 * *hfov_deg * kDegree_rad) / square_pixels.x;
}

Frame whole_frame(const Values& values, const LensState& lens, PixelSize size) {
  Frame frame = frame_on_sensor(lens, size.width, size.height);
  frame.pixel_pitch_mm =
      pixel_pitch_mm(values, lens, {static_cast<double>(size.width), static_cast<double>(size.height)});
  return frame;
}

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
          .mirror_symmetry = values.is_on("mirror"),
          .precomputed_bounds = values.is_on("pupil-table"),
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
  settings.glare.share = values.number("glare");
  settings.glare.width_rad = values.number("glare-width") * kDegree_rad;
  settings.ghosts = ghost_options(values);
  settings.ringing = ringing_options(values);
  return settings;
}

namespace {

// The given lights, or one at `usual` if there are none.
Result<std::vector<Light>> lights_or(std::optional<Vec2> usual, const Values& values, const LensState& lens,
                                     const Frame& frame, ColourSpace space) {
  const LightValue value = *parse_light_value(*values.text("value"));
  const auto colour = parse_light_colour(*values.text("colour"));  // a file may have been removed since it was checked
  if (!colour) return tl::unexpected(colour.error());
  const double distance_mm = *parse_distance_mm(*values.text("light-distance"));
  std::vector<Light> all;
  const Exposure exposure{values.number("iso"), *parse_shutter(*values.text("shutter"))};
  const auto add = [&](Vec3 direction, const LightText& text) -> Result<void> {
    LightValue own = text.value.value_or(value);
    Light place;
    place.direction = direction;
    place.distance_mm = distance_mm;
    place.radius_rad = 0.5 * text.size_deg.value_or(values.number("light-size")) * kDegree_rad;
    const auto sum = sum_of(own, place, lens, frame, exposure);
    if (!sum) return tl::unexpected(sum.error());
    if (!own.per_channel) own.rgb = {*sum, *sum, *sum};
    auto light = finish_light(place, own, text.colour.value_or(*colour), space);
    if (!light) return tl::unexpected(light.error());
    all.push_back(*light);
    return {};
  };
  for (const std::string& given : values.list("light")) {
    const auto text = parse_light(given);
    if (!text) return tl::unexpected(text.error());
    const auto direction = direction_of_angles(text->place);
    if (!direction) return tl::unexpected(direction.error());
    if (const auto added = add(*direction, *text); !added) return tl::unexpected(added.error());
  }
  const auto add_at = [&](const LightText& text) {
    const Vec2 sensor_mm = frame.sensor_from_uv(text.place);
    return add(direction_for_image_point(lens, sensor_mm, lens.design_wavelength_nm, distance_mm), text);
  };
  for (const std::string& given : values.list("light-at")) {
    const auto text = parse_light(given);
    if (!text) return tl::unexpected(text.error());
    if (const auto added = add_at(*text); !added) return tl::unexpected(added.error());
  }
  if (all.empty() && usual) {
    if (const auto added = add_at({*usual, {}, {}, {}}); !added) return tl::unexpected(added.error());
  }
  return all;
}

}  // namespace

Result<std::vector<Light>> lights(const Values& values, const LensState& lens, const Frame& frame, ColourSpace space) {
  return lights_or(kUsualPlace, values, lens, frame, space);
}

Result<std::vector<Light>> given_lights(const Values& values, const LensState& lens, const Frame& frame,
                                        ColourSpace space) {
  return lights_or(std::nullopt, values, lens, frame, space);
}

double gain(const Values& values) { return values.number("gain") * std::exp2(values.number("stops")); }

DetectionSettings detection_settings(const Values& values) {
  DetectionSettings settings;
  settings.threshold = values.real("threshold");
  settings.softness = values.number("softness");
  settings.max_lights = values.integer("max-lights");
  settings.min_pixels = values.integer("min-pixels");
  settings.max_value = values.number("max-value");
  return settings;
}

}  // namespace contrejour::params
