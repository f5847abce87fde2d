// SPDX-License-Identifier: Apache-2.0
// Renderers and starbursts.
#include <optional>
#include <utility>

#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/picture_window.h"
#include "contrejour/expert/polynomial_method.h"
#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/source_renderer.h"
#include "contrejour/renderer.h"
#include "native/arrays.h"
#include "native/errors.h"
#include "native/long_call.h"
#include "native/objects.h"
#include "native/polynomials.h"

namespace contrejour::python {
namespace {

py::dict dict_of(const RenderStatistics& s) {
  py::dict times_ms, fields;
  for (const auto& [phase, time_ms] : s.time_ms) times_ms[py::str(phase)] = time_ms;
  fields["method"] = s.method;
  fields["time_ms"] = times_ms;
  fields["rays"] = s.rays;
  fields["primitives"] = s.primitives;
  fields["ghosts_rendered"] = s.ghosts_rendered;
  fields["ghosts_skipped_flux"] = s.ghosts_skipped_flux;
  fields["traced_flux"] = s.traced_flux;
  fields["peak_memory_bytes"] = s.peak_memory_bytes;
  return fields;
}

LayersBy layers_by(const std::string& name) {
  if (name == "light") return LayersBy::Light;
  if (name == "ghost") return LayersBy::Ghost;
  if (name == "part") return LayersBy::Part;
  if (name == "surface") return LayersBy::Surface;
  throw py::value_error("\"" + name + "\" is no kind of layers; give light, ghost, part or surface");
}

// A renderer and the lens, or the measured flare, that it has.
class LensRenderer {
 public:
  LensRenderer() : renderer_(value_of(Renderer::create())) {}

  void set_lens(const std::shared_ptr<LensState>& lens) {
    if (lens == lens_) return;
    if (!std::holds_alternative<Renderer>(renderer_)) renderer_ = value_of(Renderer::create());
    value_of(std::get<Renderer>(renderer_).set_lens(*lens));
    lens_ = lens;
  }

  void set_flare(const std::shared_ptr<MeasuredFlare>& flare) {
    renderer_ = *flare;
    lens_ = nullptr;
  }

  // The fit of the method polynomial, in place of that of a file; none: as the parameters say.
  void set_fit(const std::shared_ptr<AnyFit>& fit) { fit_ = fit; }

  // Into `out`, or into a new array. Returns the array and the statistics.
  py::tuple render(const params::Values& values, const std::vector<LightFields>& lights,
                   const std::optional<WindowFields>& window, std::optional<py::array> out, const py::object& progress,
                   CancelFlag* cancel) {
    PictureRequest request = prepare(values, lights);
    if (window) request = value_of(window_of(std::move(request), window_of_fields(*window), values, geometry()));
    LongCall call(values.integer("threads"), {progress, cancel});
    if (!out) {
      Flare flare = call.run([&](const Context& context) { return render_picture(request, renderer_, context); });
      return py::make_tuple(array_of(std::move(flare.image)), dict_of(flare.statistics));
    }
    const ImageView view = view_of(*out);
    const RenderStatistics statistics =
        call.run([&](const Context& context) { return render_picture(request, renderer_, view, context); });
    return py::make_tuple(*out, dict_of(statistics));
  }

  // The picture, its statistics, and a dictionary of layers that sum to it, whole.
  py::tuple render_layers(const params::Values& values, const std::vector<LightFields>& lights, const std::string& by,
                          int count, double min_percent, const py::object& progress, CancelFlag* cancel) {
    const PictureRequest request = prepare(values, lights);
    LayerOptions options;
    options.by = layers_by(by);
    options.ghost_count = count;
    options.min_percent = min_percent;
    LongCall call(values.integer("threads"), {progress, cancel});
    LayeredFlare flare =
        call.run([&](const Context& context) { return render_picture_layers(request, renderer_, options, context); });
    py::dict layers;
    for (const FlareLayer& layer : flare.layers)
      layers[py::str(layer.name)] = array_of(whole_image(layer, flare.image.width, flare.image.height));
    return py::make_tuple(array_of(std::move(flare.image)), dict_of(flare.statistics), layers);
  }

  // The lights' own images alone.
  py::array starburst(const params::Values& values, const std::vector<LightFields>& lights, const py::object& progress,
                      CancelFlag* cancel) {
    PictureRequest request = prepare(values, lights);
    request.settings.starburst.on = true;
    request.settings.selection = SelectBrightest{0};
    LongCall call(values.integer("threads"), {progress, cancel});
    return array_of(
        std::move(call.run([&](const Context& context) { return render_picture(request, renderer_, context); }).image));
  }

 private:
  PictureRequest prepare(const params::Values& values, const std::vector<LightFields>& lights) {
    if (const auto* flare = std::get_if<MeasuredFlare>(&renderer_))
      return value_of(picture_request(values, *flare, lights_of(lights)));
    if (!lens_) throw py::value_error("the renderer has no lens");
    PictureRequest request = value_of(picture_request(values, *lens_, lights_of(lights)));
    value_of(configure_renderer(std::get<Renderer>(renderer_), values));
    if (fit_) use_fit(values);
    return request;
  }

  void use_fit(const params::Values& values) {
    MethodOptions method = params::method_options(values);
    auto* const options = method.get_if<PolynomialRenderOptions>();
    if (options == nullptr) throw py::value_error("a fit is for method=\"polynomial\" alone");
    options->fit = fit_->state;
    options->range = fit_->range;
    value_of(std::get<Renderer>(renderer_).set_method(std::move(method)));
  }

  [[nodiscard]] LensState geometry() const {
    const auto* flare = std::get_if<MeasuredFlare>(&renderer_);
    return flare != nullptr ? ideal_lens_of(*flare) : *lens_;
  }

  SourceRenderer renderer_;
  std::shared_ptr<LensState> lens_;
  std::shared_ptr<AnyFit> fit_;
};

}  // namespace

void add_rendering(py::module_& module) {
  py::class_<LensRenderer>(module, "Renderer")
      .def(py::init<>())
      .def("set_lens", &LensRenderer::set_lens, py::arg("lens"))
      .def("set_flare", &LensRenderer::set_flare, py::arg("flare"))
      .def("set_fit", &LensRenderer::set_fit, py::arg("fit"))
      .def("render_layers", &LensRenderer::render_layers, py::arg("values"), py::arg("lights"), py::arg("by"),
           py::arg("count"), py::arg("min_percent"), py::arg("progress"), py::arg("cancel"))
      .def("render", &LensRenderer::render, py::arg("values"), py::arg("lights"), py::arg("window"), py::arg("out"),
           py::arg("progress"), py::arg("cancel"))
      .def("starburst", &LensRenderer::starburst, py::arg("values"), py::arg("lights"), py::arg("progress"),
           py::arg("cancel"));
}

}  // namespace contrejour::python
