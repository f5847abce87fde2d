// SPDX-License-Identifier: Apache-2.0
// A flare in layers is the flare, by every method: the layers sum to it, each is the picture of its own part, and no
// layer is drawn with a larger error than the whole.
#include <algorithm>
#include <set>
#include <string>

#include "contrejour/expert/flare_layers.h"
#include "contrejour/renderer.h"
#include "render/all_methods/methods.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

constexpr double kRounding = 1e-6;  // of the peak

struct LayeredScene {
  LensState lens;
  std::vector<Light> lights;
  test::Settings settings;
};

LayeredScene two_lights(int width = 36, int height = 24) {
  LayeredScene scene{bundled("heliar", {.f_number = 16.0}), {}, {}};
  scene.settings = small_frame(scene.lens, width, height);
  scene.settings.set_grid(48);
  scene.settings.reference.density = 0.2;
  scene.settings.glare.fraction = 0.1;
  for (const Vec2 uv : {Vec2{0.7, 0.33}, Vec2{0.3, 0.6}})
    scene.lights.push_back(light_at(scene.lens, scene.settings.frame, uv));
  scene.lights.back().value = {0.2, 0.5, 0.1};
  return scene;
}

LayeredFlare layers_of(const Bounds& method, const LayeredScene& scene, const LayerOptions& options) {
  const auto own = test::options_for(method.method, scene.lens, scene.settings);
  REQUIRE(own.has_value());
  auto flare = render_layers(*own, scene.lens, scene.lights, scene.settings, options);
  REQUIRE_MESSAGE(flare.has_value(), (flare ? "" : flare.error().to_string()));
  return std::move(*flare);
}

Image sum_of_layers(const LayeredFlare& flare) {
  Image sum(flare.image.width, flare.image.height);
  for (const FlareLayer& layer : flare.layers) {
    const Image whole = whole_image(layer, sum.width, sum.height);
    for (std::size_t k = 0; k < sum.pixels.size(); ++k) sum.pixels[k] += whole.pixels[k];
  }
  return sum;
}

std::vector<std::string> names_of(const LayeredFlare& flare) {
  std::vector<std::string> names;
  for (const FlareLayer& layer : flare.layers) names.push_back(layer.name);
  return names;
}

Image layer_named(const LayeredFlare& flare, const std::string& name) {
  const auto found = std::ranges::find(flare.layers, name, &FlareLayer::name);
  REQUIRE_MESSAGE(found != flare.layers.end(), name);
  return whole_image(*found, flare.image.width, flare.image.height);
}

constexpr LayersBy kAllKinds[] = {LayersBy::Light, LayersBy::Ghost, LayersBy::Part, LayersBy::Surface};

}  // namespace

TEST_CASE("layers of any kind sum to the flare, by any method") {
  LayeredScene scene = two_lights();
  for_each_method([&](const Bounds& bounds) {
    scene.settings.starburst.on = bounds.method == "adaptive";  // is the same by all methods
    const Image whole = image_of(bounds, scene.lens, scene.lights, scene.settings);
    for (const LayersBy by : kAllKinds) {
      CAPTURE(static_cast<int>(by));
      const LayeredFlare flare = layers_of(bounds, scene, {.by = by, .ghost_count = 4});
      CHECK(largest_difference(flare.image, whole) <= kRounding * peak_of(whole));
      CHECK(largest_difference(sum_of_layers(flare), whole) <= kRounding * peak_of(whole));
    }
  });
}

TEST_CASE("a layer is the picture of its own ghosts and lights") {
  LayeredScene scene = two_lights();
  for_each_method([&](const Bounds& bounds) {
    const bool has_starburst = scene.settings.starburst.on = bounds.method == "adaptive";
    const LayeredFlare by_ghost = layers_of(bounds, scene, {.by = LayersBy::Ghost, .ghosts = {{2, 5}, {1, 2}}});
    std::vector<std::string> names{"ghost_2_5", "ghost_1_2", "rest", "glare"};
    if (has_starburst) names.insert(names.begin() + 3, "starburst");
    CHECK(names_of(by_ghost) == names);
    const LayeredFlare by_light = layers_of(bounds, scene, {.by = LayersBy::Light, .light_names = {"head light"}});
    CHECK(names_of(by_light) == std::vector<std::string>{"head_light", "light2"});
    const LayeredFlare by_surface = layers_of(bounds, scene, {.by = LayersBy::Surface});

    test::Settings alone = scene.settings;
    const double allowed = bounds.addition * peak_of(by_light.image);
    const Image second = image_of(bounds, scene.lens, {&scene.lights[1], 1}, alone);
    CHECK(largest_difference(layer_named(by_light, "light2"), second) <= allowed);
    alone.starburst.on = false;
    alone.glare.fraction = 0.0;
    alone.selection = SelectList{{{2, 5}}};
    const Image ghost = image_of(bounds, scene.lens, scene.lights, alone);
    CHECK(peak_of(ghost) > 0.0);
    CHECK(largest_difference(layer_named(by_ghost, "ghost_2_5"), ghost) <= allowed);
    SelectList first_at_5;
    for (const Ghost& g : enumerate_ghosts(scene.lens, alone.scope))
      if (g.j == 5) first_at_5.ghosts.push_back(g);
    alone.selection = first_at_5;
    CHECK(largest_difference(layer_named(by_surface, "surface_5"), image_of(bounds, scene.lens, scene.lights, alone)) <=
          allowed);
  });
}

TEST_CASE("the layers of lights with a size, with ringing and dirt sum to their flare") {
  LayeredScene scene = two_lights(60, 40);
  scene.lens = bundled("heliar", {.f_number = 16.0, .dirt = {.dust_per_cm2 = 10.0, .plane = DirtPlane::Front}});
  scene.settings.ringing.mode = RingingMode::Fresnel;
  scene.lights.front().radius_rad = 0.02;
  const Bounds bounds = bounds_of("adaptive");
  const Image whole = image_of(bounds, scene.lens, scene.lights, scene.settings);
  for (const LayersBy by : kAllKinds) {
    CAPTURE(static_cast<int>(by));
    const LayeredFlare flare = layers_of(bounds, scene, {.by = by, .ghost_count = 3});
    CHECK(largest_difference(sum_of_layers(flare), flare.image) <= kRounding * peak_of(whole));
    CHECK(largest_difference(flare.image, whole) <= kRounding * peak_of(whole));
  }
}

// The error of the whole frame is shared by all ghosts: a dim ghost drawn by itself has more of it.
TEST_CASE("a dim layer is drawn at the frame's error, not at its own") {
  LayeredScene scene = two_lights(160, 100);
  scene.settings.glare.fraction = 0.0;
  const LayeredFlare layered = layers_of(bounds_of("adaptive"), scene, {.by = LayersBy::Ghost, .ghost_count = 3});
  auto fine_settings = scene.settings;
  fine_settings.adaptive.error = 1e-4;
  const LayeredFlare fine = [&] {
    auto flare = render_layers(fine_settings.adaptive, scene.lens, scene.lights, fine_settings,
                               {.by = LayersBy::Ghost, .ghost_count = 3});
    REQUIRE(flare.has_value());
    return std::move(*flare);
  }();
  for (const FlareLayer& layer : layered.layers) {
    CAPTURE(layer.name);
    const Image exact = layer_named(fine, layer.name), drawn = whole_image(layer, 160, 100);
    CHECK(rms_difference(exact, drawn) <= scene.settings.adaptive.error * peak_of(fine.image));
  }
}

TEST_CASE("the brightest ghosts have layers of their own, the same ones as SelectBrightest") {
  LayeredScene scene = two_lights();
  for (const int count : {0, 1, 5, 1000}) {
    CAPTURE(count);
    const LayerOptions options{.by = LayersBy::Ghost, .ghost_count = count};
    const auto ghosts = brightest_ghosts(scene.lens, scene.lights, scene.settings, options);
    REQUIRE(ghosts.has_value());
    const std::size_t all = enumerate_ghosts(scene.lens, scene.settings.scope).size();
    CHECK(ghosts->size() == std::min(static_cast<std::size_t>(count), all));
    LayerOptions listed = options;
    listed.ghosts = *ghosts;
    if (count == 0) continue;
    CHECK(names_of(layers_of(bounds_of("adaptive"), scene, options)) ==
          names_of(layers_of(bounds_of("adaptive"), scene, listed)));
    test::Settings selected = scene.settings;
    selected.selection = SelectBrightest{count};
    const auto same = brightest_ghosts(scene.lens, scene.lights, selected, {.ghost_count = 1000});
    REQUIRE(same.has_value());
    CHECK(std::set<Ghost>(same->begin(), same->end()) == std::set<Ghost>(ghosts->begin(), ghosts->end()));
  }
  const auto bright = brightest_ghosts(scene.lens, scene.lights, scene.settings, {.min_percent = 20.0});
  REQUIRE(bright.has_value());
  CHECK(!bright->empty());
  CHECK(bright->size() < 5);
}

TEST_CASE("a session gives the layers of a single call, before and after whole frames") {
  const LayeredScene scene = two_lights();
  const LayerOptions options{.by = LayersBy::Ghost, .ghost_count = 3};
  const LayeredFlare expected = layers_of(bounds_of("adaptive"), scene, options);
  auto renderer = Renderer::create(scene.settings.adaptive);
  REQUIRE(renderer.has_value());
  CHECK(!renderer->render_layers(scene.lights, scene.settings, options).has_value());
  REQUIRE(renderer->set_lens(scene.lens).has_value());
  std::set<const float*> memory;
  for (int turn = 0; turn < 2; ++turn) {
    const auto layers = renderer->render_layers(scene.lights, scene.settings, options);
    REQUIRE(layers.has_value());
    CHECK(layers->image.pixels == expected.image.pixels);
    for (std::size_t k = 0; k < expected.layers.size(); ++k)
      CHECK(layers->layers[k].image.pixels == expected.layers[k].image.pixels);
    // The memory of the first turn's pictures, which are gone, serves the second.
    if (turn > 0) CHECK(memory.contains(layers->layers.front().image.pixels.data()));
    for (const FlareLayer& layer : layers->layers) memory.insert(layer.image.pixels.data());
    memory.insert(layers->image.pixels.data());
    const auto whole = renderer->render(scene.lights, scene.settings);
    REQUIRE(whole.has_value());
    CHECK(whole->image.pixels == image_of(bounds_of("adaptive"), scene.lens, scene.lights, scene.settings).pixels);
    memory.insert(whole->image.pixels.data());
  }
}

TEST_CASE("no light, dark layers; wrong options are refused") {
  LayeredScene scene = two_lights();
  scene.lights.clear();
  for (const LayersBy by : kAllKinds) {
    const LayeredFlare flare = layers_of(bounds_of("adaptive"), scene, {.by = by, .ghosts = {{2, 5}}});
    CHECK(flare.image.pixels == Pixels(flare.image.pixels.size(), 0.0F));
  }
  const auto refused = [&](const LayerOptions& options) {
    const auto flare = render_layers(AdaptiveOptions{}, scene.lens, scene.lights, scene.settings, options);
    return !flare.has_value() && flare.error().code == ErrorCode::InvalidArgument;
  };
  CHECK(refused({.ghost_count = -1}));
  CHECK(refused({.min_percent = 101.0}));
  CHECK(refused({.by = LayersBy::Ghost, .ghosts = {{2, 99}}}));
}

TEST_CASE("names of layers are those that hosts allow, and differ") {
  CHECK(layer_name("Key light (left)") == "Key_light__left_");
  CHECK(layer_name("2nd") == "_2nd");
  CHECK(layer_name("") == "_");
  CHECK(layer_name("H\xc3\xa4user") == "H__user");
  CHECK(layer_name(Ghost{2, 5}) == "ghost_2_5");
  CHECK(layer_name(Ghost{2, 5, 1, 4}) == "ghost_2_5_1_4");
  CHECK(layer_name(Ghost{7, 12, 0, 0, {1, -2}}) == "ghost_7_12_1_m2");
  LayeredScene scene = two_lights();
  scene.lights.push_back(scene.lights.front());
  const LayeredFlare flare =
      layers_of(bounds_of("adaptive"), scene, {.by = LayersBy::Light, .light_names = {"a b", "a-b", "rest"}});
  CHECK(names_of(flare) == std::vector<std::string>{"a_b", "a_b_2", "rest_2"});
}

TEST_CASE("more lights than layers: the dimmest share one") {
  LayeredScene scene = two_lights(24, 16);
  scene.settings.glare.fraction = 0.0;
  scene.lights.assign(kMaxLightLayers + 2, scene.lights.front());
  scene.lights[3].value = scene.lights[7].value = {0.01, 0.01, 0.01};
  const LayeredFlare flare = layers_of(bounds_of("adaptive"), scene, {.by = LayersBy::Light});
  CHECK(flare.layers.size() == kMaxLightLayers + 1);
  CHECK(flare.layers.back().name == "rest");
  CHECK(sum(whole_image(flare.layers.back(), 24, 16)) ==
        test::approx(0.02 * sum(whole_image(flare.layers.front(), 24, 16))).epsilon(0.01));
  const std::vector<std::string> names = names_of(flare);
  CHECK(std::ranges::count(names, "light3") == 1);
  CHECK(std::ranges::count(names, "light4") == 0);
}
