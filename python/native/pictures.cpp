// SPDX-License-Identifier: Apache-2.0
// Photographs: their lights, their flare, files, and differences between pictures.
#include <memory>
#include <utility>

#include "contrejour/apply.h"
#include "contrejour/expert/measured_settings.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/picture_window.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/source_renderer.h"
#include "contrejour/image_io.h"
#include "native/arrays.h"
#include "native/errors.h"
#include "native/long_call.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

py::dict dict_of(const DetectedLight& light) {
  py::dict fields;
  fields["centroid_px"] = tuple_of(light.centroid_px);
  fields["flux"] = py::make_tuple(light.flux[0], light.flux[1], light.flux[2]);
  fields["rms_radius_px"] = light.rms_radius_px;
  fields["bounds_px"] = py::make_tuple(light.min_x, light.min_y, light.max_x, light.max_y);
  fields["pixel_count"] = light.pixel_count;
  fields["peak"] = light.peak;
  return fields;
}

py::list lights_of_detection(const Detection& found) {
  py::list all;
  for (const DetectedLight& light : found.lights) all.append(dict_of(light));
  return all;
}

Picture picture_of_array(const PixelArray& pixels) {
  Image image = image_of(pixels);
  if (image.channels != 3) throw py::value_error("the picture's shape is not (height, width, 3 or more)");
  return picture_of(image);
}

// The picture with its flare: all steps of apply_flare(), for a window of the picture if one is given, which is then
// what is left of the picture.
Result<AppliedFlare> apply_in_window(Picture& picture, const FlareSource& source, const params::Values& values,
                                     const PixelWindow& window, const Context& context) {
  if (const auto* measured = std::get_if<MeasuredFlare>(&source))
    if (auto good = check_measured_values(*measured, values, MeasuredUse::Photograph); !good)
      return tl::unexpected(good.error());
  const LensState geometry = geometry_of(source);
  auto whole = plan_flare(picture, geometry, values);
  if (!whole) return tl::unexpected(whole.error());
  auto plan = window_of(std::move(*whole), window, picture, values, geometry);
  if (!plan) return tl::unexpected(plan.error());
  auto renderer = renderer_of(values, source);
  if (!renderer) return tl::unexpected(renderer.error());
  picture.rgb = window_of(picture.rgb, window);
  auto flare = render_flare(*plan, picture.rgb, values, *renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  add_flare(picture.rgb, flare->image);
  return AppliedFlare{std::move(*plan), std::move(*flare)};
}

// By a measured flare, if there is one, or else by the lens.
py::tuple apply(const PixelArray& pixels, const LensState& lens, const std::shared_ptr<MeasuredFlare>& measured,
                const params::Values& values, const std::optional<WindowFields>& window, const py::object& progress,
                CancelFlag* cancel) {
  Picture picture = picture_of_array(pixels);
  const FlareSource source = measured ? FlareSource(*measured) : FlareSource(lens);
  LongCall call(values.integer("threads"), {progress, cancel});
  AppliedFlare applied = call.run([&](const Context& context) {
    return window ? apply_in_window(picture, source, values, window_of_fields(*window), context)
                  : apply_flare(picture, source, values, context);
  });
  const FlareVisibility& seen = applied.flare.visibility;
  return py::make_tuple(array_of(std::move(picture.rgb)), array_of(std::move(applied.flare.image)),
                        lights_of_detection(applied.plan.found), applied.plan.warnings,
                        py::make_tuple(seen.brightest, seen.relative_to_picture, seen.stops_to_obvious));
}

py::tuple detect(const PixelArray& pixels, const params::Values& values) {
  const Image image = image_of(pixels);
  const Detection found = value_of([&] {
    const py::gil_scoped_release unlocked;
    return detect_lights(image, values);
  }());
  return py::make_tuple(found.threshold, lights_of_detection(found), array_of(light_matte(image, found)));
}

py::tuple compare_pictures(const PixelArray& a, const PixelArray& b) {
  const Comparison c = value_of(compare(image_of(a), image_of(b)));
  return py::make_tuple(c.psnr_db, c.peak, c.max_abs_error, c.flux_ratio, c.non_finite_mismatches);
}

void write(const std::string& file, const PixelArray& pixels, bool half) {
  const Image image = image_of(pixels);
  value_of([&] {
    const py::gil_scoped_release unlocked;
    return write_picture(file, picture_of(image, half ? SampleType::Half : SampleType::Float));
  }());
}

PreviewSettings preview_of(const Image& image, std::optional<double> exposure_stops) {
  PreviewSettings settings;
  settings.exposure_stops = exposure_stops ? *exposure_stops : params::automatic_exposure(image);
  return settings;
}

}  // namespace

void add_pictures(py::module_& module) {
  module.def("apply", apply, py::arg("picture"), py::arg("lens"), py::arg("measured"), py::arg("values"),
             py::arg("window"), py::arg("progress"), py::arg("cancel"));
  module.def("detect_lights", detect, py::arg("picture"), py::arg("values"));
  module.def("compare", compare_pictures, py::arg("a"), py::arg("b"));
  module.def(
      "read_picture", [](const std::string& file) { return array_of(std::move(value_of(read_picture(file)).rgb)); },
      py::arg("file"));
  module.def("write_picture", write, py::arg("file"), py::arg("pixels"), py::arg("half"));
  module.def(
      "preview_png",
      [](const PixelArray& pixels, std::optional<double> exposure_stops) {
        const Image image = image_of(pixels);
        const auto png = value_of(preview_png(image, preview_of(image, exposure_stops)));
        return py::bytes(reinterpret_cast<const char*>(png.data()), png.size());
      },
      py::arg("pixels"), py::arg("exposure_stops"));
}

}  // namespace contrejour::python
