// SPDX-License-Identifier: Apache-2.0
// How lights are divided, and which ghosts share a blur, as errors change steadily from frame to frame.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <doctest/doctest.h>

#include "render/area_lights/blur_clusters.h"
#include "render/area_lights/blurred_images.h"
#include "render/area_lights/frame_peak.h"
#include "render/area_lights/piece_choice.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::area;

namespace {

double left(double squares, int across) { return squares / (static_cast<double>(across) * across * across); }

double left(const GhostOfArea& ghost) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kAcross.size(); ++k) sum += ghost.parts[k] * left(ghost.squares, kAcross[k]);
  return sum;
}

// Its place among the divisions, as the mean by light.
double place(const GhostOfArea& ghost) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kAcross.size(); ++k) sum += ghost.parts[k] * static_cast<double>(k);
  return sum;
}

std::vector<GhostOfArea> divided(std::initializer_list<double> squares, double allowed) {
  std::vector<GhostOfArea> ghosts;
  for (const double one : squares) {
    ghosts.emplace_back();
    ghosts.back().squares = one;
  }
  choose_pieces(ghosts, {.peak = 1.0, .squares = allowed, .flux = 1.0});
  return ghosts;
}

}  // namespace

TEST_CASE("divisions leave the error allowed, the largest errors most divided") {
  for (const double allowed : {1.5, 0.5, 0.05, 0.005}) {
    CAPTURE(allowed);
    const auto ghosts = divided({1.0, 0.3, 0.1, 0.09, 0.001}, allowed);
    double sum = 0.0;
    for (const GhostOfArea& ghost : ghosts) sum += left(ghost);
    const double whole = 1.491, least = left(whole, 12);  // that of the finest divisions does not count
    CHECK(sum - least == test::approx(std::min(allowed, whole - least)).epsilon(1e-6));
    for (std::size_t k = 0; k + 1 < ghosts.size(); ++k) CHECK(place(ghosts[k]) >= place(ghosts[k + 1]));
  }
}

TEST_CASE("as a ghost's error falls, its division and all others' change steadily") {
  std::vector<GhostOfArea> before;
  for (double falling = 3.0; falling > 0.01; falling *= 0.98) {
    CAPTURE(falling);
    const auto ghosts = divided({falling, 0.3, 0.1, 0.06}, 0.16);
    // The order of the ghosts' gains changes on the way. Ghosts that take turns at the last division jump by a whole
    // one there.
    for (std::size_t k = 0; k < before.size(); ++k) CHECK(std::abs(place(ghosts[k]) - place(before[k])) < 0.1);
    before = ghosts;
  }
}

namespace {

// A ghost of the sun in a frame of 160 x 90 at some times; the sun moves by a tenth of a pixel each.
std::vector<GhostBlur> blurs_over_time(const LensState& lens, double lambda_nm, const Ghost& ghost, int first,
                                       int end) {
  const ReflectanceTables tables(lens, lambda_nm);
  const LensSteps steps(lens, tables);
  const Frame frame = frame_on_sensor(lens, 160, 90);
  std::vector<GhostBlur> blurs;
  for (int k = first; k < end; ++k) {
    const double moved_px = 0.1 * k;
    Light light =
        test::light_at(lens, frame, {0.70 + moved_px * std::cos(0.3) / 160, 0.33 + moved_px * std::sin(0.3) / 90});
    light.radius_rad = kSunRadius_rad;
    const LightSource source{light.direction};
    const GhostMotion motion = ghost_motion(steps, ghost, source, LightWindows(lens, source));
    blurs.push_back(blur_of(motion, pieces_of(light).front(), frame, {}, 1.0));
  }
  return blurs;
}

}  // namespace

TEST_CASE("lines of a ghost that come and go do not change the ghost's blur at once") {
  struct Case {
    const char* lens;
    LensSettings settings;
    double lambda_nm;
    Ghost ghost;
    int first, end;
  };
  // A part of the outline of the Heliar's ghost comes near the frame and moves otherwise than the part inside it; the
  // shorter radius fell to a sixth at once. The Canon's pupil is narrow, and few of its outline's pieces constrain the
  // motion along it: it fell by half.
  for (const Case& one : {Case{"heliar", {.f_number = 16.0}, 587.6, {3, 4}, 68, 82},
                          Case{"canon-70-200", {.focal_length_mm = 135.0, .f_number = 32.0}, 530.0, {6, 13}, 42, 48}}) {
    CAPTURE(one.lens);
    const auto blurs =
        blurs_over_time(test::bundled(one.lens, one.settings), one.lambda_nm, one.ghost, one.first, one.end);
    for (std::size_t k = 1; k < blurs.size(); ++k)
      CHECK(blurs[k].blur_px.x == test::approx(blurs[k - 1].blur_px.x).epsilon(0.3));
  }
}

TEST_CASE("the level of a thin ghost whose two sides move differently changes steadily") {
  // The blur's shorter radius is hardly determined, and the level was the flux over the blur's area: it changed by a
  // factor of four from one frame to the next.
  const LensState lens = test::bundled("canon-70-200", {.focal_length_mm = 135.0, .f_number = 32.0});
  const auto blurs = blurs_over_time(lens, 530.0, {11, 20}, 142, 150);
  for (std::size_t k = 1; k < blurs.size(); ++k)
    CHECK(blurs[k].level == test::approx(blurs[k - 1].level).epsilon(0.15));
}

TEST_CASE("what the parts of a light show of a ghost counts by degrees") {
  // Its pupil closes faster and faster over the light.
  Light light;
  light.radius_rad = 0.01;
  GhostOfArea ghost;
  ghost.motion.is_open = true;
  ghost.blur.level = ghost.blur.flux = 1.0;
  ghost.blur.area_px = 100.0;
  const LightPiece whole = pieces_of(light).front();
  std::vector<double> doubts;
  for (double rate = 0.0; rate < 90.0; rate += 1.0) {
    ghost.motion.area_rate = {rate, 0.0};
    doubts.push_back(doubt_about(ghost, whole, {.peak = 1.0, .squares = 1000.0, .flux = 100.0}));
  }
  CHECK(doubts.front() == 0.0);
  CHECK(doubts.back() == 1.0);
  for (std::size_t k = 1; k < doubts.size(); ++k) CHECK(std::abs(doubts[k] - doubts[k - 1]) < 0.15);
}

TEST_CASE("a ghost that joins another's image does not change its blur") {
  const Frame frame{160, 90, 0, 0, 160, 90, 0.01};
  GhostBlur sharp, wide;  // `wide` has hardly any edge in the frame, so that its own error is small
  sharp.px = LinearMap{} * 50.0;
  wide.px = LinearMap{} * 900.0;
  sharp.level = 1.0;
  wide.level = 0.9;
  sharp.blur_px = {0.25, 0.25};
  wide.blur_px = {4.5, 4.5};
  sharp.size_px = wide.size_px = {20.0, 20.0};
  sharp.lines.push_back({{1.0, 0.0}, {80.0, 45.0}, {50.0, 0.0}, 1.0, 100.0});
  const std::vector<PieceGhost> ghosts{{&sharp, 0, 0}, {&wide, 0, 1}};
  Light light;
  light.direction = {0.0, 0.0, 1.0};
  light.radius_rad = kSunRadius_rad;
  const BlurClusters made = blur_clusters(ghosts, pieces_of(light).front(), frame, 1.0, 0.5);
  REQUIRE(made.clusters.size() == 1);
  CHECK(made.clusters.front().px_from_tangents.x.x == test::approx(sharp.px.x.x));
}

namespace {

// A ghost of radius 20 pixels whose map is the same in all directions.
GhostBlur large_ghost(double by, double level, double blur_px) {
  GhostBlur ghost;
  ghost.px = LinearMap{} * by;
  ghost.level = level;
  ghost.blur_px = {blur_px, blur_px};
  ghost.size_px = {20.0, 20.0};
  return ghost;
}

LightPiece sun_piece() {
  Light light;
  light.direction = {0.0, 0.0, 1.0};
  light.radius_rad = kSunRadius_rad;
  return pieces_of(light).front();
}

}  // namespace

TEST_CASE("a ghost that no map fits does not change to another ghost's blur as if that changed nothing") {
  // Its lines move by 450 and by 850 of the map's units, so that either fits it about as badly.
  const Frame frame{160, 90, 0, 0, 160, 90, 0.01};
  GhostBlur wide = large_ghost(850.0, 1.0, 4.0), torn = large_ghost(450.0, 0.9, 2.1);
  wide.lines.push_back({{1.0, 0.0}, {80.0, 45.0}, {850.0, 0.0}, 1.0, 100.0});
  torn.lines.push_back({{1.0, 0.0}, {80.0, 45.0}, {450.0, 0.0}, 0.5, 50.0});
  torn.lines.push_back({{1.0, 0.0}, {80.0, 45.0}, {850.0, 0.0}, 0.5, 100.0});
  const LightPiece piece = sun_piece();
  const double own = map_error(torn, torn.px, piece, 1.0), shared = map_error(torn, wide.px, piece, 1.0);
  const double seen = map_error(as_drawn(torn, piece), wide.px, piece, 1.0);
  CHECK(seen > 2.0 * (shared - own));
  const std::vector<PieceGhost> ghosts{{&wide, 0, 0}, {&torn, 0, 1}};
  CHECK(blur_clusters(ghosts, piece, frame, 1.0, 0.9 * seen).clusters.size() == 2);
  CHECK(blur_clusters(ghosts, piece, frame, 1.0, 1.1 * seen).clusters.size() == 1);
}

namespace {

// A spot, whose light makes such an image.
GhostOfArea spot(double size_px, double squares, double blur_px = 20.0) {
  GhostOfArea ghost;
  ghost.squares = squares;
  ghost.blur.level = ghost.blur.visible = 1.0;
  ghost.blur.blur_px = {blur_px, blur_px};
  ghost.blur.size_px = {size_px, size_px};
  return ghost;
}

}  // namespace

TEST_CASE("a spot that shows the light's rim stays whole, unless its own map makes a larger error than soft pieces") {
  const auto across = [](double size_px, double squares) {
    // A ghost that shows no rim can be divided instead.
    std::vector<GhostOfArea> ghosts{spot(size_px, squares), spot(200.0, 0.3 * squares)};
    choose_pieces(ghosts, {.peak = 1.0, .squares = 1.05 * squares, .flux = 1.0});
    return place(ghosts.front());
  };
  CHECK(across(0.2, 5.0) == 0.0);
  CHECK(across(0.2, 200.0) > 0.2);
  CHECK(across(40.0, 5.0) > 0.2);
}

TEST_CASE("a spot passes steadily from one division to a much finer one, past those that are worse than both") {
  std::vector<double> parts_before;
  bool passes_over = false;
  for (double squares = 2.0; squares < 40.0; squares *= 1.01) {
    CAPTURE(squares);
    std::vector<GhostOfArea> ghosts{spot(0.2, squares), spot(200.0, 5.0), spot(100.0, 2.0)};
    choose_pieces(ghosts, {.peak = 1.0, .squares = 0.5, .flux = 1.0});
    const auto& parts = ghosts.front().parts;
    double sum = 0.0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      CHECK(parts[k] >= 0.0);
      sum += parts[k];
      if (!parts_before.empty()) CHECK(std::abs(parts[k] - parts_before[k]) < 0.1);
    }
    CHECK(sum == test::approx(1.0));
    passes_over = passes_over || (parts[0] > 0.1 && parts[1] + parts[2] + parts[3] == 0.0 && parts[0] < 0.9);
    parts_before.assign(parts.begin(), parts.end());
  }
  CHECK(passes_over);
}

TEST_CASE("errors of a light's pieces that overlap add up") {
  const Frame frame{160, 90, 0, 0, 160, 90, 0.01};
  GhostBlur wide = large_ghost(850.0, 1.0, 4.0), part = large_ghost(800.0, 0.9, 3.8);
  wide.lines.push_back({{1.0, 0.0}, {80.0, 45.0}, {850.0, 0.0}, 1.0, 100.0});
  part.lines.push_back({{1.0, 0.0}, {80.0, 45.0}, {800.0, 0.0}, 0.5, 100.0});
  const LightPiece piece = sun_piece();
  const double alone = map_error(as_drawn(part, piece), wide.px, piece, 1.0);
  for (const double overlapping : {1.0, 3.0}) {
    const std::vector<PieceGhost> ghosts{{&wide, 0, 0}, {&part, 0, 1, overlapping}};
    CHECK(blur_clusters(ghosts, piece, frame, 1.0, 2.0 * alone).clusters.size() == (overlapping < 2.0 ? 1 : 2));
  }
}

namespace {

// A ghost of radius 10 pixels, blurred by one to three pixels.
GhostBlur blurred_ghost(std::size_t number) {
  GhostBlur ghost;
  const double by = 200.0 * std::pow(3.0, static_cast<double>(number * 7 % 20) / 19.0);
  ghost.px = ghost.motion_px = LinearMap{} * by;
  ghost.blur_px = Vec2{1.0, 1.0} * (by * std::tan(kSunRadius_rad));
  ghost.size_px = {10.0, 10.0};
  ghost.level = 0.2 - 0.001 * static_cast<double>(number);
  ghost.area_px = 400.0;
  ghost.at_px = {80.0, 45.0};
  ghost.lines.push_back({{1.0, 0.0}, {80.0, 45.0}, {by, 0.0}, ghost.level, 30.0});
  ghost.lines.push_back({{0.0, 1.0}, {80.0, 45.0}, {0.0, by}, ghost.level, 30.0});
  return ghost;
}

// A frame of the sun's ghosts, of pieces of the sun that change none of them if it is divided.
SurveyedFrame sun_frame(std::size_t ghosts, int across, double peak) {
  Light sun;
  sun.direction = {0.0, 0.0, 1.0};
  sun.radius_rad = kSunRadius_rad;
  SurveyedLight light;
  light.parts.across = across;
  light.parts.pieces = pieces_of(sun, across);
  light.parts.planned.resize(light.parts.pieces.size());
  for (PlannedLight& planned : light.parts.planned) planned.passes.push_back({550.0, {1.0, 1.0, 1.0}});
  for (std::size_t k = 0; k < ghosts; ++k) {
    light.ghosts.push_back(k);
    light.light_fractions.push_back(1.0);
    light.wholes.push_back(blurred_ghost(k));
  }
  light.blurs.assign(light.parts.pieces.size(), light.wholes);
  return {{light}, peak};
}

FrameSettings small_frame() {
  FrameSettings settings;
  settings.frame = {160, 90, 0, 0, 160, 90, 0.01};
  return settings;
}

// The mean by light of the map that each ghost is drawn with.
std::vector<double> drawn_maps(const SurveyedFrame& frame, const FrameSettings& settings) {
  std::vector<double> light(frame.lights.front().ghosts.size()), maps(light.size());
  for (const BlurredImage& image : blurred_images(frame, settings))
    for (const GhostOfLight& pair : image.pairs) {
      const double part = image.lights[pair.light].passes.front().gain[0];
      light[pair.ghost] += part;
      maps[pair.ghost] += part * image.px_from_tangents.x.x * std::exp2(image.level);
    }
  for (const double one : light) CHECK(one == test::approx(1.0));
  return maps;
}

}  // namespace

TEST_CASE("as errors grow steadily, ghosts fade from one image into another, and lose no light") {
  SurveyedFrame frame = sun_frame(20, 1, 4.0);
  const SurveyedLight& light = frame.lights.front();
  const FrameSettings settings = small_frame();
  std::vector<double> before;
  int changes = 0;
  double largest = 0.0;
  for (frame.peak = 4.0; frame.peak > 1.0; frame.peak *= 0.998) {
    CAPTURE(frame.peak);
    const std::vector<double> maps = drawn_maps(frame, settings);
    double step = 0.0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const double off_px = std::abs(maps[k] - before[k]) * std::tan(kSunRadius_rad),
                   width_px = light.wholes[k].blur_px.x;
      step += 60.0 * misfit_error(light.wholes[k].level / frame.peak, width_px, off_px);
      changes += off_px > 0.0 ? 1 : 0;
    }
    largest = std::max(largest, step);
    before = maps;
  }
  // With one choice of clusters at a time a step was 0.2 of the frame's squared error.
  CHECK(largest < 0.15 * settings.area_error * settings.area_error * settings.frame.width * settings.frame.height);
  CHECK(changes > 1000);
}

TEST_CASE("images share the squared error by their ghosts, and those of overlapping pieces have less of it") {
  const FrameSettings settings = small_frame();
  const auto images = [&](std::size_t ghosts, int across) {
    return blurred_images(sun_frame(ghosts, across, 1.0), settings);
  };
  CHECK(images(1, 1).front().error_fraction == 1.0);
  const std::vector<BlurredImage> several = images(150, 1), divided = images(150, 2);
  REQUIRE(several.size() > 2);
  const auto by_ghosts = [](const BlurredImage& a, const BlurredImage& b) { return a.pairs.size() < b.pairs.size(); };
  const auto [few, many] = std::ranges::minmax_element(several, by_ghosts);
  CHECK(few->error_fraction < many->error_fraction);
  // Five times an image's part of all ghosts, and of 16 more. All four pieces lie one upon the other.
  const auto largest_part = [](const BlurredImage& image, double ghosts) {
    return 5.0 * (16.0 + static_cast<double>(image.pairs.size())) / (16.0 + ghosts) * (1.0 + 1e-12);
  };
  for (const BlurredImage& image : several) CHECK(image.error_fraction <= largest_part(image, 150.0));
  for (const BlurredImage& image : divided) CHECK(image.error_fraction <= 0.25 * largest_part(image, 600.0));
}

TEST_CASE("a bright ghost beside the frame is no part of the peak, which changes steadily as it comes in") {
  const Frame frame{160, 90, 0, 0, 160, 90, 0.01};
  GhostBlur inside, outside;
  inside.level = 1.0;
  inside.area_px = 2000.0;
  inside.at_px = {80.0, 45.0};
  inside.size_px = inside.blur_px = {18.0, 18.0};
  outside.level = 3.0;
  outside.area_px = 120.0;
  outside.size_px = outside.blur_px = {4.4, 4.4};
  outside.at_px = {180.0, 45.0};
  double before = peak_of({inside, outside}, frame);
  CHECK(before == test::approx(1.0));
  for (; outside.at_px.x > 140.0; outside.at_px.x -= 0.1) {
    CAPTURE(outside.at_px.x);
    const double peak = peak_of({inside, outside}, frame);
    CHECK(peak == test::approx(before).epsilon(0.1));
    before = peak;
  }
  CHECK(before == test::approx(3.0).epsilon(0.01));
}
