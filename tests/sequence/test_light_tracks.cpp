// SPDX-License-Identifier: Apache-2.0
// Lights that move through small pictures: detected frame by frame, followed, and made into keys. What is true is
// known.
#include "contrejour/expert/light_tracks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>

#include <doctest/doctest.h>

#include "contrejour/expert/parameter_text.h"
#include "sequence/tracking/assignment.h"
#include "sequence/tracking/thin_keys.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

constexpr int kWidth = 160, kHeight = 90;

struct TrueLight {
  Vec2 position_px;
  double radius_px = 2.0;
  Rgb level{100, 100, 100};
};

// A disc with a soft edge of a pixel.
void draw(Image& image, const TrueLight& light) {
  const int reach = static_cast<int>(light.radius_px) + 2;
  const int cx = static_cast<int>(std::floor(light.position_px.x)),
            cy = static_cast<int>(std::floor(light.position_px.y));
  for (int y = std::max(0, cy - reach); y <= std::min(image.height - 1, cy + reach); ++y) {
    for (int x = std::max(0, cx - reach); x <= std::min(image.width - 1, cx + reach); ++x) {
      const double distance = length(Vec2{x + 0.5, y + 0.5} - light.position_px);
      const double cover = std::clamp(light.radius_px + 0.5 - distance, 0.0, 1.0);
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) += static_cast<float>(cover * light.level[static_cast<std::size_t>(c)]);
    }
  }
}

void cover(Image& image, int x0, int x1) {
  for (int y = 0; y < image.height; ++y)
    for (int x = std::max(0, x0); x < std::min(image.width, x1); ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = 0.01F;
}

void add_grain(Image& image, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<float> normal;
  for (float& sample : image.pixels)
    sample = std::max(0.0F, sample + 0.05F * std::sqrt(sample + 0.04F) * normal(engine));
}

using Paint = std::function<void(int frame, Image& image)>;

std::vector<FrameLights> detected(int count, const Paint& paint) {
  DetectionSettings settings;
  settings.threshold = 2.0;
  settings.max_lights = 1000;
  std::vector<FrameLights> frames;
  for (int frame = 0; frame < count; ++frame) {
    Image image(kWidth, kHeight);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.02F);
    paint(frame, image);
    add_grain(image, static_cast<unsigned>(frame));
    const PixelWindow window{0, 0, kWidth, kHeight};
    frames.push_back(frame_lights(frame, *detect_lights(image, settings), window, window));
  }
  return frames;
}

// The largest distance between a track and the true path, over the frames that the track has.
double farthest(const LightTrack& track, const std::function<Vec2(int frame)>& path) {
  double largest = 0;
  for (const TrackPoint& point : track.points)
    largest = std::max(largest, length(point.position_px - path(point.frame)));
  return largest;
}

double flux_of(const Rgb& rgb) { return rgb[0] + rgb[1] + rgb[2]; }

// The value of each frame of a light in a file, 0 where it is off.
std::vector<double> values_over(const AnimatedLight& light, int count) {
  std::vector<double> values;
  for (int frame = 0; frame < count; ++frame) {
    const bool off = light.on && text_at(*light.on, frame) == "off";
    const auto value = params::parse_light_value(text_at(*light.value, frame)).value();
    values.push_back(off ? 0.0 : flux_of(value.rgb));
  }
  return values;
}

Vec2 position_at(const AnimatedLight& light, double frame) {
  const auto uv = params::parse_reals(text_at(light.position, frame), 2).value();
  return {uv[0] * kWidth, uv[1] * kHeight};
}

TrackKeySettings key_settings() {
  TrackKeySettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  return settings;
}

std::vector<int> numbers(int count) {
  std::vector<int> frames(static_cast<std::size_t>(count));
  std::iota(frames.begin(), frames.end(), 0);
  return frames;
}

double largest_step(const std::vector<double>& values) {
  double largest = 0;
  for (std::size_t k = 1; k < values.size(); ++k) largest = std::max(largest, std::abs(values[k] - values[k - 1]));
  return largest;
}

}  // namespace

TEST_CASE("the best pairs are those of all permutations") {
  std::mt19937 engine(3);
  for (int turn = 0; turn < 60; ++turn) {
    const int rows = 1 + turn % 5, columns = 1 + turn % 4;
    std::vector<PairGain> pairs;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        if (engine() % 4 != 0) pairs.push_back({row, column, 1 + static_cast<std::int64_t>(engine() % 1000)});
    const auto gain = [&](int row, int column) -> std::int64_t {
      for (const PairGain& pair : pairs)
        if (pair.row == row && pair.column == column) return pair.gain;
      return 0;
    };
    std::vector<int> order(static_cast<std::size_t>(std::max(rows, columns)));
    std::iota(order.begin(), order.end(), 0);
    std::int64_t best = 0;
    do {
      std::int64_t sum = 0;
      for (int row = 0; row < rows; ++row) sum += gain(row, order[static_cast<std::size_t>(row)]);
      best = std::max(best, sum);
    } while (std::next_permutation(order.begin(), order.end()));
    const std::vector<int> found = best_assignment(rows, columns, pairs);
    std::int64_t sum = 0;
    std::vector<int> times(static_cast<std::size_t>(columns));
    for (int row = 0; row < rows; ++row) {
      const int column = found[static_cast<std::size_t>(row)];
      if (column < 0) continue;
      CHECK(gain(row, column) > 0);
      CHECK(++times[static_cast<std::size_t>(column)] == 1);
      sum += gain(row, column);
    }
    CHECK(sum == best);
  }
}

TEST_CASE("identities never swap while equal lights cross, and flux is shared where their areas meet") {
  for (const double slope : {0.0, 0.15, 0.4}) {
    CAPTURE(slope);
    const auto a = [&](int frame) { return Vec2{20.0 + 2.9 * frame, 45.0 - slope * (frame - 20)}; };
    const auto b = [&](int frame) { return Vec2{140.0 - 3.1 * frame, 45.3 + slope * (frame - 20)}; };
    const auto c = [&](int frame) { return Vec2{78.0, 5.0 + 2.0 * frame}; };
    const auto frames = detected(40, [&](int frame, Image& image) {
      for (const Vec2 at : {a(frame), b(frame), c(frame)}) draw(image, {at});
    });
    const auto tracks = track_lights(frames);
    REQUIRE(tracks.size() == 3);
    const std::function<Vec2(int)> paths[] = {a, b, c};
    for (const auto& path : paths) {
      const auto track = std::min_element(tracks.begin(), tracks.end(), [&](const auto& s, const auto& t) {
        return length(s.points.front().position_px - path(0)) < length(t.points.front().position_px - path(0));
      });
      CHECK(track->points.size() == 40);
      CHECK(farthest(*track, path) < 1.5);
      CHECK(length(track->points.back().position_px - path(39)) < 0.2);
      for (const TrackPoint& point : track->points)
        CHECK(flux_of(point.flux) == test::approx(flux_of(track->points.front().flux)).epsilon(0.12));
    }
  }
}

TEST_CASE("a row of equal lamps under a camera that shakes") {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> shake(-4.0, 4.0);
  std::vector<Vec2> camera;
  for (int frame = 0; frame < 30; ++frame) camera.push_back({1.5 * frame + shake(engine), shake(engine)});
  // From frame to frame the camera may move by a third of the distance between lamps.
  const auto lamp = [&](int k, int frame) {
    return Vec2{20.0 + 27.0 * k, 40.0 + 3.0 * (k % 2)} -
           Vec2{camera[static_cast<std::size_t>(frame)].x - 10.0, camera[static_cast<std::size_t>(frame)].y};
  };
  const auto frames = detected(30, [&](int frame, Image& image) {
    for (int k = 0; k < 8; ++k) draw(image, {lamp(k, frame), 1.5});
  });
  const auto tracks = track_lights(frames);
  for (const LightTrack& track : tracks) {
    int nearest = 0;
    for (int k = 0; k < 8; ++k)
      if (length(track.points.front().position_px - lamp(k, track.points.front().frame)) <
          length(track.points.front().position_px - lamp(nearest, track.points.front().frame)))
        nearest = k;
    for (const TrackPoint& point : track.points) {
      CAPTURE(point.frame);
      CAPTURE(nearest);
      CHECK(length(point.position_px - lamp(nearest, point.frame)) < 2.0);
    }
  }
}

TEST_CASE("a light behind a pole keeps its name, fades, and another one behind a wall does not") {
  const auto path = [](int frame) { return Vec2{10.0 + 3.0 * frame, 30.0}; };
  const auto wall = [](int frame) { return Vec2{10.0 + 3.0 * frame, 70.0}; };
  constexpr int kFrames = 44;
  const auto frames = detected(kFrames, [&](int frame, Image& image) {
    draw(image, {path(frame), 4.0});
    cover(image, 60, 66);    // narrower than the light: it is divided
    cover(image, 90, 103);   // wider: the light is hidden for a few frames
    Image rest(kWidth, kHeight);
    draw(rest, {wall(frame), 2.0});
    cover(rest, 50, 110);    // hidden for longer than a gap
    for (std::size_t k = 0; k < rest.pixels.size(); ++k) image.pixels[k] += rest.pixels[k];
  });
  const auto tracks = track_lights(frames);
  REQUIRE(tracks.size() == 3);
  const auto upper = std::find_if(tracks.begin(), tracks.end(),
                                  [](const LightTrack& t) { return t.points.front().position_px.y < 50; });
  REQUIRE(upper != tracks.end());
  CHECK(farthest(*upper, path) < 4.0);  // the centre of what is seen of a nearly covered disc
  CHECK(upper->points.front().frame == 0);
  CHECK(upper->points.back().frame == kFrames - 1);

  const Animation shot = animation_of_tracks(tracks, numbers(kFrames), key_settings());
  REQUIRE(shot.lights.size() == 3);
  CHECK(shot.lights[0].on.has_value());
  for (const AnimatedLight& light : shot.lights) {
    const auto values = values_over(light, kFrames);
    CHECK(largest_step(values) < 0.5 * *std::max_element(values.begin(), values.end()));
  }
  // The read animation is the written one.
  CHECK(*read_animation(write_animation(shot), "shot.toml") == shot);
}

TEST_CASE("lights that appear and move farther than the search keep their names from their first frame on") {
  // Equal lights that come out of one place one after the other, fast at first: when the second one appears, it is
  // where the first one was, which has moved on by more than the search.
  constexpr int kLights = 4, kLag = 2;
  const auto path = [](int age) {
    static constexpr double kStart[] = {20, 50, 74, 92, 104, 112, 118};
    return Vec2{age < 7 ? kStart[age] : 118.0 + 5.0 * (age - 6), 45.0};
  };
  const auto age_of = [](int light, int frame) { return frame - 3 - kLag * light; };
  const auto frames = detected(16, [&](int frame, Image& image) {
    draw(image, {{80, 20}});  // another one, which stands still
    for (int light = 0; light < kLights; ++light)
      if (age_of(light, frame) >= 0) draw(image, {path(age_of(light, frame))});
  });
  const auto tracks = track_lights(frames, {.search_px = 16});
  CHECK(tracks.size() == kLights + 1);
  for (int light = 0; light < kLights; ++light) {
    CAPTURE(light);
    CHECK(std::ranges::any_of(tracks, [&](const LightTrack& track) {
      return age_of(light, track.points.front().frame) == 0 && track.points.back().frame == 15 &&
             farthest(track, [&](int frame) { return path(std::max(0, age_of(light, frame))); }) < 0.5;
    }));
  }
}

TEST_CASE("lights enter and leave at the edge without a step") {
  constexpr int kFrames = 40;
  // A light of one pixel, whose measured flux ends at once where it leaves.
  const auto path = [](int frame) { return Vec2{-22.6 + 5.0 * frame, 20.0 + 0.5 * frame}; };
  const auto frames = detected(kFrames, [&](int frame, Image& image) { draw(image, {path(frame), 0.5}); });
  const auto tracks = track_lights(frames);
  REQUIRE(tracks.size() == 1);
  const Animation shot = animation_of_tracks(tracks, numbers(kFrames), key_settings());
  const auto values = values_over(shot.lights[0], kFrames);
  const double largest = *std::max_element(values.begin(), values.end());
  CHECK(values.front() == 0.0);
  CHECK(values.back() == 0.0);
  CHECK(largest_step(values) < 0.4 * largest);
  for (int frame = 0; frame < kFrames; ++frame)
    if (values[static_cast<std::size_t>(frame)] > 0.0)
      CHECK(length(position_at(shot.lights[0], frame) - path(frame)) < 1.0);
}

TEST_CASE("flux follows a light that fades through the threshold, and nothing else") {
  constexpr int kFrames = 60;
  const auto level = [](int frame) { return 60.0 * std::pow(std::sin(std::numbers::pi * frame / 59.0), 2.0); };
  double true_step = 0;
  for (int frame = 1; frame < kFrames; ++frame)
    true_step = std::max(true_step, std::abs(level(frame) - level(frame - 1)));
  const auto frames = detected(kFrames, [&](int frame, Image& image) {
    draw(image, {{40.0, 45.0}, 2.0, {level(frame), level(frame), level(frame)}});
    draw(image, {{100.0, 45.0 + 0.2 * frame}, 2.0, {50, 40, 30}});
  });
  const auto tracks = track_lights(frames);
  REQUIRE(tracks.size() == 2);
  const Animation shot = animation_of_tracks(tracks, numbers(kFrames), key_settings());
  const auto steady = values_over(shot.lights[0], kFrames), fading = values_over(shot.lights[1], kFrames);
  CHECK(largest_step(steady) < 0.06 * steady.front());  // grain, and edges on pixels
  const double flux_of_level = *std::max_element(fading.begin(), fading.end()) / 60.0;
  CHECK(largest_step(fading) < 1.15 * true_step * flux_of_level);
  for (int frame = 0; frame < kFrames; ++frame)
    CHECK(std::abs(fading[static_cast<std::size_t>(frame)] - flux_of_level * level(frame)) <
          0.06 * 60.0 * flux_of_level);
}

TEST_CASE("two lamps that separate take over the flux of one") {
  constexpr int kFrames = 30;
  const auto frames = detected(kFrames, [&](int frame, Image& image) {
    draw(image, {{70.0 - 0.4 * frame, 45.0}});
    draw(image, {{72.0 + 0.4 * frame, 45.0}});
  });
  const auto tracks = track_lights(frames);
  REQUIRE(tracks.size() == 2);
  CHECK_FALSE(tracks[1].begins_apart);
  const Animation shot = animation_of_tracks(tracks, numbers(kFrames), key_settings());
  std::vector<double> sum = values_over(shot.lights[0], kFrames);
  const auto other = values_over(shot.lights[1], kFrames);
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += other[k];
  CHECK(largest_step(sum) < 0.1 * sum.back());
}

TEST_CASE("lights of other colours are others, and hot pixels are none") {
  const auto frames = detected(12, [&](int frame, Image& image) {
    // A red light goes out where, in the next frame, a blue one goes on.
    if (frame < 6) draw(image, {{60, 40}, 2.0, {90, 5, 5}});
    if (frame >= 6) draw(image, {{63, 40}, 2.0, {5, 5, 90}});
    if (frame == 3) image.at(120, 70, 1) = 500.0F;
  });
  const auto tracks = track_lights(frames);
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[0].points.size() == 6);
  CHECK(tracks[1].points.size() == 6);
}

TEST_CASE("keys that are left out are within the tolerance") {
  std::vector<Key> keys;
  for (int frame = 0; frame <= 200; frame += 1 + frame % 3)
    keys.push_back({frame, {std::sin(0.05 * frame), 0.3 * frame}, {}});
  const KeyedValue all{keys, Interpolation::Linear};
  const KeyedValue few{thinned_keys(keys, [](const Key&, std::size_t) { return 0.01; }), Interpolation::Linear};
  CHECK(few.keys.size() < keys.size() / 3);
  for (const Key& key : keys) {
    const auto at = params::parse_reals(text_at(few, key.frame), 2).value();
    CHECK(std::abs(at[0] - key.numbers[0]) <= 0.01);
    CHECK(std::abs(at[1] - key.numbers[1]) <= 0.01);
  }
}

TEST_CASE("the threshold of a shot is the middle of its frames' thresholds") {
  const auto at = [](double level, ThresholdSource source) { return Threshold{level, source}; };
  const Threshold some[] = {at(9, ThresholdSource::Gap), at(1, ThresholdSource::None), at(4, ThresholdSource::Gap),
                            at(5, ThresholdSource::Brightest)};
  CHECK(shot_threshold(some) == 5.0);
  CHECK_FALSE(shot_threshold(std::span(some + 1, 1)).has_value());
}
