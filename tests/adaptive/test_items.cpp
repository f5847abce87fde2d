// What a small frame tells of the whole one before anything is drawn with care.
#include <doctest/doctest.h>

#include "adaptive/scene.h"
#include "contrejour/metrics.h"
#include "render/adaptive/item.h"
#include "render/interface/frame_plan.h"
#include "support/flares.h"

using namespace contrejour;
using namespace contrejour::adaptive;

namespace {

struct System {
  const char* name;
  double f_number, focal_length_mm;
  Vec2 uv;
};

RoughFrame rough_frame(const LensState& lens, const Light& light, const RenderSettings& settings) {
  const auto plan = plan_frame(lens, {&light, 1}, settings, {});
  REQUIRE(plan.has_value());
  StepsByWavelength steps;
  for (const auto& [lambda_nm, tables] : plan->tables) steps.try_emplace(lambda_nm, lens, *tables);
  const Scene scene{lens, *plan, std::move(steps), IrisShape(lens.iris)};
  Work work;
  const std::vector<Item> items = find_items(scene, {}, work);
  Pool<BoxCells> rooms;
  TileDrawer drawer;
  return draw_roughly(scene, items, settings.frame, rooms, drawer, {}, work);
}

}  // namespace

// Films reflect the middle wavelength least: its light in place of all would be a third of the peak.
TEST_CASE("the peak that errors are relative to is the picture's, whatever its size and wavelengths") {
  for (const System& system :
       {System{"heliar", 16.0, 0.0, {0.7, 0.33}}, System{"itoh-zoom", 32.0, 123.0, {0.7, 0.33}},
        System{"nikon-80-200", 16.0, 140.0, {0.25, 0.75}}, System{"canon-70-200", 32.0, 135.0, {0.7, 0.33}},
        System{"planar-50", 11.0, 0.0, {0.3, 0.8}}}) {
    const LensState lens = test::lens_at_f(system.name, system.f_number, system.focal_length_mm);
    for (const int width : {160, 640}) {
      for (const int wavelengths : {3, 8}) {
        CAPTURE(system.name);
        CAPTURE(width);
        CAPTURE(wavelengths);
        RenderSettings settings;
        settings.frame = frame_on_sensor(lens, width, width * 9 / 16);
        settings.wavelengths = wavelengths;
        const Light light = test::light_at(lens, settings.frame, system.uv);
        const Image image = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
        const double peak = quantile_of_samples(image, 0.999);
        const double rough = rough_frame(lens, light, settings).peak / peak;
        CHECK(rough > 0.6);
        CHECK(rough < 2.0);
      }
    }
  }
}
