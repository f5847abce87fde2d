// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "base/clock.h"
#include "contrejour/ghost_figures.h"
#include "render/planning/frame_plan.h"
#include "render/radiometry/direct_light.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

// Bare glass of constant index: nothing depends on the wavelength.
LensState grey_lens() {
  LensState lens = test::plate();
  return lens;
}

Result<FramePlan> plan(const LensState& lens, std::span<const Light> lights, const test::Settings& settings) {
  RenderCache cache;
  return plan_frame({lens, lights, settings, cache}, {});
}

Frame frame() { return {60, 40, 0, 0, 60, 40, 0.2}; }

}  // namespace

TEST_CASE("a lens without colour keeps the light's colour for any number of wavelengths") {
  const LensState lens = grey_lens();
  const double flux = GhostMeter(lens, 550.0).direct_flux(Vec3{0, 0, 1});
  Light light;
  light.value = {3.0, 5.0, 7.0};
  for (const int count : {1, 2, 3, 4, 7, 16, 61}) {
    CAPTURE(count);
    test::Settings settings;
    settings.frame = frame();
    settings.wavelengths = count;
    const auto planned = plan(lens, {&light, 1}, settings);
    REQUIRE(planned.has_value());
    Rgb sum{};
    for (const PlannedPass& pass : planned->lights[0].passes) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += pass.gain[c];
    }
    const double times = sum[0] / light.value[0];
    CHECK(times * flux == test::approx(1.0).epsilon(5e-4));
    for (std::size_t c = 0; c < 3; ++c) CHECK(sum[c] == test::approx(times * light.value[c]).epsilon(1e-9));
  }
}

TEST_CASE("more wavelengths converge to one colour, without a shift") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  Light light = test::light_at(lens, frame_on_sensor(lens, 60, 40), {0.7, 0.4});
  const auto colour = [&](int count) {
    test::Settings settings;
    settings.frame = frame_on_sensor(lens, 60, 40);
    settings.wavelengths = count;
    settings.selection = SelectBrightest{1};
    const auto planned = plan(lens, {&light, 1}, settings);
    REQUIRE(planned.has_value());
    Rgb rgb{};
    for (const PlannedPass& pass : planned->lights[0].passes) {
      const double flux = GhostMeter(lens, pass.lambda_nm).measure(planned->ghosts[0], light.direction).flux_mm2;
      for (std::size_t c = 0; c < 3; ++c) rgb[c] += pass.gain[c] * flux;
    }
    return rgb;
  };
  const Rgb truth = colour(81);
  for (const auto& [count, tolerance] : {std::pair{8, 0.06}, std::pair{16, 0.02}, std::pair{40, 0.005}}) {
    const Rgb rgb = colour(count);
    for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(rgb[c] / truth[c] - 1.0) < tolerance);
  }
}

TEST_CASE("direct fluxes of many wavelengths, few of them measured, are those measured at each") {
  struct Case {
    const char* lens;
    double f_number;
    Vec2 uv;
  };
  // The last one vignetted, and outside the frame.
  for (const Case& c :
       {Case{"heliar", 16.0, {0.7, 0.33}}, {"nikon-80-200", 2.97, {0.9, 0.9}}, {"tessar", 4.5, {1.1, 0.5}}}) {
    CAPTURE(c.lens);
    const LensState lens = test::bundled(c.lens, {.f_number = c.f_number});
    const Frame frame = frame_on_sensor(lens, 60, 40);
    const Light light = test::light_at(lens, frame, c.uv);
    const LightSource source = measured_source(lens, frame, light.source());
    const auto bands = spectral_bands(16, light.spectrum, ColourSpace::Rec709);
    const TablesByWavelength tables(lens);
    const auto measured = [&](const SpectralBand& band) {
      return GhostMeter(lens, band.lambda_nm).direct_flux(source);
    };
    KeptFluxes kept(KeptFluxes::key_of(lens));
    MeteredLight metered{source, bands};
    REQUIRE(measure_fluxes(lens, tables, kept, {&metered, 1}, {}));
    REQUIRE(metered.flux_mm2.size() == 16);
    for (std::size_t k = 0; k < bands.size(); ++k)
      CHECK(metered.flux_mm2[k] == test::approx(measured(bands[k])).epsilon(2e-4));
    // With few bands all are measured, in the pupil of the middle one.
    MeteredLight few{source, std::span(bands).first(3)};
    REQUIRE(measure_fluxes(lens, tables, kept, {&few, 1}, {}));
    for (std::size_t k = 0; k < 3; ++k) CHECK(few.flux_mm2[k] == test::approx(measured(bands[k])).epsilon(1e-4));
  }
}

TEST_CASE("selections keep what they say") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  const Light light = test::light_at(lens, frame_on_sensor(lens, 60, 40), {0.7, 0.4});
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame();
  const auto kept = [&](GhostSelection selection) {
    settings.selection = std::move(selection);
    const auto planned = plan(lens, {&light, 1}, settings);
    REQUIRE(planned.has_value());
    return *planned;
  };
  CHECK(kept(SelectAll{}).ghosts.size() == 28);
  CHECK(kept(SelectBrightest{3}).ghosts.size() == 3);
  CHECK(kept(SelectBrightest{100}).ghosts.size() == 28);
  CHECK(kept(SelectBrightest{0}).ghosts.empty());
  CHECK(kept(SelectList{{{1, 3}, {4, 5}}}).ghosts == std::vector<Ghost>{{1, 3}, {4, 5}});
  const FramePlan largest = kept(SelectByFlux{10.0});
  CHECK(largest.skipped_flux.value() <= 0.10);
  CHECK(largest.skipped_flux.value() > 0.0);
  CHECK(largest.ghosts.size() < 28);
  CHECK(kept(SelectByFlux{0.0}).skipped_flux == 0.0);
  CHECK(kept(SelectAll{}).skipped_flux == 0.0);
  for (const Ghost& g : kept(SelectSurface{4}).ghosts) CHECK((g.i == 4 || g.j == 4));
  CHECK(kept(SelectSurface{4}).ghosts.size() == 7);
  // A selection that needs no flux measures none.
  CHECK_FALSE(kept(SelectSurface{4}).skipped_flux.has_value());
  CHECK_FALSE(kept(SelectList{{{1, 3}}}).skipped_flux.has_value());
  settings.selection = SelectList{{{1, 6}}};  // 6 is the stop
  CHECK_FALSE(plan(lens, {&light, 1}, settings).has_value());
}

TEST_CASE("the flare does not jump when its light leaves the frame") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  test::Settings settings = test::green(frame_on_sensor(lens, 60, 40));
  const auto gain_at = [&](double u) {
    const Light light = test::light_at(lens, settings.frame, {u, 0.5});
    return plan(lens, {&light, 1}, settings)->lights[0].passes[0].gain[1];
  };
  CHECK(gain_at(0.9999) == test::approx(gain_at(1.0001)).epsilon(1e-3));
  CHECK(gain_at(1.0001) == test::approx(gain_at(3.0)).epsilon(1e-3));
  CHECK(std::isfinite(gain_at(50.0)));
}

TEST_CASE("settings out of range are refused with a message, not rendered") {
  const LensState lens = grey_lens();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Light light;
  test::Settings good;
  good.wavelengths = 3;
  good.frame = frame();
  const auto refused = [&](const test::Settings& settings, const Light& l) {
    const auto planned = plan(lens, {&l, 1}, settings);
    return !planned.has_value() && planned.error().code == ErrorCode::InvalidArgument;
  };
  CHECK_FALSE(refused(good, light));
  test::Settings bad = good;
  bad.frame.width = 0;
  CHECK(refused(bad, light));
  bad = good;
  bad.frame.width = bad.frame.full_width = 1 << 20;
  bad.frame.height = bad.frame.full_height = 1 << 20;
  CHECK(refused(bad, light));
  bad = good;
  bad.wavelengths = -1;
  CHECK(refused(bad, light));
  Light odd = light;
  odd.direction = {0.0, nan, 1.0};
  CHECK(refused(good, odd));
  odd.direction = {0.0, 0.0, -1.0};
  CHECK(refused(good, odd));
  odd = light;
  odd.value = {1.0, nan, 1.0};
  CHECK(refused(good, odd));
}

TEST_CASE("the driver knows its methods and says so") {
  const LensState lens = test::plate();
  CHECK(render_methods().size() >= 2);
  const auto unknown = render("no-such-method", lens, {}, test::green(frame()));
  REQUIRE_FALSE(unknown.has_value());
  CHECK(unknown.error().message.find("bundle") != std::string::npos);
}

// The light that a selection leaves in each channel of a lens whose coatings reflect nothing at 550 nm: ranked by that
// wavelength alone, ghosts with half of the red had been dropped.
TEST_CASE("selections by flux keep the light of every channel, of the lights' own spectra") {
  Coating v_coat;
  v_coat.films = DesignedCoating{};
  const LensState lens = test::bundled("heliar", {.f_number = 16.0, .coating = v_coat});
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 96, 64);
  settings.wavelengths = 5;
  Light light = test::light_at(lens, settings.frame, {0.7, 0.33});
  settings.frame.pixel_pitch_mm *= 1000.0;  // all light lands inside the frame
  const auto flux_of = [&](const FramePlan& planned) {
    Rgb sum{};
    for (const PlannedPass& pass : planned.lights[0].passes) {
      const GhostMeter meter(lens, pass.lambda_nm);
      for (const Ghost& ghost : planned.ghosts)
        for (std::size_t c = 0; c < 3; ++c) sum[c] += pass.gain[c] * meter.measure(ghost, light.source()).flux_mm2;
    }
    return sum;
  };
  for (const Spectrum& spectrum : {Spectrum{IlluminantD65{}}, Spectrum{BlackBody{2000.0}}}) {
    light.spectrum = spectrum;
    settings.selection = SelectAll{};
    const auto whole = plan(lens, {&light, 1}, settings);
    REQUIRE(whole.has_value());
    const Rgb all = flux_of(*whole);
    for (const double percent : {1.0, 10.0}) {
      CAPTURE(percent);
      settings.selection = SelectByFlux{percent};
      const auto planned = plan(lens, {&light, 1}, settings);
      REQUIRE(planned.has_value());
      CHECK(planned->ghosts.size() < whole->ghosts.size());
      const Rgb kept = flux_of(*planned);
      double max_lost = 0.0;
      for (std::size_t c = 0; c < 3; ++c) max_lost = std::max(max_lost, 1.0 - kept[c] / all[c]);
      CHECK(max_lost <= 0.01 * percent * 1.05);
      // Reddish ghosts are negative in blue: in sums they cancel, but what is left out counts in full.
      CHECK(planned->skipped_flux.value() >= 0.95 * max_lost);
      if (std::holds_alternative<IlluminantD65>(spectrum))
        CHECK(planned->skipped_flux.value() == test::approx(max_lost).epsilon(0.05).scale(0.01));
    }
  }
}

namespace {

Rgb sum_of(const Image& image) {
  Rgb sum{};
  for (std::size_t k = 0; k < image.pixels.size(); ++k) sum[k % 3] += image.pixels[k];
  return sum;
}

double max_lost(const Rgb& kept, const Rgb& all) {
  double lost = 0.0;
  for (std::size_t c = 0; c < 3; ++c) lost = std::max(lost, 1.0 - kept[c] / all[c]);
  return lost;
}

}  // namespace

// Weighted by all their light, ghosts outside the frame had been kept in place of visible ones: these frames lost up to
// two and a half times the stated flux.
TEST_CASE("selections by flux weigh what lands inside the frame, as drawn") {
  struct Case {
    const char* lens;
    LensSettings settings;
    Vec2 uv;
    double offset;  // of the brightest ghost of all, to the right
  };
  for (const Case& c : {Case{"canon-70-200", {.focal_length_mm = 135.0, .f_number = 8.0}, {0.95, 0.9}, 0.0},
                        Case{"nikon-80-200", {.focal_length_mm = 140.0, .f_number = 4.0}, {0.8, 0.7}, 0.0},
                        Case{"heliar", {.f_number = 8.0}, {0.9, 0.9}, 3.0}}) {
    CAPTURE(c.lens);
    const LensState lens = test::bundled(c.lens, c.settings);
    test::Settings settings;
    settings.frame = frame_on_sensor(lens, 192, 128);
    settings.wavelengths = 3;
    settings.scope = GhostScope::OneSideOfStop;
    const Light light = test::light_at(lens, settings.frame, c.uv);
    const auto drawn = [&](GhostSelection selection) {
      settings.selection = std::move(selection);
      auto flare = render("adaptive", lens, {&light, 1}, settings);
      REQUIRE(flare.has_value());
      return std::move(*flare);
    };
    if (c.offset != 0.0) {
      settings.selection = SelectBrightest{1};
      const auto first = plan(lens, {&light, 1}, settings);
      REQUIRE(first.has_value());
      settings.ghosts.adjustments.push_back({.ghost = first->ghosts[0], .offset = {c.offset, 0.0}});
    }
    const Rgb all = sum_of(drawn(SelectAll{}).image);
    for (const GhostSelection& selection :
         {GhostSelection{SelectBrightest{3}}, GhostSelection{SelectByFlux{10.0}}, GhostSelection{SelectByFlux{2.0}}}) {
      const Flare some = drawn(selection);
      const double lost = max_lost(sum_of(some.image), all);
      CAPTURE(lost);
      CHECK(some.statistics.ghosts_skipped_flux.value() == test::approx(lost).epsilon(0.05).scale(0.03));
    }
  }
}

TEST_CASE("windows of a frame show the same ghosts") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 96, 64);
  settings.wavelengths = 3;
  settings.selection = SelectByFlux{10.0};
  const Light light = test::light_at(lens, settings.frame, {0.8, 0.7});
  const auto whole = plan(lens, {&light, 1}, settings);
  REQUIRE(whole.has_value());
  settings.frame.width = settings.frame.height = 8;
  settings.frame.origin_x = 40;
  const auto window = plan(lens, {&light, 1}, settings);
  REQUIRE(window.has_value());
  CHECK(window->ghosts == whole->ghosts);
  CHECK(window->skipped_flux == whole->skipped_flux);
}

// As hullin2011 intends: measuring all ghosts had taken longer than drawing them. Both times are of this process, in
// direct succession, so that a busy machine slows both.
TEST_CASE("selections save time, and figures of all ghosts take that of two frames of them [slow]") {
  const LensState lens = test::bundled("canon-70-200", {.focal_length_mm = 135.0, .f_number = 8.0});
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 640, 427);
  settings.scope = GhostScope::OneSideOfStop;
  const Light light = test::light_at(lens, settings.frame, {0.7, 0.35});
  Context alone;
  alone.threads = 1;
  const auto time_ms = [&](GhostSelection selection) {
    settings.selection = std::move(selection);
    const auto start = Clock::now();
    REQUIRE(render("adaptive", lens, {&light, 1}, settings, alone).has_value());
    return ms_since(start);
  };
  const auto figures_ms = [&] {
    FiguresRequest request{settings.frame, light, settings.scope};
    request.bands = spectral_bands(3, light.spectrum, ColourSpace::Rec709);
    const auto start = Clock::now();
    REQUIRE(ghost_figures(lens, request, alone).has_value());
    return ms_since(start);
  };
  double whole_ms = 1e9, some_ms = 1e9, measured_ms = 1e9;
  for (int k = 0; k < 5; ++k) {
    whole_ms = std::min(whole_ms, time_ms(SelectAll{}));
    some_ms = std::min(some_ms, time_ms(SelectBrightest{20}));
    measured_ms = std::min(measured_ms, figures_ms());
  }
  CHECK(some_ms < 0.85 * whole_ms);
  CHECK(measured_ms < 2.8 * whole_ms);  // about 1.8; 4.7 before
}
