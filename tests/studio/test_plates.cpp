// SPDX-License-Identifier: Apache-2.0
// Plates in documents and sessions: the picture is that of `apply`, bit for bit, and their lights become the
// document's.
#include <filesystem>

#include <doctest/doctest.h>

#include "contrejour/apply.h"
#include "contrejour/image_io.h"
#include "studio/core/command_line.h"
#include "studio/core/lights.h"
#include "studio/core/plate_picture.h"
#include "studio/core/studio.h"
#include "studio/studio_scene.h"
#include "support/approx.h"
#include "support/scratch_folder.h"

namespace contrejour::studio {
namespace {

using test::ScratchFolder;

constexpr int kWidth = 120, kHeight = 72;

// Grey, with two lamps.
Image lamps() {
  Image plate(kWidth, kHeight);
  plate.pixels.assign(plate.pixels.size(), 0.1F);
  const auto lamp = [&](int x, int y, float r, float g, float b) {
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx) {
        float* p = &plate.pixels[plate.index(x + dx, y + dy)];
        p[0] = r;
        p[1] = g;
        p[2] = b;
      }
  };
  lamp(30, 20, 900, 800, 700);
  lamp(90, 50, 300, 400, 500);
  return plate;
}

std::string plate_in(const ScratchFolder& folder) {
  const std::string file = (folder / "plate.exr").string();
  REQUIRE(write_exr(file, lamps()));
  return file;
}

// The picture that the command line's `apply` makes of the plate with the document's values.
Image applied(const std::string& plate, const Document& document, const LensState& lens) {
  auto picture = read_picture(std::filesystem::path(plate));
  REQUIRE(apply_flare(*picture, lens, document.values()));
  return picture->rgb;
}

TEST_CASE("a plate is a step of the history, and the picture is that of apply, bit for bit") {
  const ScratchFolder folder;
  const std::string plate = plate_in(folder);
  Studio studio("first", small_scene(), {});
  run_until_idle(studio);
  REQUIRE(studio.open_plate(plate));
  run_until_idle(studio);
  CHECK(studio.document().plate.file == plate);
  CHECK(studio.document().text("detect") == "off");
  CHECK(studio.history().steps().back().name == "open plate plate.exr");
  REQUIRE(studio.shown().picture.image);
  CHECK(studio.shown().picture.has_plate);
  CHECK(studio.shown().picture.image->pixels == applied(plate, studio.document(), studio.lens()).pixels);

  studio.edit("detect", "", [](const Document& d) { return with_value(d, "detect", "on"); });
  run_until_idle(studio);
  const Image with_lamps = applied(plate, studio.document(), studio.lens());
  CHECK(studio.shown().picture.image->pixels == with_lamps.pixels);

  studio.undo();
  studio.undo();
  run_until_idle(studio);
  CHECK_FALSE(studio.shown().picture.has_plate);
  studio.redo();
  run_until_idle(studio);
  CHECK(studio.shown().picture.has_plate);
}

TEST_CASE("the lights of a plate become lights that can be moved, in one step") {
  const ScratchFolder folder;
  Studio studio("first", small_scene(), {});
  CHECK_FALSE(studio.detect_lights());
  REQUIRE(studio.open_plate(plate_in(folder)));
  run_until_idle(studio);
  const std::size_t steps = studio.history().steps().size();
  REQUIRE(studio.detect_lights());
  run_until_idle(studio);
  CHECK(studio.history().steps().size() == steps + 1);
  CHECK(studio.history().steps().back().name == "detect 2 lights");
  const auto lights = lights_of(studio.document());
  REQUIRE(lights.size() == 2);
  CHECK(lights[0].at.x == test::approx(31.0 / kWidth));
  CHECK(lights[0].at.y == test::approx(21.0 / kHeight));
  CHECK(lights[0].value == "3600,3200,2800");  // the sum over its four pixels
  CHECK(lights[1].value == "1200,1600,2000");
}

TEST_CASE("a session holds its plate by a name from its folder, which can be moved") {
  const ScratchFolder folder;
  const auto there = folder / "there", elsewhere = folder / "elsewhere";
  std::filesystem::create_directory(there);
  REQUIRE(write_exr(there / "plate.exr", lamps()));
  Studio studio("first", small_scene(), {});
  REQUIRE(studio.open_plate((there / "plate.exr").string()));
  run_until_idle(studio);
  REQUIRE(studio.save_session((there / "a.session.json").string()));
  const auto session = read_session(there / "a.session.json");
  REQUIRE(session);
  CHECK(session->plate.file == "plate.exr");
  std::filesystem::rename(there, elsewhere);
  Studio other("first", small_scene(), {});
  REQUIRE(other.open_session((elsewhere / "a.session.json").string()));
  run_until_idle(other);
  CHECK(other.document().plate.file == (elsewhere / "plate.exr").string());
  CHECK(other.shown().picture.image->pixels == studio.shown().picture.image->pixels);
  CHECK(command_of_session(other.document(), "a.session.json", {}) ==
        "contrejour apply --session a.session.json -o flare.exr");
  CHECK(command_of_values(other.document(), {}).find("--no-detect") != std::string::npos);
  CHECK(command_of_values(other.document(), {}).find("--size") == std::string::npos);

  std::filesystem::remove(elsewhere / "plate.exr");
  Studio last("first", small_scene(), {});
  REQUIRE(last.open_session((elsewhere / "a.session.json").string()));
  run_until_idle(last);
  CHECK(last.problem().find("plate.exr") != std::string::npos);
  CHECK_FALSE(last.shown().picture.has_plate);
}

TEST_CASE("a draft on a plate has the plate's means and about the flare's light") {
  const ScratchFolder folder;
  const auto plate = plate_of({plate_in(folder), "", "", "", ""});
  REQUIRE(plate);
  CHECK(reduced_image((*plate)->picture.rgb, 60, 36).at(0, 0) == test::approx(0.1));
  const Document d = *with_value(*with_value(small_scene(), "size", "120x72"), "detect", "off");
  PictureOrder order{
      1, d.values(), std::make_shared<const LensState>(*params::lens_of(*d.lens, d.values())), {}, *plate};
  PictureJob job(picture_work(), {});
  job.post(order);
  std::vector<PictureAnswer> answers;
  while (!job.is_idle())
    if (auto answer = job.take()) answers.push_back(std::move(*answer));
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[0].image);
  const auto flare_of = [&](const Image& picture, const Image& without) {
    double sum = 0;
    for (std::size_t k = 0; k < picture.pixels.size(); ++k)
      sum += static_cast<double>(picture.pixels[k] - without.pixels[k]);
    return sum / static_cast<double>(picture.pixels.size());
  };
  const Image& draft = *answers[0].image;
  const double refined = flare_of(*answers[1].image, (*plate)->picture.rgb);
  CHECK(refined > 0);
  CHECK(flare_of(draft, reduced_image((*plate)->picture.rgb, draft.width, draft.height)) ==
        test::approx(refined).epsilon(0.15));
}

TEST_CASE("a plate that is exported is the one shown, and so is the flare alone in layers") {
  const ScratchFolder folder;
  Studio studio("first", small_scene(), {});
  REQUIRE(studio.open_plate(plate_in(folder)));
  run_until_idle(studio);
  const std::string file = (folder / "out.exr").string(), layers = (folder / "layers.exr").string();
  studio.export_as(ExportKind::Picture, file);
  run_until_idle(studio);
  const auto picture = read_picture(std::filesystem::path(file));
  REQUIRE(picture);
  CHECK(picture->rgb.pixels == studio.shown().picture.image->pixels);
  studio.export_as(ExportKind::Layers, layers, LayersBy::Part);
  run_until_idle(studio);
  CHECK(studio.message() == "wrote " + layers);
  const auto flare = read_picture(std::filesystem::path(layers));
  REQUIRE(flare);
  CHECK(flare->channels.size() >= 6);
}

}  // namespace
}  // namespace contrejour::studio
