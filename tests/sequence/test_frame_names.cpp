// SPDX-License-Identifier: Apache-2.0
// Ranges of frames as Nuke writes them, and names of files with a place for the number.
#include <fstream>

#include <doctest/doctest.h>

#include "contrejour/expert/frame_pattern.h"
#include "contrejour/expert/frame_range.h"
#include "support/scratch_folder.h"

using namespace contrejour;
using Frames = std::vector<int>;

TEST_CASE("ranges: numbers, steps, negative ones, overlaps, spaces") {
  CHECK(parse_frame_range("1001-1004").value() == Frames{1001, 1002, 1003, 1004});
  CHECK(parse_frame_range("1-10x3,20").value() == Frames{1, 4, 7, 10, 20});
  CHECK(parse_frame_range("1-9x5").value() == Frames{1, 6});
  CHECK(parse_frame_range("-3--1 0").value() == Frames{-3, -2, -1, 0});
  CHECK(parse_frame_range("5, 3-6, 3").value() == Frames{3, 4, 5, 6});
  CHECK(parse_frame_range("7").value() == Frames{7});
  CHECK(parse_frame_range("-2147483648--2147483647").value() == Frames{-2147483647 - 1, -2147483647});
}

TEST_CASE("what is no range is refused, and what is too long") {
  for (const char* text :
       {"", " ,", "a", "1-", "4-1", "1-5x0", "1-5x-1", "1-5y2", "1..5", "99999999999", "1-2-3", "x2"}) {
    CAPTURE(text);
    const auto frames = parse_frame_range(text);
    REQUIRE_FALSE(frames.has_value());
    CHECK(frames.error().code == ErrorCode::InvalidArgument);
  }
  CHECK(parse_frame_range("1-1000000").value().size() == kMaxFrames);
  CHECK_FALSE(parse_frame_range("1-1000001").has_value());
  CHECK_FALSE(parse_frame_range("-2147483648-2147483647").has_value());
  CHECK_FALSE(parse_frame_range("1-600000,1-600000").has_value());
}

TEST_CASE("the text of a range reads back as the range") {
  CHECK(frame_range_text({1001, 1002, 1003}) == "1001-1003");
  CHECK(frame_range_text({1, 4, 7, 10, 20}) == "1-10x3,20");
  CHECK(frame_range_text({5, 9}) == "5,9");
  CHECK(frame_range_text({5, 6}) == "5-6");
  CHECK(frame_range_text({}).empty());
  for (const Frames& frames : {Frames{-5, -4, 0, 3, 6, 9, 10}, Frames{1, 2, 4, 6, 8, 9, 10, 11}, Frames{3}}) {
    CAPTURE(frame_range_text(frames));
    CHECK(parse_frame_range(frame_range_text(frames)).value() == frames);
  }
}

TEST_CASE("####, @@@@ and %04d are the same point") {
  for (const char* name : {"a/plate.####.exr", "a/plate.@@@@.exr", "a/plate.%04d.exr"}) {
    CAPTURE(name);
    REQUIRE(is_frame_pattern(name));
    const auto pattern = parse_frame_pattern(name);
    REQUIRE(pattern.has_value());
    CHECK(file_of_frame(*pattern, 7) == "a/plate.0007.exr");
    CHECK(file_of_frame(*pattern, 123456) == "a/plate.123456.exr");
    CHECK(file_of_frame(*pattern, -7) == "a/plate.-007.exr");
  }
  CHECK(file_of_frame(parse_frame_pattern("f%d.png").value(), 12) == "f12.png");
  CHECK(file_of_frame(parse_frame_pattern("f#.png").value(), 12) == "f12.png");
}

TEST_CASE("other names have no place for a number, or too many") {
  for (const char* name : {"plate.exr", "me@home.exr", "100%.exr", "50%o.exr", "####/plate.exr", ""})
    CHECK_FALSE(is_frame_pattern(name));
  CHECK_FALSE(parse_frame_pattern("plate.exr").has_value());
  CHECK_FALSE(parse_frame_pattern("a.##.##.exr").has_value());
  CHECK_FALSE(parse_frame_pattern("a.##.%d.exr").has_value());
}

TEST_CASE("the frames on disk are those with exactly such names") {
  const test::ScratchFolder folder;
  for (const char* name : {"p.0003.exr", "p.0001.exr", "p.12345.exr", "p.-002.exr", "p.3.exr", "p.00004.exr",
                           "p.0005.png", "q.0006.exr", "p.x001.exr", "p..exr", "p.0007.exr.bak"})
    std::ofstream(folder / name) << "x";
  const auto pattern = parse_frame_pattern((folder / "p.####.exr").string());
  REQUIRE(pattern.has_value());
  CHECK(frames_on_disk(*pattern).value() == Frames{-2, 1, 3, 12345});
  const auto absent = frames_on_disk(parse_frame_pattern((folder / "none" / "p.#.exr").string()).value());
  REQUIRE_FALSE(absent.has_value());
  CHECK(absent.error().code == ErrorCode::Io);
}
