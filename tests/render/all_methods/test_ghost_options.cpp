// SPDX-License-Identifier: Apache-2.0
// An artist's adjustments of ghosts, in every renderer.
#include <cmath>
#include <limits>
#include <numbers>

#include "render/all_methods/methods.h"
#include "render/planning/applied_adjustment.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

// Two separate ghosts of a Heliar, and all the others.
struct Scene {
  LensState lens = bundled("heliar", {.f_number = 11.0});
  test::Settings settings = small_frame(lens, 96, 64);
  Light light = light_at(lens, settings.frame, {0.70, 0.33});

  Scene() { settings.reference.density = 0.3; }
  test::Settings only(std::vector<Ghost> ghosts) const {
    test::Settings out = settings;
    out.selection = SelectList{std::move(ghosts)};
    return out;
  }
};

double channel_sum(const Image& image, std::size_t c) {
  double total = 0.0;
  for (std::size_t k = c; k < image.pixels.size(); k += 3) total += image.pixels[k];
  return total;
}

}  // namespace

TEST_CASE("gains and colours of one ghost, and of all") {
  const Scene s;
  const Ghost kGhost{1, 2}, kOther{2, 3};
  for_each_method([&](const Bounds& bounds) {
    const Image one = image_of(bounds, s.lens, s.light, s.only({kGhost}));
    const Image other = image_of(bounds, s.lens, s.light, s.only({kOther}));
    test::Settings both = s.only({kGhost, kOther});
    both.ghosts.gain = 3.0;
    both.ghosts.adjustments = {{.ghost = kGhost, .gain = 0.5, .colour = {1.0, 0.25, 0.0}}};
    const Image image = image_of(bounds, s.lens, s.light, both);
    const double factor[] = {1.5, 0.375, 0.0};
    for (std::size_t c = 0; c < 3; ++c) {
      const double expected = factor[c] * channel_sum(one, c) + 3.0 * channel_sum(other, c);
      CHECK(channel_sum(image, c) == test::approx(expected).epsilon(std::max(bounds.flux, 1e-5)));
    }
  });
}

TEST_CASE("everything off, said or not, is the same to the last bit") {
  const Scene s;
  test::Settings said = s.settings;
  said.ghosts.ramp = {{-1.0, {1, 1, 1}}, {1.0, {1, 1, 1}}};
  said.ghosts.adjustments = {{.ghost = {1, 2}}, {.ghost = {2, 3}}};
  said.ghosts.jitter_seed = 7;
  for_each_method([&](const Bounds& bounds) {
    CHECK(image_of(bounds, s.lens, s.light, said).pixels == image_of(bounds, s.lens, s.light, s.settings).pixels);
  });
}

TEST_CASE("an offset moves a ghost by so many pixels, to the right and up") {
  const Scene s;
  const Ghost kGhost{1, 2};
  test::Settings settings = s.only({kGhost});
  // 8 pixels to the right and 4 up, in a frame 64 pixels high.
  settings.ghosts.adjustments = {{.ghost = kGhost, .offset = {8.0 / 64.0, 4.0 / 64.0}}};
  for_each_method([&](const Bounds& bounds) {
    const Image still = image_of(bounds, s.lens, s.light, s.only({kGhost}));
    const Image moved = image_of(bounds, s.lens, s.light, settings);
    double worst = 0.0;
    for (int y = 0; y + 4 < 64; ++y) {
      for (int x = 0; x + 8 < 96; ++x)
        worst = std::max(worst, std::abs(static_cast<double>(moved.at(x + 8, y)) - still.at(x, y + 4)));
    }
    CHECK(peak_of(still) > 0.0);
    // Light that was outside the frame changes how adaptive distributes its error; with one sample for each pixel, a
    // pixel may change.
    CHECK(worst <= (bounds.traits.spends_error ? 0.02 : bounds.traits.integrates_pixels ? 1e-4 : 1.0) * peak_of(still));
  });
}

TEST_CASE("first-order positions are those at which chief rays of ghosts land") {
  for (const char* name : {"heliar", "planar-50", "canon-70-200"}) {
    const LensState lens = bundled(name);
    const double lambda_nm = lens.design_wavelength_nm;
    // A small angle; the ray through the middle of the stop, by bisection of its height at the first vertex.
    const double slope = 1e-5;
    const auto image_point = [&](const OpticalPath& path) {
      const auto at = [&](double height) { return trace(path, {{0, height, 0}, normalized({0, slope, 1})}); };
      const double a = at(0.0).stop[0].y, b = at(1e-3).stop[0].y;
      return at(-1e-3 * a / (b - a)).sensor_mm.y;
    };
    const double direct_mm = image_point(direct_path(lens, lambda_nm));
    const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
    for (std::size_t g = 0; g < ghosts.size(); g += 7) {
      CAPTURE(ghosts[g].i);
      CAPTURE(ghosts[g].j);
      const double expected = image_point(ghost_path(lens, ghosts[g], lambda_nm)) / direct_mm;
      CHECK(ghost_first_order(lens, ghosts[g], lens.design_wavelength_nm).relative_image_height ==
            test::approx(expected).epsilon(1e-3));
    }
  }
}

TEST_CASE("a ramp colours ghosts by where they lie; scatter is seeded and has its size") {
  const LensState lens = bundled("canon-70-200");
  const Frame frame = frame_on_sensor(lens, 300, 200);
  const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  GhostOptions options;
  options.ramp = {{-1.0, {0, 0, 4}}, {0.0, {1, 2, 0}}, {1.0, {3, 0, 0}}};
  const auto adjustments = applied_adjustments(lens, ghosts, options, frame);
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    const double position =
        std::clamp(ghost_first_order(lens, ghosts[g], lens.design_wavelength_nm).relative_image_height, -1.0, 1.0);
    CHECK(adjustments[g].tint[0] == test::approx(position < 0.0 ? 1.0 + position : 1.0 + 2.0 * position));
    CHECK(adjustments[g].tint[1] == test::approx(2.0 * (1.0 - std::abs(position))));
    CHECK(adjustments[g].tint[2] == test::approx(position < 0.0 ? -4.0 * position : 0.0));
  }
  options = {};
  options.jitter = 0.1;
  const auto scattered = applied_adjustments(lens, ghosts, options, frame);
  double squares = 0.0;
  for (const AppliedAdjustment& adjustment : scattered) squares += dot(adjustment.shift_mm, adjustment.shift_mm);
  const double rms = std::sqrt(squares / static_cast<double>(ghosts.size())) / (200.0 * frame.pixel_pitch_mm);
  CHECK(rms == test::approx(0.1).epsilon(0.12));  // 312 ghosts: a standard deviation of 3 per cent
  const auto alone = applied_adjustments(lens, std::span(&ghosts[100], 1), options, frame);
  CHECK(alone[0].shift_mm == scattered[100].shift_mm);
  options.jitter_seed = 1;
  CHECK_FALSE(applied_adjustments(lens, ghosts, options, frame)[100].shift_mm == scattered[100].shift_mm);
}

TEST_CASE("ghosts of a light at the frame's corner have the edge's gain") {
  const Scene s;
  test::Settings settings = s.settings;
  settings.ghosts.edge_gain = 0.25;
  for_each_method([&](const Bounds& bounds) {
    for (const auto& [uv, gain] : {std::pair{Vec2{1.0, 1.0}, 0.25}, std::pair{Vec2{0.75, 0.75}, 0.625}}) {
      const Light light = light_at(s.lens, s.settings.frame, uv);
      const double plain = sum(image_of(bounds, s.lens, light, s.settings));
      CHECK(sum(image_of(bounds, s.lens, light, settings)) / plain == test::approx(gain).epsilon(1e-3));
    }
  });
}

TEST_CASE("numbers that cannot be are refused") {
  const Scene s;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [&](auto spoil) {
    test::Settings settings = s.settings;
    spoil(settings.ghosts);
    const auto flare = render("adaptive", s.lens, std::span(&s.light, 1), settings);
    return !flare.has_value() && flare.error().code == ErrorCode::InvalidArgument;
  };
  const auto refuses_one = [&](GhostAdjustment one) {
    return refuses([&](GhostOptions& o) { o.adjustments = {one}; });
  };
  CHECK(refuses([&](GhostOptions& o) { o.gain = nan; }));
  CHECK(refuses([&](GhostOptions& o) { o.gain = -1.0; }));
  CHECK(refuses([&](GhostOptions& o) { o.edge_gain = -1.0; }));
  CHECK(refuses([&](GhostOptions& o) { o.jitter = -0.1; }));
  CHECK(refuses([&](GhostOptions& o) { o.ramp = {{0.0, {1, 1, 1}}, {0.0, {1, 1, 1}}}; }));
  CHECK(refuses([&](GhostOptions& o) { o.ramp = {{nan, {1, 1, 1}}}; }));
  CHECK(refuses([&](GhostOptions& o) { o.ramp = {{0.0, {1, -1, 1}}}; }));
  CHECK(refuses_one({.ghost = {2, 99}}));
  CHECK(refuses_one({.ghost = {1, 2}, .gain = -1.0}));
  CHECK(refuses_one({.ghost = {1, 2}, .colour = {1, nan, 1}}));
  CHECK(refuses_one({.ghost = {1, 2}, .offset = {nan, 0}}));
}
