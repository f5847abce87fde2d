// SPDX-License-Identifier: Apache-2.0
// Files as other programs write them, with positions that were calculated by hand from each program's conventions.
#include "contrejour/expert/track_files.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

constexpr TrackFileSettings kHd{1920, 1080, 0};

std::vector<PointTrack> must_read(const std::string& text, TrackFormat format, TrackFileSettings settings = kHd) {
  const auto found = track_format(text, "tracks.txt");
  CHECK((found && *found == format));
  const auto tracks = read_tracks(text, "tracks.txt", format, settings);
  REQUIRE_MESSAGE(tracks.has_value(), (tracks ? "" : tracks.error().to_string()));
  return *tracks;
}

std::string error_of(const std::string& text, TrackFormat format) {
  const auto tracks = read_tracks(text, "tracks.txt", format, kHd);
  REQUIRE_FALSE(tracks.has_value());
  CHECK(tracks.error().code == ErrorCode::Parse);
  return tracks.error().to_string();
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Pixels from the top left corner, as the light of a file has them after it was written and read.
Vec2 pixel_at(const Animation& animation, std::size_t light, double frame) {
  const auto again = read_animation(write_animation(animation), "lights.toml");
  REQUIRE(again.has_value());
  const auto uv = params::parse_reals(text_at(again->lights.at(light).position, frame), 2).value();
  return {uv[0] * kHd.width, uv[1] * kHd.height};
}

void check_pixel(Vec2 found, Vec2 expected) {
  CHECK(std::abs(found.x - expected.x) < 0.01);
  CHECK(std::abs(found.y - expected.y) < 0.01);
}

bool is_on(const Animation& animation, std::size_t light, double frame) {
  const auto& on = animation.lights.at(light).on;
  return !on || text_at(*on, frame) == "on";
}

}  // namespace

// The middle of the top left pixel is 0.5, 0.5 from the top left corner in all of them.
TEST_CASE("Nuke: the origin is the bottom left corner; frames between keys are interpolated") {
  const auto tracks =
      must_read("# Tracking Data\n1001,0.5,1079.5\n\n; other\n/ comments\n1011 480.5:810.25\n1021\t1920 0\n",
                TrackFormat::NukeTracker);
  REQUIRE(tracks.size() == 1);
  const auto shot = animation_of_points(tracks, "5000").value();
  check_pixel(pixel_at(shot, 0, 1001), {0.5, 0.5});
  check_pixel(pixel_at(shot, 0, 1006), {240.5, 135.125});
  check_pixel(pixel_at(shot, 0, 1011), {480.5, 269.75});
  check_pixel(pixel_at(shot, 0, 1021), {1920, 1080});
  CHECK(is_on(shot, 0, 900));
  CHECK(text_at(*shot.lights[0].value, 1001) == "5000");
}

TEST_CASE("Nuke: several tracks in columns, and a CameraTracker's tracks with holes") {
  const auto columns = must_read("1 10 20 30 40\n2 11 21 31 41\n", TrackFormat::NukeTracker, {100, 100, 1000});
  REQUIRE(columns.size() == 2);
  CHECK(columns[1].name == "track 2");
  CHECK(columns[1].keys[0].frame == 1001);
  CHECK(columns[1].keys[1].uv.x == test::approx(0.31));
  CHECK(columns[1].keys[1].uv.y == test::approx(0.59));

  const auto tracks = must_read(
      "TrackName autotrack0\n   Frame             X             Y   Correlation\n    12.00       100.000       980.000 "
      "        1.000\n"
      "    13.00       101.000       979.000         0.9\n    16.00       104.000       976.000         1.000\n\n"
      "TrackName autotrack0\n   Frame             X             Y   Correlation\n    12.00       1.000       1.000     "
      "    1.000\n",
      TrackFormat::NukeTracker);
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[1].name == "autotrack0 2");
  const auto shot = animation_of_points(tracks, "").value();
  check_pixel(pixel_at(shot, 0, 13), {101, 101});
  CHECK_FALSE(shot.lights[0].value.has_value());
  for (const int frame : {12, 13, 16}) CHECK(is_on(shot, 0, frame));
  for (const int frame : {11, 14, 15, 17}) CHECK_FALSE(is_on(shot, 0, frame));
}

TEST_CASE("3DEqualizer: the origin is the bottom left corner; a frame without a line is a hole") {
  const auto tracks = must_read(
      "2\nlamp 01\n0\n3\n1 0.500000 1079.500000 \n2 960.000000000000000 540.000000000000000\n5 1440.25 "
      "270.75\nright\n6\n1\n1 1920 0\n",
      TrackFormat::Equalizer, {1920, 1080, 1000});
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[0].name == "lamp 01");
  const auto shot = animation_of_points(tracks, "").value();
  check_pixel(pixel_at(shot, 0, 1001), {0.5, 0.5});
  check_pixel(pixel_at(shot, 0, 1002), {960, 540});
  check_pixel(pixel_at(shot, 0, 1005), {1440.25, 809.25});
  check_pixel(pixel_at(shot, 1, 1001), {1920, 1080});
  for (const int frame : {1000, 1003, 1004, 1006}) CHECK_FALSE(is_on(shot, 0, frame));
  CHECK(is_on(shot, 0, 1005));
}

TEST_CASE("SynthEyes: -1 to 1 over the picture, right and down; flags without a position are holes") {
  const auto tracks = must_read(
      "Tracker1 1 0.534170 0.262748 15\nTracker1 2 -1.000000 -1.000000 7\nTracker1 3 0.5 0.5 3\n"
      "Tracker1 4 0.999479 0.999074 30\nRed lamp 4 0.000000 0.000000 7\n",
      TrackFormat::SynthEyes);
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[1].name == "Red lamp");
  const auto shot = animation_of_points(tracks, "").value();
  // (1 + 0.534170) / 2 * 1920 and (1 + 0.262748) / 2 * 1080.
  check_pixel(pixel_at(shot, 0, 1), {1472.8032, 681.88392});
  check_pixel(pixel_at(shot, 0, 2), {0, 0});
  check_pixel(pixel_at(shot, 0, 4), {1919.5, 1079.5});
  check_pixel(pixel_at(shot, 1, 4), {960, 540});
  CHECK_FALSE(is_on(shot, 0, 3));
  CHECK_FALSE(is_on(shot, 1, 3));
}

TEST_CASE(
    "After Effects: the origin is the top left corner, frames count from 0; a layer's size is not the picture's") {
  const std::string text =
      "Adobe After Effects 8.0 Keyframe Data\r\n\r\n\tUnits Per Second\t25\r\n\tSource Width\t100\r\n\tSource "
      "Height\t100\r\n"
      "\tSource Pixel Aspect Ratio\t1\r\n\tComp Pixel Aspect Ratio\t2\r\n\r\nTransform\tAnchor Point\r\n"
      "\tFrame\tX pixels\tY pixels\tZ pixels\t\r\n\t0\t50\t50\t0\t\r\n\r\nTransform\tPosition\r\n"
      "\tFrame\tX pixels\tY pixels\tZ pixels\t\r\n\t0\t0.5\t0.5\t0\t\r\n\t10\t660.504\t230.727\t0\t\r\n\r\n"
      "Transform\tScale\r\n\tFrame\tX percent\tY percent\tZ percent\t\r\n\t0\t7\t7\t7\t\r\n\r\n"
      "Effects\tPoint Control #1\tPoint #2\r\n\tFrame\tX pixels\tY pixels\t\r\n\t\t960\t540\t\r\n\r\nEnd of Keyframe "
      "Data\r\n";
  const auto tracks = must_read(text, TrackFormat::AfterEffects, {1920, 1080, 1001});
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[0].name == "Position");
  CHECK(tracks[1].name == "Point Control #1 Point #2");
  const auto shot = animation_of_points(tracks, "").value();
  check_pixel(pixel_at(shot, 0, 1001), {0.5, 0.5});
  check_pixel(pixel_at(shot, 0, 1011), {660.504, 230.727});
  check_pixel(pixel_at(shot, 0, 1006), {330.502, 115.6135});
  check_pixel(pixel_at(shot, 1, 1500), {960, 540});
}

TEST_CASE("After Effects: the attached point of a motion tracker, not its centre") {
  const auto tracks = must_read(
      "Adobe After Effects 8.0 Keyframe Data\n\nMotion Trackers\tTracker #1\tTrack Point #1\tFeature Center #4\n"
      "\tFrame\tX pixels\tY pixels\t\n\t0\t1\t2\t\n\nMotion Trackers\tTracker #1\tTrack Point #1\tAttach Point #10\n"
      "\tFrame\tX pixels\tY pixels\t\n\t0\t3\t4\t\n\nEnd of Keyframe Data\n",
      TrackFormat::AfterEffects);
  REQUIRE(tracks.size() == 1);
  CHECK(tracks[0].name == "Tracker #1 Track Point #1 Attach Point #10");
}

TEST_CASE("our CSV of tracks") {
  const auto tracks =
      must_read("frame,name,x,y\n# a comment\n1001,lamp,0.5,0.5\n1003,lamp,960,540\n", TrackFormat::Csv);
  const auto shot = animation_of_points(tracks, "1,2,3").value();
  check_pixel(pixel_at(shot, 0, 1003), {960, 540});
  CHECK_FALSE(is_on(shot, 0, 1002));
  CHECK(text_at(*shot.lights[0].value, 1) == "1,2,3");
}

TEST_CASE("a camera that turns and moves sees points where they are") {
  // At 90 degrees to the left about y, the camera looks along -x; what is at -z is to its right.
  const auto camera = read_chan(
                          "1001 0 0 0 0 0 0 30\n1002 0 0 0 0 90 0 30\n1003 1 2 3 0 0 0 30\n1004 0 0 0 90 0 0 30\n"
                          "1005 0 0 0 0 0 90 30\n",
                          "camera.chan")
                          .value();
  const auto points =
      read_world_points("name,x,y,z\nahead,0,0,-10\nleft,-10,1,-1\nfar,1,2,-97\nup,2,10,0\n", "points.csv").value();
  const auto lights = lights_of_world(camera, points, {1920, 1080, "ZXY", 1000.0, ""}).value();
  CHECK(lights.never_seen.empty());
  const Animation& shot = lights.animation;
  const auto angles = [&](std::size_t k, double frame) {
    return params::parse_reals(text_at(shot.lights[k].position, frame), 2).value();
  };
  const double deg = 180.0 / std::numbers::pi;
  CHECK(angles(0, 1001)[0] == test::approx(0.0).epsilon(1e-9).scale(1.0));
  CHECK(params::parse_real(text_at(*shot.lights[0].distance, 1001)).value() == test::approx(10000.0));
  CHECK_FALSE(is_on(shot, 0, 1002));
  CHECK(angles(1, 1002)[0] == test::approx(std::atan2(1.0, 10.0) * deg));
  CHECK(angles(1, 1002)[1] == test::approx(std::atan2(1.0, std::hypot(10.0, 1.0)) * deg));
  CHECK(angles(2, 1003)[0] == test::approx(0.0).scale(1.0));
  CHECK(params::parse_real(text_at(*shot.lights[2].distance, 1003)).value() == test::approx(100000.0));
  // At 90 degrees about x the camera looks up; what is at x = 2 stays at its right.
  CHECK(angles(3, 1004)[0] == test::approx(std::atan2(2.0, 10.0) * deg));
  CHECK(angles(3, 1004)[1] == test::approx(0.0).scale(1.0));
  // Rolled by 90 degrees to the left, its right is the world's up.
  CHECK(angles(2, 1005)[0] == test::approx(std::atan2(2.0, 97.0) * deg));
  CHECK(angles(2, 1005)[1] == test::approx(std::atan2(-1.0, std::hypot(97.0, 2.0)) * deg));

  // The field of view is the vertical one: 30 degrees, 16:9.
  const double hfov = params::parse_real(text_at(shot.parameters.at(0).second, 1001)).value();
  CHECK(shot.parameters[0].first == "hfov");
  CHECK(hfov == test::approx(2.0 * std::atan(16.0 / 9.0 * std::tan(15.0 / deg)) * deg));
}

TEST_CASE("orders of rotation: the first axis of the name is rotated about first, in the camera's own frame last") {
  // Matrices by hand: the camera's axes in the world are those of R = Ry Rx Rz for ZXY, and Rz Ry Rx for XYZ.
  using Matrix = std::array<std::array<double, 3>, 3>;
  const auto about = [](int axis, double angle) {
    Matrix m{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const auto a = static_cast<std::size_t>((axis + 1) % 3), b = static_cast<std::size_t>((axis + 2) % 3);
    m[a][a] = m[b][b] = std::cos(angle);
    m[b][a] = std::sin(angle);
    m[a][b] = -std::sin(angle);
    return m;
  };
  const auto times = [](const Matrix& a, const Matrix& b) {
    Matrix m{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k) m[i][j] += a[i][k] * b[k][j];
    return m;
  };
  const double rx = 0.2, ry = -0.5, rz = 0.3;
  const Matrix zxy = times(about(1, ry), times(about(0, rx), about(2, rz)));
  const Matrix xyz = times(about(2, rz), times(about(1, ry), about(0, rx)));
  const double deg = 180.0 / std::numbers::pi;
  const std::vector<CameraPose> camera{{1, {1, 2, 3}, {rx * deg, ry * deg, rz * deg}, {}}};
  for (const auto& [order, matrix] : {std::pair{"ZXY", zxy}, {"XYZ", xyz}}) {
    const double in_camera[3] = {1.5, -0.7, -8.0};
    double world[3] = {1, 2, 3};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) world[i] += matrix[i][k] * in_camera[k];
    const std::vector<WorldPoint> points{{"lamp", {{0, {world[0], world[1], world[2]}}}, false}};
    const auto lights = lights_of_world(camera, points, {1920, 1080, order, std::nullopt, ""}).value();
    const auto angles = params::parse_reals(text_at(lights.animation.lights[0].position, 1), 2).value();
    CHECK(angles[0] == test::approx(std::atan2(1.5, 8.0) * deg));
    CHECK(angles[1] == test::approx(std::atan2(-0.7, std::hypot(1.5, 8.0)) * deg));
    CHECK_FALSE(lights.animation.lights[0].distance.has_value());
  }
}

TEST_CASE("holes in cameras and points name the frame") {
  const auto says = [](const auto& result, const std::string& what) {
    REQUIRE_FALSE(result.has_value());
    CAPTURE(result.error().to_string());
    CHECK(contains(result.error().to_string(), what));
  };
  says(read_chan("1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n4 0 0 0 0 0 0\n", "c.chan"), "c.chan:3: frame 3 is missing");
  says(read_chan("2 0 0 0 0 0 0\n1 0 0 0 0 0 0\n", "c.chan"), "c.chan:2: frame 1 comes after frame 2");
  says(read_chan("1 0 0 0 0 0\n", "c.chan"), "frame 1 has 6 numbers");
  says(read_chan("1 0 0 0 0 0 0 30\n2 0 0 0 0 0 0\n", "c.chan"), "c.chan:2: frame 2");
  says(read_chan("1 0 0 0 0 0 0 200\n", "c.chan"), "field of view");
  says(read_chan("# nothing\n", "c.chan"), "no frame");
  says(read_world_points("name,x,y\na,1,2\n", "p.csv"), "p.csv:1: the first line has no column z");
  says(read_world_points("name,x,y,z\na,1,2,3\na,1,2,3\n", "p.csv"), "p.csv:3: \"a\" has two positions");
  const auto camera = read_chan("1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n", "c.chan").value();
  const auto moving = read_world_points("name,frame,x,y,z\na,1,0,0,-5\na,3,0,0,-5\n", "p.csv").value();
  says(lights_of_world(camera, moving, {1920, 1080, "ZXY", {}, ""}), "\"a\" has no position in frame 2");
  says(lights_of_world(camera, moving, {1920, 1080, "ZZY", {}, ""}), "ZXY");
  const auto behind = read_world_points("name,x,y,z\na,0,0,5\n", "p.csv").value();
  CHECK(lights_of_world(camera, behind, {1920, 1080, "ZXY", {}, ""})->never_seen == std::vector<std::string>{"a"});
}

TEST_CASE("errors of track files name the line") {
  const auto says = [](const std::string& error, const std::string& what) {
    CAPTURE(error);
    CHECK(contains(error, what));
  };
  says(error_of("1 2 3\n2 x 3\n", TrackFormat::NukeTracker), "tracks.txt:2: frame 2: \"x\" is not a number");
  says(error_of("1 2 3\n2 2 3 4 5\n", TrackFormat::NukeTracker), "tracks.txt:2: frame 2: a line is a frame");
  says(error_of("1 2 3\n1 2 3\n", TrackFormat::NukeTracker), "tracks.txt:2: frame 1 of \"track 1\" has two positions");
  says(error_of("1.5 2 3\n", TrackFormat::NukeTracker),
       "tracks.txt:1: the line does not begin with the number of a frame");
  says(error_of("", TrackFormat::NukeTracker), "no track");
  says(error_of("2\na\n0\n1\n1 2 3\n", TrackFormat::Equalizer), "the file ends before point 2 of 2");
  says(error_of("1\na\n0\n3\n1 2 3\n", TrackFormat::Equalizer), "the file ends before the last frame of \"a\"");
  says(error_of("1\na\nred\n3\n1 2 3\n", TrackFormat::Equalizer), "tracks.txt:3: the colour of \"a\"");
  says(error_of("1\na\n0\n1\n1 2\n", TrackFormat::Equalizer), "tracks.txt:5");
  says(error_of("a 1 0.1 0.2\n", TrackFormat::SynthEyes), "tracks.txt:1");
  says(error_of("a 1 0.1 0.2 3\n", TrackFormat::SynthEyes), "no track with a position");
  says(
      error_of("Adobe After Effects 8.0 Keyframe Data\nTransform\tPosition\n\tFrame\tX pixels\tY pixels\n\t1.5\t2\t3\n",
               TrackFormat::AfterEffects),
      "tracks.txt:4: \"1.5\" is not the number of a frame");
  says(error_of("name,frame,x,y\na,1,2\n", TrackFormat::Csv), "tracks.txt:2: the line has 3 values, not 4");
  says(error_of("name,x,y\na,1,2\n", TrackFormat::Csv), "no column frame");
  CHECK(read_tracks("1 2 3\n", "t.txt", TrackFormat::NukeTracker, {1920, 1080, 2000000000}).error().code ==
        ErrorCode::InvalidArgument);
  CHECK(read_chan("1 0 0 0 0 0 0\n", "c.chan", -2000000000).error().code == ErrorCode::InvalidArgument);
  CHECK_FALSE(track_format("hello world\n", "t.txt").has_value());
  CHECK_FALSE(track_format("", "t.txt").has_value());
  CHECK(track_format("1 2 3", "t.CHAN").value() == TrackFormat::Chan);
}
