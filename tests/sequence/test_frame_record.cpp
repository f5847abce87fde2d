// SPDX-License-Identifier: Apache-2.0
// A frame is done only while its settings, the files it was made from and its own files are what they were.
#include "contrejour/expert/frame_record.h"

#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/scratch_folder.h"

using namespace contrejour;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& file, const char* text) { std::ofstream(file) << text; }

struct FrameOnDisk {
  test::ScratchFolder folder;
  std::vector<fs::path> inputs{folder / "plate.0001.exr"};
  std::vector<fs::path> outputs{folder / "out.0001.exr", folder / "out.0001.png"};

  FrameOnDisk() {
    write(inputs[0], "plate");
    for (const fs::path& output : outputs) write(output, "picture");
  }
  [[nodiscard]] FrameFiles files(const std::string& settings = "fnumber = 8") const {
    return {settings, inputs, outputs};
  }
};

}  // namespace

TEST_CASE("a frame without a record is not done; with one it is") {
  const FrameOnDisk frame;
  CHECK_FALSE(is_frame_done(frame.files()));
  REQUIRE(write_frame_record(frame.files()).has_value());
  CHECK(is_frame_done(frame.files()));
  CHECK(fs::exists(frame.folder / ".contrejour/out.0001.exr.txt"));
}

TEST_CASE("other settings, other inputs and other outputs undo it") {
  const FrameOnDisk frame;
  REQUIRE(write_frame_record(frame.files()).has_value());
  CHECK_FALSE(is_frame_done(frame.files("fnumber = 11")));
  SUBCASE("the input has another size") { write(frame.inputs[0], "another plate"); }
  SUBCASE("the input has another time") {
    fs::last_write_time(frame.inputs[0], fs::last_write_time(frame.inputs[0]) + std::chrono::seconds(1));
  }
  SUBCASE("an output was cut off") { fs::resize_file(frame.outputs[1], 3); }
  SUBCASE("an output is gone") { fs::remove(frame.outputs[0]); }
  SUBCASE("the input is gone") { fs::remove(frame.inputs[0]); }
  CHECK_FALSE(is_frame_done(frame.files()));
}

TEST_CASE("no record is written of files that are not there, or where it cannot be") {
  const FrameOnDisk frame;
  fs::remove(frame.outputs[0]);
  const auto written = write_frame_record(frame.files());
  REQUIRE_FALSE(written.has_value());
  CHECK(written.error().code == ErrorCode::Io);

  const FrameOnDisk other;
  write(other.folder / ".contrejour", "a file where the folder should be");
  CHECK_FALSE(write_frame_record(other.files()).has_value());
}
