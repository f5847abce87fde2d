// SPDX-License-Identifier: Apache-2.0
// hullin2011's accelerations: what each option may change.
#include <cmath>
#include <memory>
#include <numbers>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "ghosts/meridian.h"
#include "render/bundle/band_blur.h"
#include "render/bundle/bundle.h"
#include "render/bundle/item_renderer.h"
#include "render/bundle/scene.h"
#include "support/approx.h"
#include "support/planned.h"
#include "support/scenes.h"

using namespace contrejour;
using test::light_at;
using test::settings_for;

namespace {

Flare drawn(const LensState& lens, const Light& light, const test::Settings& settings) {
  auto flare = test::render_alone(render_bundle, settings.bundle, lens, {&light, 1}, settings);
  REQUIRE(flare.has_value());
  return *flare;
}

double psnr_db(const Image& a, const Image& b) { return compare(a, b).value().psnr_db.value_or(1000.0); }

double phase_ms(const Flare& flare, std::string_view name) {
  for (const auto& [phase, ms] : flare.statistics.time_ms) {
    if (phase == name) return ms;
  }
  return -1.0;
}

// One ghost by itself, as the renderer draws it: RGB over the frame, per mm^2 of flux.
Image one_ghost(const LensState& lens, Ghost ghost, const Light& light, const test::Settings& settings) {
  FramePlan plan;
  plan.ghosts = {ghost};
  plan.adjustments = {{}};
  plan.lights = {{normalized(light.direction), {}}};
  const TablesByWavelength tables(lens);
  for (const SpectralBand& band : spectral_bands(settings.wavelengths, light.spectrum, settings.colour_space)) {
    plan.lights[0].passes.push_back({band.lambda_nm, band.weight});
  }
  RenderCache cache;
  const StopTransmittances stops(lens, settings, nullptr, cache);
  pupils::KeptPupils kept(pupils::KeptPupils::key_of(lens));
  const Context context;
  const bundle::GridSource source{lens, settings.bundle, tables, stops, kept, nullptr, context};
  Image image(settings.frame.width, settings.frame.height, 3);
  for (const bundle::Item& item : bundle::items_of(plan, settings.bundle)) {
    const auto part = bundle::ItemRenderer(item, settings.frame, source, {}).render();
    std::size_t k = 0;
    for (int y = part.box.y0; y < part.box.y1; ++y) {
      for (int x = part.box.x0; x < part.box.x1; ++x) {
        for (int c = 0; c < 3; ++c) image.at(x, y, c) += part.rgb[k++];
      }
    }
  }
  return image;
}

// A grid of 33 rays a side over the unit square, all open, with image points given by a map.
template <class Map>
RayGrid made_up(Map map, double open_radius = 10.0) {
  LensState lens;
  lens.surfaces = {{SurfaceKind::Stop, 0.0, 0.0, 10.0, air(), air(), {}}};
  lens.stop_radius_mm = 1.0;
  lens.sensor_z_mm = 1.0;
  const ReflectanceTables tables(lens, 550.0);
  RayGrid grid;
  grid.trace(direct_path(lens, 550.0), tables, IrisShape(Iris{}), Vec3{0.0, 0.0, 1.0}, 0.0, {{-1.0, -1.0}, {1.0, 1.0}},
             bundle::kProbeSide, PacketPrecision::Double);
  for (std::size_t k = 0; k < grid.sensor_x_mm.size(); ++k) {
    const Vec2 at{grid.sensor_x_mm[k], grid.sensor_y_mm[k]};
    const Vec2 to = map(at);
    grid.sensor_x_mm[k] = static_cast<float>(to.x);
    grid.sensor_y_mm[k] = static_cast<float>(to.y);
    grid.blocked[k] = static_cast<float>(length(at) / open_radius - 1.0);
  }
  return grid;
}

}  // namespace

TEST_CASE("half the rays, mirrored, are the rays that would have been traced") {
  const LensState lens = test::lens("nikon-80-200", 16.0, 140.0, 7);
  const Meridian meridian = meridian_of(direction_for_image_point(lens, {6.0, 3.0}, 550.0));
  const OpticalPath path = ghost_path(lens, {8, 10}, 550.0);
  const ReflectanceTables tables(lens, 550.0);
  const EntranceWindow window = entrance_window(lens, meridian.light);
  const IrisShape iris(rotated_back(lens.iris, meridian));
  const Rectangle box{{-4.0, -3.0}, {5.0, 3.0}};
  for (const int side : {32, 33}) {
    RayGrid whole;
    RayGrid half;
    whole.trace(path, tables, iris, meridian.light, window.z_mm, box, side, PacketPrecision::Double);
    const std::size_t traced =
        half.trace_mirrored(path, tables, iris, meridian.light, window.z_mm, box, side, PacketPrecision::Double);
    CHECK(traced == static_cast<std::size_t>(side * ((side + 1) / 2)));
    double worst = 0.0;
    for (std::size_t k = 0; k < whole.blocked.size(); ++k) {
      if (whole.blocked[k] > 1.0F) continue;
      worst = std::max({worst, std::abs(static_cast<double>(whole.sensor_x_mm[k]) - half.sensor_x_mm[k]),
                        std::abs(static_cast<double>(whole.sensor_y_mm[k]) - half.sensor_y_mm[k]),
                        std::abs(static_cast<double>(whole.blocked[k]) - half.blocked[k])});
    }
    CHECK(worst < 5e-6);  // entrance points are floats
  }
}

TEST_CASE("mirror symmetry halves the hits and leaves the picture, whatever the iris and the light's azimuth") {
  const LensState lens = test::lens("heliar", 16.0, 0.0, 5);
  test::Settings settings = settings_for(lens, 120, 68, 192);
  for (const Vec2 uv : {Vec2{0.70, 0.33}, {0.2, 0.9}, {0.5, 0.5}}) {
    CAPTURE(uv.x);
    const Light light = light_at(lens, settings.frame, uv);
    settings.bundle.mirror_symmetry = false;
    const Flare whole = drawn(lens, light, settings);
    settings.bundle.mirror_symmetry = true;
    const Flare half = drawn(lens, light, settings);
    CHECK(psnr_db(whole.image, half.image) > 60.0);
    // The search for pupils is not halved.
    CHECK(half.statistics.surface_hits < 0.6 * whole.statistics.surface_hits);
  }
}

TEST_CASE("bounds from the table draw what a search draws") {
  const LensState lens = test::lens("itoh-zoom", 32.0, 123.0, 8);
  test::Settings settings = settings_for(lens, 120, 68, 128);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const Flare searched = drawn(lens, light, settings);
  settings.bundle.precomputed_bounds = true;
  const Flare looked_up = drawn(lens, light, settings);
  CHECK(psnr_db(searched.image, looked_up.image) > 55.0);
  CHECK(compare(searched.image, looked_up.image)->flux_ratio[1] == test::approx(1.0).epsilon(2e-3));
  CHECK(phase_ms(looked_up, "bounds") > 0.0);
}

TEST_CASE("grid levels spend fewer rays and stay close to the finest grid") {
  const LensState lens = test::lens("heliar", 16.0);
  test::Settings settings = settings_for(lens, 160, 90, 512);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const Flare finest = drawn(lens, light, settings);
  settings.bundle.grid_levels = true;
  const Flare levels = drawn(lens, light, settings);
  CHECK(levels.statistics.rays < finest.statistics.rays / 5);
  CHECK(psnr_db(finest.image, levels.image) > 55.0);
}

TEST_CASE("a map's figures: flat, curved, folded, stretched, hardly open") {
  const auto flat = bundle::measure_map(made_up([](Vec2 p) { return p * 3.0; }));
  CHECK(flat.area_variance < 1e-9);
  CHECK(flat.open_fraction == 1.0);
  CHECK(flat.anisotropy == test::approx(1.0).epsilon(1e-4));
  CHECK(bundle::grid_level(flat) == 16);
  // dx'/dx = 1 + x / 2: areas have variance 1/12 over x in -1 .. 1.
  const auto bent = bundle::measure_map(made_up([](Vec2 p) { return Vec2{p.x + 0.25 * p.x * p.x, p.y}; }));
  CHECK(bent.area_variance == test::approx(1.0 / 12.0).epsilon(0.01));
  CHECK(bundle::grid_level(bent) == 128);
  // x' = x^2: areas 2 x, mean size 1, variance 4/3.
  const auto folded = bundle::measure_map(made_up([](Vec2 p) { return Vec2{p.x * p.x, p.y}; }));
  CHECK(folded.area_variance == test::approx(4.0 / 3.0).epsilon(0.01));
  CHECK(bundle::grid_level(folded) == 256);
  const auto stretched = bundle::measure_map(made_up([](Vec2 p) { return Vec2{p.x * 2000.0, p.y}; }));
  CHECK(stretched.anisotropy == test::approx(2000.0).epsilon(1e-3));
  CHECK(bundle::is_very_anisotropic(stretched));
  CHECK_FALSE(bundle::is_very_anisotropic(folded));
  const auto small = bundle::measure_map(made_up([](Vec2 p) { return p; }, 0.2));
  CHECK(small.open_fraction < 0.07);
  CHECK(bundle::grid_level(small) == 64);
}

TEST_CASE("level cells differ from smooth ones by little, in flux not at all") {
  const LensState lens = test::lens("heliar", 4.5);
  test::Settings settings = settings_for(lens, 160, 90, 64);
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const Image smooth = drawn(lens, light, settings).image;
  settings.bundle.smooth_shading = false;
  const Image level = drawn(lens, light, settings).image;
  CHECK(smooth.pixels != level.pixels);
  CHECK(psnr_db(smooth, level) > 40.0);
  CHECK(compare(smooth, level)->flux_ratio[1] == test::approx(1.0).epsilon(2e-4));
}

TEST_CASE("very anisotropic ghosts, drawn finer or as points, keep their flux") {
  const LensState lens = test::lens("nikon-80-200", 16.0, 140.0);
  test::Settings settings = settings_for(lens, 320, 180, 128);
  settings.wavelengths = 1;
  const Ghost ghost{8, 14};
  const Light light = light_at(lens, settings.frame, {0.70, 0.33});
  const Image exact = one_ghost(lens, ghost, light, settings);
  settings.bundle.anisotropic = BundleOptions::Anisotropic::HighResolution;
  const Image finer = one_ghost(lens, ghost, light, settings);
  settings.bundle.anisotropic = BundleOptions::Anisotropic::Points;
  const Image points = one_ghost(lens, ghost, light, settings);
  for (const Image* other : {&finer, &points}) {
    CHECK(compare(exact, *other)->flux_ratio[1] == test::approx(1.0).epsilon(1e-4));
  }
  CHECK(psnr_db(exact, finer) > 60.0);
}

TEST_CASE("a few bands, blurred towards each other, come closer to many bands, for ghosts with colour fringes") {
  const LensState lens = test::lens("distagon-25", 16.0);
  test::Settings settings = settings_for(lens, 3600, 2025, 48);
  const Ghost ghost{13, 15};
  const Light light = light_at(lens, settings.frame, {0.8, 0.2});
  const GhostMeasure m = GhostMeter(lens, 550.0).measure(ghost, light.direction);
  const Vec2 middle = settings.frame.pixel_from_sensor(m.centroid_mm);
  settings.frame.width = settings.frame.height = 160;
  settings.frame.origin_x = static_cast<int>(middle.x) - 80;
  settings.frame.origin_y = static_cast<int>(middle.y) - 80;
  settings.wavelengths = 60;
  const Image truth = one_ghost(lens, ghost, light, settings);
  for (const int bands : {3, 7}) {
    CAPTURE(bands);
    settings.wavelengths = bands;
    settings.bundle.spectral_filter = false;
    const Image plain = one_ghost(lens, ghost, light, settings);
    settings.bundle.spectral_filter = true;
    const Image filtered = one_ghost(lens, ghost, light, settings);
    CHECK(psnr_db(truth, filtered) > psnr_db(truth, plain) + 2.0);
    CHECK(compare(plain, filtered)->flux_ratio[1] == test::approx(1.0).epsilon(1e-3));
  }
}

TEST_CASE("a band's flux is spread half way to its neighbours") {
  const Frame frame{64, 32, 0, 0, 64, 32, 1.0};
  const auto band = [&](double x_px, double spread) {
    bundle::MapFigures figures;
    figures.weight = 1.0;
    figures.centre_mm = frame.sensor_from_pixel({x_px, 16.5});
    figures.spread_mm = {spread, spread};
    return std::optional(figures);
  };
  const std::vector<std::optional<bundle::MapFigures>> bands{band(10.5, 1.0), band(20.5, 1.0), band(40.5, 1.0)};
  const auto motions = bundle::band_motions(bands, frame);
  REQUIRE(motions[1].has_value());
  CHECK(motions[1]->start({20.5, 16.5}).x == test::approx(15.5));
  CHECK(motions[1]->end({20.5, 16.5}).x == test::approx(30.5));
  CHECK(std::abs(motions[0]->end({10.5, 16.5}).x - motions[0]->start({10.5, 16.5}).x) == test::approx(10.0));
  bundle::FluxBox box({0, 0, 64, 32});
  box.add_point({20.5, 16.5}, 15.0);
  const bundle::FluxBox spread = bundle::blurred(box, *motions[1], frame, {0, Context{}});
  const auto at = [&](int x) { return spread.row(16)[static_cast<std::size_t>(x - spread.box().x0)]; };
  CHECK(at(20) == test::approx(1.0));
  CHECK(at(29) == test::approx(1.0));
  CHECK(at(15) == test::approx(0.5));
  CHECK_FALSE(bundle::band_motions(std::vector{band(1.0, 1.0)}, frame)[0].has_value());
}
