// SPDX-License-Identifier: Apache-2.0
// Values -> the settings of a lens: focus, iris, coatings, dirt and sensor.
#include <utility>

#include "contrejour/expert/settings.h"
#include "settings/choice.h"
#include "settings/mask_images.h"
#include "settings/sensor_format.h"

namespace contrejour::params {
namespace {

std::uint32_t seed(const Values& values, std::string_view name) {
  return static_cast<std::uint32_t>(values.integer(name));
}

Result<Iris> iris(const Values& values) {
  Iris iris;
  iris.blades = values.integer("blades");
  iris.rotation_rad = values.number("blade-rotation") * kDegree_rad;
  iris.curvature = values.number("blade-curvature");
  iris.asymmetry = values.number("blade-asymmetry");
  iris.seed = seed(values, "blade-seed");
  iris.slope_spread = values.number("blade-slope-error");
  if (const auto file = values.text("iris-image")) {
    auto field = read_iris_image(*file);
    if (!field) return tl::unexpected(field.error());
    iris.field = std::move(*field);
  }
  return iris;
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
  dirt.plane = choice<DirtPlane>(values, "dirt-plane");
  dirt.seed = seed(values, "dirt-seed");
  dirt.phase = values.number("dirt-phase");
  if (const auto file = values.text("dirt-image")) {
    auto picture = read_dirt_image(*file);
    if (!picture) return tl::unexpected(picture.error());
    dirt.picture = std::move(*picture);
  }
  return dirt;
}

// A file that a coating names may have been removed since the value was checked.
Result<std::vector<SurfaceCoating>> coatings_of_surfaces(const Values& values) {
  std::vector<SurfaceCoating> coatings;
  for (const std::string& text : values.list("coating-at")) {
    auto coating = parse_coating_at(text);
    if (!coating) return tl::unexpected(coating.error());
    coatings.push_back(std::move(*coating));
  }
  return coatings;
}

Result<SensorStack> sensor_stack(const Values& values) {
  SensorStack sensor;
  for (const std::string& text : values.list("cover-glass")) {
    const auto plate = parse_cover_glass(text);
    if (!plate) return tl::unexpected(plate.error());
    sensor.plates.push_back(*plate);
  }
  sensor.reflectance = values.number("sensor-reflectance");
  sensor.orders = values.integer("sensor-orders");
  sensor.pitch_mm = values.number("sensor-pitch") * 1e-3;
  sensor.fill = values.number("sensor-fill");
  return sensor;
}

// Stores a result's value, or returns its error.
template <class T>
Result<void> store(Result<T> result, T& destination) {
  if (!result) return tl::unexpected(result.error());
  destination = std::move(*result);
  return {};
}

}  // namespace

Result<LensSettings> lens_settings(const Values& values) {
  LensSettings settings;
  settings.focal_length_mm = values.real("focal");
  settings.f_number = values.real("fnumber");
  settings.object_distance_mm = *parse_distance_mm(*values.text("focus"));
  if (const auto coating = values.text("coating")) settings.coating = *parse_coating(*coating);
  settings.build = {values.number("tilt") * kDegree_rad, values.number("decentre"), seed(values, "build-seed")};
  settings.iris_closing = choice<IrisClosing>(values, "blade-closing");
  settings.absorption = values.is_on("absorption");
  auto stored = store(coatings_of_surfaces(values), settings.coating_at);
  if (stored) stored = store(iris(values), settings.iris);
  if (stored) stored = store(dirt(values), settings.dirt);
  if (stored) stored = store(sensor_stack(values), settings.sensor);
  if (!stored) return tl::unexpected(stored.error());
  return settings;
}

Prescription with_sensor(Prescription lens, const Values& values) {
  if (const auto sensor = values.text("sensor")) {
    const SensorFormat format = *parse_sensor(*sensor);
    lens.sensor_width_mm = format.width_mm;
    lens.sensor_height_mm = format.height_mm;
  }
  return lens;
}

Result<LensState> lens_of(Prescription lens, const Values& values) {
  const auto settings = lens_settings(values);
  if (!settings) return tl::unexpected(settings.error());
  return configure_lens(with_sensor(std::move(lens), values), *settings);
}

}  // namespace contrejour::params
