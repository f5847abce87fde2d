// SPDX-License-Identifier: Apache-2.0
// Plates that are sequences: each frame's picture is that of `apply` on the frame's file, and missing ones are named.
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

#include "contrejour/apply.h"
#include "contrejour/image_io.h"
#include "studio/core/command_line.h"
#include "studio/core/plate_frames.h"
#include "studio/core/studio.h"
#include "studio/studio_scene.h"
#include "support/scratch_folder.h"

namespace contrejour::studio {
namespace {

// Grey, with a lamp whose place is the frame's.
Image lamp_of_frame(int frame, int width = 60) {
  Image plate(width, 36);
  plate.pixels.assign(plate.pixels.size(), 0.1F);
  for (std::size_t c = 0; c < 3; ++c) plate.pixels[plate.index(10 + 5 * frame, 12) + c] = 900.0F;
  return plate;
}

std::string sequence_in(const test::ScratchFolder& folder) {
  for (const int frame : {1, 2, 4})
    REQUIRE(write_exr(folder / ("plate.000" + std::to_string(frame) + ".exr"), lamp_of_frame(frame)));
  return (folder / "plate.####.exr").string();
}

Image flare_applied(const std::filesystem::path& plate, const Studio& studio) {
  auto picture = read_picture(plate);
  REQUIRE(apply_flare(*picture, studio.lens(), studio.document().values()));
  return picture->rgb;
}

TEST_CASE("names of a sequence and its frames") {
  const test::ScratchFolder folder;
  const std::string pattern = sequence_in(folder);
  CHECK(is_plate_sequence(pattern));
  CHECK_FALSE(is_plate_sequence((folder / "plate.0001.exr").string()));
  CHECK(plate_at({pattern, "beauty", "", "", ""}, 4) ==
        SessionPlate{(folder / "plate.0004.exr").string(), "beauty", "", "", ""});
  CHECK(*frames_of_plate({pattern, "", "", "", ""}) == std::vector{1, 2, 4});
  CHECK(missing_frames({1, 2, 4}, 1, 6) == std::vector{3, 5, 6});
  CHECK(sequence_of_file(folder / "plate.0002.exr") == pattern);
  std::ofstream(folder / "shot7.exr") << "alone";
  CHECK_FALSE(sequence_of_file(folder / "shot7.exr"));
  CHECK_FALSE(sequence_of_file(folder / "street.exr"));
  // A file that has exactly this name is a still, as for the command line.
  REQUIRE(write_exr(folder / "still#.exr", lamp_of_frame(1)));
  CHECK_FALSE(is_plate_sequence((folder / "still#.exr").string()));
}

TEST_CASE("a sequence is scrubbed by its frames, exported as apply makes it, and names what is missing") {
  const test::ScratchFolder folder;
  Studio studio("first", small_scene(), {});
  REQUIRE(studio.open_plate(sequence_in(folder)));
  run_until_idle(studio);
  CHECK(studio.view.first_frame == 1);
  CHECK(studio.view.last_frame == 4);
  CHECK(studio.plate_frames() == std::vector{1, 2, 4});
  CHECK(studio.message().find("frames 1-2,4") != std::string::npos);
  studio.edit("detect", "", [](const Document& d) { return with_value(d, "detect", "on"); });
  const std::size_t steps = studio.history().steps().size();
  for (const int frame : {2, 4, 1}) {
    studio.go_to_frame(frame);
    run_until_idle(studio);
    REQUIRE(studio.shown().picture.image);
    CHECK(studio.shown().picture.has_plate);
    const auto file = folder / ("plate.000" + std::to_string(frame) + ".exr");
    CHECK(studio.shown().picture.image->pixels == flare_applied(file, studio).pixels);
  }
  CHECK(studio.history().steps().size() == steps);
  studio.go_to_frame(3);
  run_until_idle(studio);
  CHECK(studio.problem().find("frame 3 of the plate is missing") != std::string::npos);
  CHECK_FALSE(studio.shown().picture.has_plate);
  studio.go_to_frame(4);
  run_until_idle(studio);
  CHECK(studio.problem().empty());

  REQUIRE(studio.export_as(ExportKind::Frames, (folder / "out.####.exr").string()));
  run_until_idle(studio);
  CHECK(studio.message() == "wrote 3 of 4 frames; the plate has no frames 3");
  CHECK_FALSE(std::filesystem::exists(folder / "out.0003.exr"));
  for (const char* frame : {"0001", "0002", "0004"}) {
    const auto out = read_picture(folder / (std::string("out.") + frame + ".exr"));
    REQUIRE(out);
    CHECK(out->rgb.pixels == flare_applied(folder / (std::string("plate.") + frame + ".exr"), studio).pixels);
  }
  REQUIRE(studio.export_as(ExportKind::Picture, (folder / "still.exr").string()));
  run_until_idle(studio);
  CHECK(read_picture(folder / "still.exr")->rgb.pixels == flare_applied(folder / "plate.0004.exr", studio).pixels);
}

TEST_CASE("a frame whose plate has another size ends the export") {
  const test::ScratchFolder folder;
  REQUIRE(write_exr(folder / "p.1.exr", lamp_of_frame(1)));
  REQUIRE(write_exr(folder / "p.2.exr", lamp_of_frame(1, 64)));
  Studio studio("first", small_scene(), {});
  REQUIRE(studio.open_plate((folder / "p.#.exr").string()));
  run_until_idle(studio);
  REQUIRE(studio.export_as(ExportKind::Frames, (folder / "out.#.exr").string()));
  run_until_idle(studio);
  CHECK(studio.problem().find("frame 2 of the plate has 64 x 36") != std::string::npos);
}

TEST_CASE("the commands of a sequence name the frame or all of them") {
  Document d = small_scene();
  d.plate.file = "/shot/plate.####.exr";
  const CommandChoice still{.output = "o.exr", .frame = 12},
      frames{.kind = ExportKind::Frames, .output = "o.#.exr", .first = 3, .last = 9, .skips_missing = true};
  CHECK(command_of_session(d, "a.session.json", still) ==
        "contrejour apply --session a.session.json /shot/plate.0012.exr -o o.exr");
  CHECK(command_of_session(d, "a.session.json", frames) ==
        "contrejour apply --session a.session.json --frames 3-9 --missing skip -o 'o.#.exr'");
  CHECK(command_of_values(d, still).find(" /shot/plate.0012.exr ") != std::string::npos);
  CHECK(command_of_values(d, frames).find(" '/shot/plate.####.exr' ") != std::string::npos);
  d.plate = {};
  CHECK(command_of_values(d, frames).empty());
}

}  // namespace
}  // namespace contrejour::studio
