// SPDX-License-Identifier: Apache-2.0
// Calls every function that takes a lens state, with invalid states: it must return an error, an empty list or NaN, in
// a short time.
#include <atomic>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/lens_starburst.h"
#include "contrejour/expert/machine_speed.h"
#include "contrejour/expert/seidel.h"
#include "contrejour/ghost_figures.h"
#include "robustness/strange.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

Frame small_frame() {
  Frame frame;
  frame.width = frame.full_width = 24;
  frame.height = frame.full_height = 16;
  frame.pixel_pitch_mm = 1.5;
  return frame;
}

std::vector<SpectralBand> one_band() { return {{550.0, {1.0, 1.0, 1.0}}}; }

void walk_values(const LensState& lens) {
  const LightSource light({0.0, 0.0, 1.0});
  use(lens.has_axial_symmetry());
  use(has_stop(lens));
  use(frame_on_sensor(lens, 24, 16));
  for (const GhostScope scope : {GhostScope::OneSideOfStop, GhostScope::All}) {
    if (lens.surfaces.size() < 100 && lens.sensor_grating.orders < 100) {
      use(enumerate_ghosts(lens, scope));
      use(enumerate_ghosts(lens, scope, Reflections::UpToFour));
    }
  }
  for (const Ghost ghost : {Ghost{}, Ghost{1, 2}, Ghost{2, 5}, Ghost{-3, 1000000}, Ghost{2, 3, 1, 4}, Ghost{5, 2}}) {
    use(has_ghost(lens, ghost));
    use(abcd_ghost(lens, ghost, 550.0));
    use(has_axial_symmetry(lens, ghost));
    use(trace(ghost_path(lens, ghost, 550.0), {{0.1, 0.1, -10.0}, {0.0, 0.0, 1.0}}));
  }
  use(first_order(lens, 550.0));
  use(abcd_between(lens.surfaces, 0, 3, 550.0));
  use(abcd_between(lens.surfaces, -2, 100000, 550.0));
  const OpticalPath path = direct_path(lens, 550.0);
  const TracedRay ray = trace(path, {{0.1, 0.1, -10.0}, {0.0, 0.0, 1.0}});
  use(blocked_by(ray, path, lens.iris));
  use(trace_recorded(without_obscurations(path), {{0.1, 0.1, -10.0}, {0.0, 0.0, 1.0}}));
  use(entrance_window(lens, light));
  use(direction_for_image_point(lens, {1.0, 1.0}, 550.0));
  use(chief_ray_image_point(lens, light, 550.0));
  use(seidel_by_surface(lens, {}));
  use(seidel_sums(lens, {}));
  use(peak_hits_per_ms(lens, {1}));
  const GhostMeter meter(lens, 550.0);
  use(meter.direct_flux(light));
  use(meter.measure({1, 2}, light));
}

void walk_results(const LensState& lens) {
  const LightSource light({0.0, 0.0, 1.0});
  CHECK_FALSE(check_lens(lens).has_value());
  use(check_source(lens, light));
  test::Settings settings = green(small_frame());
  settings.set_grid(16);
  const Light one;
  for (const std::string_view method : render_methods()) {
    CHECK_FALSE(render(method, lens, {&one, 1}, settings).has_value());
    CHECK_FALSE(render(method, lens, {}, settings).has_value());
  }
  settings.starburst.on = true;
  settings.glare.fraction = 0.1;
  settings.ringing.mode = RingingMode::Fresnel;
  Light disc;
  disc.radius_rad = 0.01;
  CHECK_FALSE(render("adaptive", lens, {&disc, 1}, settings).has_value());
  CHECK_FALSE(exit_pupil(lens, light, 550.0).has_value());
  CHECK_FALSE(lens_starburst(lens, light, one_band(), {}).has_value());
  FiguresRequest request;
  request.frame = small_frame();
  request.bands = one_band();
  CHECK_FALSE(ghost_figures(lens, request, {}).has_value());
}

}  // namespace

TEST_CASE("functions of a lens state stand any state") {
  for (const NamedLens& strange : strange_lenses()) {
    CAPTURE(strange.what);
    walk_results(strange.lens);
    walk_values(strange.lens);
  }
}

TEST_CASE("states that configure_lens gives are sound") {
  for (const BundledLens& entry : bundled_lenses()) {
    CAPTURE(entry.name);
    const auto lens = find_lens(std::string(entry.name));
    REQUIRE(lens.has_value());
    LensSettings settings;
    settings.sensor = {
        .plates = {SensorPlate{1.0, 1.0, {"", ConstantIndex{1.5}}, {}}}, .reflectance = 0.1, .orders = 1};
    settings.build = {0.001, 0.01, 3};
    for (const LensSettings& set : {LensSettings{}, settings}) {
      const auto state = configure_lens(*lens, set);
      REQUIRE(state.has_value());
      const auto good = check_lens(*state);
      CHECK_MESSAGE(good.has_value(), (good ? "" : good.error().message));
    }
  }
}

TEST_CASE("prescriptions and settings that are none are errors") {
  CHECK_FALSE(validate({}).has_value());
  CHECK_FALSE(configure_lens({}).has_value());
  const Prescription sound = find_lens("canon-70-200").value();
  for (const double v : kStrange) {
    CAPTURE(v);
    Prescription lens = sound;
    lens.surfaces[2].thickness_mm = v;
    lens.surfaces[3].curvature_per_mm = v;
    lens.surfaces[4].semi_diameter_mm = v;
    CHECK_FALSE(validate(lens).has_value());
    for (auto& position : lens.zoom) position.focal_length_mm = v;
    CHECK_FALSE(configure_lens(lens).has_value());
    LensSettings settings;
    settings.focal_length_mm = v;
    CHECK_FALSE(configure_lens(sound, settings).has_value());
    settings = {};
    settings.f_number = v;
    CHECK_FALSE(configure_lens(sound, settings).has_value());
    settings = {};
    settings.build.tilt_rms_rad = v;
    settings.sensor.reflectance = v;
    settings.sensor.pitch_mm = v;
    settings.iris.curvature = v;
    settings.dirt.dust_mm = v;
    settings.object_distance_mm = v;
    use(configure_lens(sound, settings));
  }
  LensSettings settings;
  settings.coating = Coating{"", MeasuredCoating{}};
  CHECK_FALSE(configure_lens(sound, settings).has_value());
  settings.coating = Coating{"", FilmStack{{{FilmMaterial(kNan), kNan}}}};
  CHECK_FALSE(configure_lens(sound, settings).has_value());
  settings = {};
  settings.sensor.plates.assign(3, SensorPlate{});
  use(configure_lens(sound, settings));
  settings.sensor.plates.assign(10000, SensorPlate{});
  CHECK_FALSE(configure_lens(sound, settings).has_value());
}
