// SPDX-License-Identifier: Apache-2.0
// The studio without its window: commands, files, copies of unsaved work.
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

#include "contrejour/image_io.h"
#include "studio/core/lights.h"
#include "studio/core/studio.h"
#include "studio/studio_scene.h"
#include "support/scratch_folder.h"

namespace contrejour::studio {
namespace {

using test::ScratchFolder;

Studio::Edit move_to(Vec2 at) {
  return [at](const Document& d) { return with_light_at(d, 0, at); };
}

TEST_CASE("a command makes a picture; one that is refused says why and changes nothing") {
  Studio studio("first", small_scene(), {});
  run_until_idle(studio);
  CHECK(studio.shown().picture.kind == PictureKind::Refined);
  CHECK(studio.shown().rgba.size() == 96 * 64);
  CHECK(studio.figures().size() == 105);
  REQUIRE(studio.section().section);

  const auto revision = studio.revision();
  CHECK_FALSE(studio.edit("set fnumber", "key", [](const Document& d) { return with_value(d, "fnumber", "0.5"); }));
  CHECK(studio.problem().find("f/") != std::string::npos);
  CHECK(studio.problem_key() == "key");
  CHECK(studio.revision() == revision);
  CHECK(studio.history().steps().size() == 1);

  CHECK(studio.edit("move light 1", "light/0/at", move_to({0.6, 0.6})));
  CHECK(studio.problem().empty());
  run_until_idle(studio);
  CHECK(studio.shown().picture.revision == studio.revision());
  CHECK(studio.figures_are_current());
}

TEST_CASE("undo goes back over opened lenses, and the selection follows") {
  Studio studio("first", small_scene(), {});
  run_until_idle(studio);
  studio.select_ghost(studio.figures()[0].ghost);
  studio.selection.surface = 16;
  CHECK(studio.open_lens("cooke-triplet"));
  CHECK(studio.lens().surfaces.size() < 10);
  CHECK(studio.selection.surface == 0);
  CHECK_FALSE(studio.selection.ghost);
  CHECK(studio.history().steps().back().name == "open lens " + studio.document().lens->name);
  CHECK_FALSE(studio.open_lens("no-such-lens"));
  CHECK(studio.document().lens_name == "cooke-triplet");
  studio.undo();
  CHECK(studio.document().lens_name == "distagon-25");
  CHECK(studio.document().texts == small_scene().texts);
  CHECK(studio.message().starts_with("undone: open lens "));
  CHECK(studio.problem().empty());
  studio.redo();
  CHECK(studio.message().starts_with("redone: open lens "));
  CHECK(studio.document().lens_name == "cooke-triplet");
}

TEST_CASE("a saved session opens again with its view, and keeps what others wrote into it") {
  const ScratchFolder folder;
  const std::string file = (folder / "a.session.json").string();
  Document scene = small_scene();
  scene.others.push_back({"written-by-another", "{\"x\":1}"});
  Studio studio("first", scene, {});
  studio.edit("move", "", move_to({-0.25, 0.5}));
  studio.view.zoom = 2.5;
  studio.view.interface_scale = 1.5;
  studio.view.transform = ViewTransform::FalseColour;
  CHECK_FALSE(studio.is_saved());
  REQUIRE(studio.save_session(file));
  CHECK(studio.is_saved());

  Studio other("first", small_scene(), {});
  REQUIRE(other.open_session(file));
  CHECK(other.is_saved());
  CHECK(other.file() == file);
  CHECK(lights_of(other.document())[0].at == Vec2{-0.25, 0.5});
  CHECK(other.view.zoom == 2.5);
  CHECK(other.view.interface_scale == 1.5);
  CHECK(other.view.transform == ViewTransform::FalseColour);
  CHECK(other.document().others[0] == SessionMember{"written-by-another", "{\"x\":1}"});
  CHECK_FALSE(other.open_session((folder / "missing.session.json").string()));
  CHECK_FALSE(other.save_session("/no/such/folder/a.session.json"));
}

TEST_CASE("work of a program that has died is offered again, that of a running one is not") {
  const ScratchFolder folder;
  const auto states = folder / "state";
  Autosave mine(states);
  REQUIRE(mine.save(small_scene(), "my file.session.json", true));
  CHECK(mine.lost_work().empty());  // this program runs

  std::filesystem::path copy;
  for (const auto& entry : std::filesystem::directory_iterator(states)) copy = entry.path();
  std::filesystem::rename(copy, states / "autosave-999999999.session.json");
  std::ofstream(states / "autosave-999999998.session.json") << "{damaged";
  const auto lost = mine.lost_work();
  REQUIRE(lost.size() == 1);
  CHECK(lost[0].of_file == "my file.session.json");
  CHECK(lost[0].lens == "distagon-25");

  Studio studio("first", first_document(), {{}, states});
  REQUIRE(studio.recover(lost[0]));
  CHECK(studio.document().text("size") == "96x64");
  CHECK(studio.file() == "my file.session.json");
  CHECK_FALSE(studio.is_saved());
  CHECK(studio.document().others.empty());
  CHECK(studio.lost_work().empty());
  CHECK(studio.message() == "recovered the unsaved work of my file.session.json");
  studio.forget_autosave();
  CHECK(std::distance(std::filesystem::directory_iterator(states), std::filesystem::directory_iterator()) == 1);
}

TEST_CASE("an export is the picture that is shown, and a wrong name is told apart") {
  const ScratchFolder folder;
  Studio studio("first", small_scene(), {});
  run_until_idle(studio);
  const std::string file = (folder / "flare.exr").string();
  studio.export_as(ExportKind::Picture, file);
  run_until_idle(studio);
  CHECK(studio.message() == "wrote " + file);
  const auto picture = read_picture(std::filesystem::path(file));
  REQUIRE(picture);
  CHECK(picture->rgb.pixels == studio.shown().picture.image->pixels);
  CHECK_FALSE(studio.export_as(ExportKind::Picture, (folder / "flare.doc").string()));
  CHECK(studio.problem().find(".exr or .png") != std::string::npos);
  CHECK_FALSE(studio.export_as(ExportKind::Picture, (folder / "no-such-folder" / "flare.exr").string()));
  CHECK(studio.problem().find("no-such-folder") != std::string::npos);
  CHECK(would_replace(ExportKind::Picture, file, 1, 1));
  CHECK_FALSE(would_replace(ExportKind::Picture, (folder / "other.exr").string(), 1, 1));
  std::filesystem::copy_file(file, folder / "flare.0003.exr");
  CHECK(would_replace(ExportKind::Frames, (folder / "flare.####.exr").string(), 1, 3));
  CHECK_FALSE(would_replace(ExportKind::Frames, (folder / "flare.####.exr").string(), 4, 9));
}

TEST_CASE("a plate gives the picture its size") {
  const ScratchFolder folder;
  Image plate(80, 48);
  plate.pixels.assign(plate.pixels.size(), 0.25F);
  REQUIRE(write_exr(folder / "plate.exr", plate));
  Studio studio("first", small_scene(), {});
  REQUIRE(studio.open_plate((folder / "plate.exr").string()));
  studio.edit("exposure", "", [](const Document& d) { return with_value(d, "exposure", "0"); });
  run_until_idle(studio);
  CHECK(studio.document().text("size") == "80x48");
  REQUIRE(studio.shown().rgba.size() == 80 * 48);
  CHECK((studio.shown().rgba[80 * 48 - 1] & 0xFFU) >= 137);  // 0.25 in sRGB, and the flare
  CHECK_FALSE(studio.open_plate((folder / "missing.exr").string()));
}

}  // namespace
}  // namespace contrejour::studio
