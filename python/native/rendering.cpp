// SPDX-License-Identifier: Apache-2.0
// Renderers and starbursts.
#include <optional>
#include <utility>

#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/renderer.h"
#include "native/arrays.h"
#include "native/errors.h"
#include "native/long_call.h"
#include "native/objects.h"

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
  fields["peak_memory_bytes"] = s.peak_memory_bytes;
  return fields;
}

// A renderer and the lens that it has.
class LensRenderer {
 public:
  LensRenderer() : renderer_(value_of(Renderer::create())) {}

  void set_lens(const std::shared_ptr<LensState>& lens) {
    if (lens == lens_) return;
    value_of(renderer_.set_lens(*lens));
    lens_ = lens;
  }

  // Into `out`, or into a new array. Returns the array and the statistics.
  py::tuple render(const params::Values& values, const std::vector<LightFields>& lights, std::optional<py::array> out,
                   const py::object& progress) {
    const PictureRequest request = prepare(values, lights);
    LongCall call(values.integer("threads"), progress);
    if (!out) {
      Flare flare = call.run([&](const Context& context) { return render_picture(request, renderer_, context); });
      return py::make_tuple(array_of(std::move(flare.image)), dict_of(flare.statistics));
    }
    const ImageView view = view_of(*out);
    const RenderStatistics statistics =
        call.run([&](const Context& context) { return render_picture(request, renderer_, view, context); });
    return py::make_tuple(*out, dict_of(statistics));
  }

  // The lights' own images alone.
  py::array starburst(const params::Values& values, const std::vector<LightFields>& lights,
                      const py::object& progress) {
    PictureRequest request = prepare(values, lights);
    request.settings.starburst.on = true;
    request.settings.selection = SelectBrightest{0};
    LongCall call(values.integer("threads"), progress);
    return array_of(
        std::move(call.run([&](const Context& context) { return render_picture(request, renderer_, context); }).image));
  }

 private:
  PictureRequest prepare(const params::Values& values, const std::vector<LightFields>& lights) {
    if (!lens_) throw py::value_error("the renderer has no lens");
    PictureRequest request = value_of(picture_request(values, *lens_, lights_of(lights)));
    value_of(renderer_.set_method(params::method_options(values)));
    return request;
  }

  Renderer renderer_;
  std::shared_ptr<LensState> lens_;
};

}  // namespace

void add_rendering(py::module_& module) {
  py::class_<LensRenderer>(module, "Renderer")
      .def(py::init<>())
      .def("set_lens", &LensRenderer::set_lens, py::arg("lens"))
      .def("render", &LensRenderer::render, py::arg("values"), py::arg("lights"), py::arg("out"), py::arg("progress"))
      .def("starburst", &LensRenderer::starburst, py::arg("values"), py::arg("lights"), py::arg("progress"));
}

}  // namespace contrejour::python
