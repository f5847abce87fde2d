// SPDX-License-Identifier: Apache-2.0
// The files of a photograph with its flare: layers, copies, previews, pictures of the detected lights.
#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/apply.h"
#include "contrejour/expert/apply_files.h"
#include "image/test_pictures.h"
#include "support/approx.h"

using namespace contrejour;
using params::Values;
using test::bytes_of;
using test::must_read;
using test::must_write;
using test::ScratchFolder;

namespace {

constexpr int kFileWidth = 48, kFileHeight = 32;

Image dark_with(std::vector<Vec2> lights, float level = 5e4F, float dark = 0.25F) {
  Image rgb(kFileWidth, kFileHeight);
  std::fill(rgb.pixels.begin(), rgb.pixels.end(), dark);
  for (const Vec2 at : lights)
    for (int c = 0; c < 3; ++c) rgb.at(static_cast<int>(at.x), static_cast<int>(at.y), c) = level;
  return rgb;
}

LensState heliar_for_files() {
  const auto state = configure_lens(find_lens("heliar").value(), {.f_number = 16.0});
  REQUIRE(state.has_value());
  return *state;
}

FlarePlan must_plan(const Picture& picture, const Values& values = {}) {
  auto plan = plan_flare(picture, heliar_for_files(), values);
  REQUIRE(plan.has_value());
  return std::move(*plan);
}

// Calls write(file) and returns the file's name.
template <class Write>
std::filesystem::path written(const ScratchFolder& folder, const std::string& name, const Write& write) {
  auto file = OutputFile::create(folder / name);
  REQUIRE(file.has_value());
  REQUIRE(write(*file).has_value());
  REQUIRE(file->commit().has_value());
  return folder / name;
}

ReadOptions of_layer(const std::string& layer) {
  ReadOptions options;
  options.layer = layer;
  return options;
}

// Two layers in one file: "key" and "fill".
Picture picture_of_layers(const Image& key, const Image& fill) {
  Picture picture = picture_of(key, SampleType::Half);
  for (PictureChannel& channel : picture.channels) channel.name.insert(0, "key.");
  for (int c = 0; c < 3; ++c) {
    PictureChannel channel{std::string("fill.") + "RGB"[c], SampleType::Float, 1, 1, false, {}};
    std::vector<float> samples;
    for (std::size_t k = static_cast<std::size_t>(c); k < fill.pixels.size(); k += 3) samples.push_back(fill.pixels[k]);
    const auto bytes = std::as_bytes(std::span(samples));
    channel.samples.assign(bytes.begin(), bytes.end());
    picture.channels.push_back(std::move(channel));
  }
  return picture;
}

}  // namespace

TEST_CASE("a layer takes the flare of its own lights, and every other layer keeps its bits") {
  const ScratchFolder folder;
  const Image key = dark_with({{30, 8}}), fill = dark_with({{10, 20}, {40, 25}});
  must_write(folder / "in.exr", picture_of_layers(key, fill));
  const std::pair<std::string, std::size_t> layers[] = {{"key", 1}, {"fill", 2}};
  for (const auto& [layer, lights] : layers) {
    CAPTURE(layer);
    Picture picture = must_read(folder / "in.exr", of_layer(layer));
    const auto applied = apply_flare(picture, heliar_for_files(), {});
    REQUIRE(applied.has_value());
    CHECK(applied->plan.lights.size() == lights);
    const auto out = written(folder, "out.exr", [&](OutputFile& f) { return write_photograph(f, picture, {}); });
    for (const auto& [name, ignored] : layers) {
      const Picture before = must_read(folder / "in.exr", of_layer(name));
      const Picture after = must_read(out, of_layer(name));
      CHECK((before.rgb.pixels == after.rgb.pixels) == (name != layer));
    }
  }
}

TEST_CASE("a photograph without flare is its file, byte for byte; as a PNG it is exposed") {
  const ScratchFolder folder;
  must_write(folder / "in.exr", picture_of(dark_with({})));
  const Picture picture = must_read(folder / "in.exr");
  const auto copy = [&](const std::string& name, const std::filesystem::path& input, const Values& values) {
    return written(folder, name, [&](OutputFile& f) { return copy_photograph(f, input, picture, values); });
  };
  CHECK(bytes_of(copy("same.exr", folder / "in.exr", {})) == bytes_of(folder / "in.exr"));
  CHECK(must_read(copy("anew.exr", folder / "gone.exr", {})).rgb.pixels == picture.rgb.pixels);
  CHECK(must_read(copy("plain.png", folder / "in.exr", {})).rgb.pixels[0] == test::approx(0.25).epsilon(0.001));
  Values brighter;
  REQUIRE(brighter.set("exposure", "1").has_value());
  CHECK(must_read(copy("bright.png", folder / "in.exr", brighter)).rgb.pixels[0] == test::approx(0.5).epsilon(0.001));
  CHECK(bytes_of(copy("bright.exr", folder / "in.exr", brighter)) == bytes_of(folder / "in.exr"));
  const auto exposed =
      written(folder, "out.png", [&](OutputFile& f) { return write_photograph(f, picture, brighter); });
  CHECK(bytes_of(exposed) == bytes_of(folder / "bright.png"));
}

TEST_CASE("a flare by itself lies where the photograph does") {
  const ScratchFolder folder;
  Picture picture = picture_of(dark_with({{30, 8}}));
  picture.data_window = {-3, 7, kFileWidth, kFileHeight};
  picture.display_window = {0, 0, 60, 50};
  set_colour_space(picture, ColourSpace::AcesCg);
  set_pixel_aspect(picture, 2.0);
  const auto applied = apply_flare(picture, heliar_for_files(), {});
  REQUIRE(applied.has_value());
  const auto file = written(folder, "flare.exr", [&](OutputFile& f) {
    return write_aligned(f, applied->flare.image, picture, applied->plan);
  });
  const Picture flare = must_read(file);
  CHECK(flare.rgb.pixels == applied->flare.image.pixels);
  CHECK(flare.data_window == picture.data_window);
  CHECK(flare.display_window == picture.display_window);
  CHECK(colour_space_of(flare) == ColourSpace::AcesCg);
  CHECK(pixel_aspect_of(flare) == 2.0);
}

TEST_CASE("pictures of what counts as lights: an EXR of their pixels, a PNG to look at") {
  const ScratchFolder folder;
  const Picture picture = picture_of(dark_with({{30, 8}}));
  const FlarePlan plan = must_plan(picture);
  const auto draw = [&](const std::string& name) {
    return must_read(written(folder, name, [&](OutputFile& f) { return write_detected(f, picture, plan); })).rgb;
  };
  const Image pixels = draw("lights.exr");
  const auto lit = std::count_if(pixels.pixels.begin(), pixels.pixels.end(), [](float v) { return v > 0.0F; });
  CHECK(lit == 3);
  CHECK(pixels.at(30, 8, 1) == test::approx(5e4));
  const Image map = draw("lights.png");
  CHECK(map.at(0, 0, 0) == test::approx(0.3 * 0.25).epsilon(0.02));
  CHECK(map.at(30, 8, 0) > 5.0F * map.at(30, 8, 2));
}
