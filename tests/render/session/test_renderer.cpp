// SPDX-License-Identifier: Apache-2.0
// A renderer that lives from frame to frame gives the bits of one made for a single frame, whatever it rendered before.
#include "contrejour/renderer.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <half.h>

#include "support/approx.h"
#include "support/sanitized.h"
#include "support/scenes.h"

using namespace contrejour;
using test::bundled;

namespace {

struct SessionFrame {
  const char* what;
  LensState lens;
  std::vector<Light> lights;
  FrameSettings settings;
};

SessionFrame frame_of(const char* what, LensState lens, Vec2 light_uv, int width = 60) {
  SessionFrame f{what, std::move(lens), {}, {}};
  f.settings.frame = frame_on_sensor(f.lens, width, width * 2 / 3);
  f.lights = {test::light_at(f.lens, f.settings.frame, light_uv)};
  f.settings.scope = GhostScope::OneSideOfStop;
  f.settings.wavelengths = 3;
  return f;
}

// Each frame differs from the one before it in the way that its name says.
std::vector<SessionFrame> changing_frames() {
  const Dirt dirt{.dust_per_cm2 = 20.0, .plane = DirtPlane::Front};
  std::vector<SessionFrame> frames;
  frames.push_back(frame_of("first", bundled("heliar", {.f_number = 8.0}), {0.7, 0.35}));
  frames.push_back(frame_of("light moved", bundled("heliar", {.f_number = 8.0}), {0.62, 0.3}));
  frames.push_back(frame_of("stop", bundled("heliar", {.f_number = 11.0}), {0.62, 0.3}));
  frames.push_back(frame_of("size", bundled("heliar", {.f_number = 11.0}), {0.62, 0.3}, 90));
  frames.push_back(frame_of("blades", bundled("heliar", {.f_number = 11.0, .iris = {.blades = 6}}), {0.62, 0.3}));
  frames.push_back(frames.back());
  frames.back().what = "ringing";
  frames.back().settings.ringing.mode = RingingMode::Fresnel;
  frames.push_back(
      frame_of("blades with ringing", bundled("heliar", {.f_number = 11.0, .iris = {.blades = 5}}), {0.6, 0.3}));
  frames.back().settings.ringing.mode = RingingMode::Fresnel;
  frames.push_back(frame_of("dirt", bundled("heliar", {.f_number = 11.0, .dirt = dirt}), {0.62, 0.3}));
  frames.push_back(frame_of("focus and dirt",
                            bundled("heliar", {.f_number = 11.0, .object_distance_mm = 2000.0, .dirt = dirt}),
                            {0.62, 0.3}));
  frames.push_back(frame_of(
      "coating", bundled("heliar", {.f_number = 11.0, .coating = Coating{.films = QuarterWave{}}}), {0.62, 0.3}));
  frames.push_back(frame_of("lens", bundled("tessar", {.f_number = 8.0}), {0.4, 0.35}));
  frames.push_back(frame_of("starburst", bundled("tessar", {.f_number = 8.0}), {0.4, 0.35}));
  frames.back().settings.starburst.on = true;
  frames.push_back(frame_of("wavelengths by need", bundled("tessar", {.f_number = 8.0}), {0.4, 0.35}));
  frames.back().settings.wavelengths = kAutoWavelengths;
  frames.push_back(frame_of("zoom", bundled("canon-70-200", {.focal_length_mm = 100.0, .f_number = 8.0}), {0.55, 0.5}));
  frames.push_back(
      frame_of("longer zoom", bundled("canon-70-200", {.focal_length_mm = 135.0, .f_number = 8.0}), {0.55, 0.5}));
  return frames;
}

MethodOptions quick_options(std::string_view method) {
  test::Settings settings;
  settings.set_grid(24);
  settings.reference.density = 0.3;
  const auto options = settings.options(method);
  REQUIRE(options.has_value());
  return *options;
}

Renderer renderer_of(const MethodOptions& method) {
  auto made = Renderer::create(method);
  REQUIRE(made.has_value());
  return std::move(*made);
}

}  // namespace

TEST_CASE("whatever changes from one frame to the next, it has the bits of a frame by itself [slow]") {
  for (const std::string_view name : render_methods()) {
    CAPTURE(name);
    const MethodOptions method = quick_options(name);
    Renderer session = renderer_of(method);
    for (SessionFrame f : changing_frames()) {
      // All ghosts by one method are enough: for the others they take twenty times as long.
      if (name != "adaptive") f.settings.selection = SelectList{{{1, 2}, {1, 3}}};
      if (method_traits(name)->is_slow && f.lens.name.find("Canon") != std::string::npos) continue;
      CAPTURE(f.what);
      REQUIRE(session.set_lens(f.lens).has_value());
      Image kept(f.settings.frame.width, f.settings.frame.height);
      const auto drawn = session.render(f.lights, f.settings, {.pixels = view_of(kept)});
      REQUIRE(drawn.has_value());
      const auto alone = render(method, f.lens, f.lights, f.settings);
      REQUIRE(alone.has_value());
      CHECK(kept.pixels == alone->image.pixels);
      CHECK(drawn->rays <= alone->statistics.rays);  // rays of kept pupils are not traced again
    }
  }
}

TEST_CASE("a session ranks its ghosts as a frame by itself does, whatever changes") {
  Renderer session = renderer_of(AdaptiveOptions{0.02});
  for (SessionFrame f : changing_frames()) {
    CAPTURE(f.what);
    f.settings.selection = SelectBrightest{3};
    REQUIRE(session.set_lens(f.lens).has_value());
    for (const double value : {1.0, 3.0}) {  // the second frame finds the fluxes of the first
      f.lights.front().value = {value, 1.0, 1.0 / value};
      const auto drawn = session.render_layers(f.lights, f.settings, {.by = LayersBy::Ghost, .ghost_count = 2});
      const auto alone =
          render_layers(AdaptiveOptions{0.02}, f.lens, f.lights, f.settings, {.by = LayersBy::Ghost, .ghost_count = 2});
      REQUIRE(drawn.has_value());
      REQUIRE(alone.has_value());
      CHECK(drawn->image.pixels == alone->image.pixels);
      CHECK(drawn->statistics.ghosts_skipped_flux == alone->statistics.ghosts_skipped_flux);
      for (std::size_t k = 0; k < alone->layers.size(); ++k) CHECK(drawn->layers[k].name == alone->layers[k].name);
    }
  }
}

TEST_CASE("a draft comes first, near to the frame, and leaves no trace") {
  const SessionFrame f = frame_of("", bundled("heliar", {.f_number = 8.0}), {0.7, 0.35}, 120);
  Renderer session = renderer_of(AdaptiveOptions{});
  REQUIRE(session.set_lens(f.lens).has_value());
  Image image(120, 80), draft;
  double before = 0.0;
  Context context;
  context.progress = [&](double done) { before = done; };
  const auto drawn = session.render(f.lights, f.settings,
                                    {view_of(image),
                                     [&] {
                                       CHECK(before == 0.0);
                                       draft = image;
                                     }},
                                    context);
  REQUIRE(drawn.has_value());
  const auto alone = render(AdaptiveOptions{}, f.lens, f.lights, f.settings);
  REQUIRE(alone.has_value());
  CHECK(image.pixels == alone->image.pixels);
  REQUIRE(draft.pixels.size() == image.pixels.size());
  CHECK(test::sum(draft) == test::approx(test::sum(image)).epsilon(0.05));
  CHECK(draft.pixels != image.pixels);
}

TEST_CASE("a frame goes into a host's pixels: half floats with alpha, rows from the bottom up") {
  SessionFrame f = frame_of("", bundled("heliar", {.f_number = 8.0}), {0.7, 0.35});
  f.settings.frame.width = 31;  // a region
  f.settings.frame.origin_x = 11;
  Renderer session = renderer_of(AdaptiveOptions{});
  REQUIRE(session.set_lens(f.lens).has_value());
  const int width = 31, height = f.settings.frame.height;
  const std::size_t row = 4 * static_cast<std::size_t>(width) + 6;
  std::vector<half> host(row * static_cast<std::size_t>(height), half(7.0F));
  const auto sample = static_cast<std::ptrdiff_t>(sizeof(half)), row_bytes = sample * static_cast<std::ptrdiff_t>(row);
  const ImageView view{host.data() + row * static_cast<std::size_t>(height - 1),
                       width,
                       height,
                       PixelType::Half,
                       sample,
                       4 * sample,
                       -row_bytes};
  REQUIRE(session.render(f.lights, f.settings, {.pixels = view}).has_value());
  const auto alone = session.render(f.lights, f.settings);
  REQUIRE(alone.has_value());
  REQUIRE(test::sum(alone->image) > 0.0);
  for (int y = 0; y < height; ++y) {
    const half* line = host.data() + row * static_cast<std::size_t>(height - 1 - y);
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) REQUIRE(line[4 * x + c] == half(alone->image.at(x, y, c)));
      REQUIRE(line[4 * x + 3] == half(7.0F));
    }
    for (std::size_t k = 4 * static_cast<std::size_t>(width); k < row; ++k) REQUIRE(line[k] == half(7.0F));
  }
}

TEST_CASE("a cancelled frame leaves the renderer as it was") {
  const SessionFrame f = frame_of("", bundled("heliar", {.f_number = 8.0}), {0.7, 0.35});
  Renderer session = renderer_of(AdaptiveOptions{});
  REQUIRE(session.set_lens(f.lens).has_value());
  const auto first = session.render(f.lights, f.settings);
  REQUIRE(first.has_value());
  std::atomic<bool> cancel = true;
  Image image(60, 40);
  const auto stopped = session.render(f.lights, f.settings, {.pixels = view_of(image)}, {.cancel = &cancel});
  REQUIRE_FALSE(stopped.has_value());
  CHECK(stopped.error().code == ErrorCode::Cancelled);
  const auto again = session.render(f.lights, f.settings);
  REQUIRE(again.has_value());
  CHECK(again->image.pixels == first->image.pixels);
}

TEST_CASE("cancelled at any moment, a renderer keeps nothing that is incomplete") {
  using Steady = std::chrono::steady_clock;
  constexpr int kMoments = test::kSanitized ? 4 : 7;
  const LensState dirty = bundled("heliar", {.f_number = 16.0, .iris = {.blades = 6}, .dirt = {.dust_per_cm2 = 30.0}});
  for (const RingingMode mode : {RingingMode::Fresnel, RingingMode::Hullin}) {
    CAPTURE(static_cast<int>(mode));
    SessionFrame f = frame_of("", dirty, {0.7, 0.35});
    f.settings.ringing.mode = mode;
    const auto began = Steady::now();
    const auto alone = render(AdaptiveOptions{}, f.lens, f.lights, f.settings);
    const auto took = Steady::now() - began;
    REQUIRE(alone.has_value());
    for (int k = 0; k < kMoments; ++k) {
      Renderer fresh = renderer_of(AdaptiveOptions{});  // which has to make all that it keeps
      REQUIRE(fresh.set_lens(f.lens).has_value());
      std::atomic<bool> cancel = false;
      std::thread stopper([&, until = Steady::now() + took * k / kMoments] {
        std::this_thread::sleep_until(until);
        cancel = true;
      });
      const auto stopped = fresh.render(f.lights, f.settings, Context{.threads = 1 + k % 2, .cancel = &cancel});
      stopper.join();
      if (!stopped) CHECK(stopped.error().code == ErrorCode::Cancelled);
      const auto again = fresh.render(f.lights, f.settings);
      REQUIRE(again.has_value());
      CHECK(again->image.pixels == alone->image.pixels);
    }
  }
}

TEST_CASE("another renderer draws at the same time, with the method and the lens of the first") {
  const std::vector<SessionFrame> frames = changing_frames();
  auto first = Renderer::create(AdaptiveOptions{0.01});
  REQUIRE(first.has_value());
  REQUIRE(first->set_lens(frames.front().lens).has_value());
  const auto alone = first->render(frames.front().lights, frames.front().settings);
  auto other = first->another();
  REQUIRE((alone && other));
  CHECK_FALSE(other->has_device());
  std::vector<Pixels> by_other;
  std::thread drawing([&] {
    for (int k = 0; k < 3; ++k)
      if (auto flare = other->render(frames.front().lights, frames.front().settings))
        by_other.push_back(std::move(flare->image.pixels));
  });
  for (std::size_t k = 1; k < 4; ++k) {
    CHECK(first->set_lens(frames[k].lens).has_value());
    CHECK(first->render(frames[k].lights, frames[k].settings).has_value());
  }
  drawing.join();
  CHECK(by_other == std::vector<Pixels>(3, alone->image.pixels));
}

TEST_CASE("what a renderer refuses") {
  const SessionFrame f = frame_of("", bundled("heliar", {.f_number = 8.0}), {0.7, 0.35});
  Renderer session = renderer_of(AdaptiveOptions{});
  const auto no_lens = session.render(f.lights, f.settings);
  REQUIRE_FALSE(no_lens.has_value());
  CHECK(no_lens.error().message.find("set_lens") != std::string::npos);
  CHECK_FALSE(session.set_lens(LensState{}).has_value());
  REQUIRE(session.set_lens(f.lens).has_value());
  Image other(61, 40);
  CHECK_FALSE(session.render(f.lights, f.settings, {.pixels = view_of(other)}).has_value());
  CHECK_FALSE(session.render(f.lights, f.settings, FrameTarget{}).has_value());
  FrameTarget nowhere;
  nowhere.is_discarded = true;
  CHECK(session.render(f.lights, f.settings, nowhere).has_value());
  CHECK(session.render(f.lights, f.settings).has_value());
  REQUIRE(session.set_method(BundleOptions{.grid = {.rays = 1}}).has_value());
  CHECK_FALSE(session.render(f.lights, f.settings).has_value());
}

TEST_CASE("what a standing light has in common with the frame before is not computed again") {
  SessionFrame f = frame_of("", bundled("tessar", {.f_number = 8.0}), {0.45, 0.35});
  f.settings.starburst.on = true;
  f.settings.selection = SelectBrightest{6};
  Renderer session = renderer_of(AdaptiveOptions{});
  REQUIRE(session.set_lens(f.lens).has_value());
  const auto first = session.render(f.lights, f.settings);
  REQUIRE(first.has_value());
  const std::size_t kept_bytes = session.memory_bytes();
  CHECK(kept_bytes > 1000);

  f.lights[0].value = {3.0, 2.0, 1.0};
  const auto second = session.render(f.lights, f.settings);
  const auto alone = render(AdaptiveOptions{}, f.lens, f.lights, f.settings);
  REQUIRE(second.has_value());
  REQUIRE(alone.has_value());
  CHECK(second->image.pixels == alone->image.pixels);
  CHECK(second->statistics.rays < alone->statistics.rays);
}

TEST_CASE("grids of rays spread over the pupils that a session has searched for a light that stands still") {
  for (const std::string_view name : {"bundle", "tiled"}) {
    CAPTURE(name);
    const MethodOptions method = quick_options(name);
    SessionFrame f = frame_of("", bundled("tessar", {.f_number = 8.0, .iris = {.blades = 6}}), {0.45, 0.35});
    Renderer session = renderer_of(method);
    REQUIRE(session.set_lens(f.lens).has_value());
    const auto first = session.render(f.lights, f.settings);
    f.lights[0].value = {3.0, 2.0, 1.0};
    const auto second = session.render(f.lights, f.settings);
    const auto alone = render(method, f.lens, f.lights, f.settings);
    REQUIRE((first && second && alone));
    CHECK(second->image.pixels == alone->image.pixels);
    CHECK(static_cast<double>(second->statistics.rays) < 0.5 * static_cast<double>(alone->statistics.rays));
    f.lens.iris.rotation_rad += 0.3;  // of which the pupils' bounds are the same only for a round iris
    REQUIRE(session.set_lens(f.lens).has_value());
    const auto turned = session.render(f.lights, f.settings);
    REQUIRE(turned.has_value());
    CHECK(turned->image.pixels == render(method, f.lens, f.lights, f.settings)->image.pixels);
  }
}

TEST_CASE("a session's memory does not grow with the number of frames") {
  SessionFrame f = frame_of("", bundled("tessar", {.f_number = 8.0}), {0.45, 0.35}, 30);
  f.settings.starburst.on = true;
  Renderer session = renderer_of(AdaptiveOptions{});
  REQUIRE(session.set_lens(f.lens).has_value());
  std::vector<std::size_t> bytes;
  for (int frame = 0; frame < 12; ++frame) {
    f.lights = {test::light_at(f.lens, f.settings.frame, {0.3 + 0.01 * frame, 0.4})};
    REQUIRE(session.render(f.lights, f.settings).has_value());
    bytes.push_back(session.memory_bytes());
  }
  CHECK(bytes[11] < 1.1 * static_cast<double>(bytes[5]));
}
