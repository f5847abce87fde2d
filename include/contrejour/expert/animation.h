// SPDX-License-Identifier: Apache-2.0
// The lights and parameters that change over the frames of a shot, by keys in a file (docs/formats/lights.md).
// Errors: Parse with file, line and remedy; Io. Thread-safety: plain values and pure functions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

// From one key to the next: the earlier one's value; a straight line; a curve without a corner at the keys, which rises
// or falls only where they do.
enum class Interpolation { Step, Linear, Smooth };

struct Key {
  int frame = 0;
  std::vector<double> numbers;  // as many in each key
  std::string text;  // in place of numbers; between keys, the earlier one's

  friend bool operator==(const Key&, const Key&) = default;
};

// A value at each frame: constant before the first key and after the last.
struct KeyedValue {
  std::vector<Key> keys;  // in rising order, at least one
  Interpolation between = Interpolation::Linear;

  friend bool operator==(const KeyedValue&, const KeyedValue&) = default;
};

// The value as the command line writes it: a text, or numbers separated by commas.
[[nodiscard]] CONTREJOUR_API std::string text_at(const KeyedValue& value, double frame);

struct AnimatedLight {
  std::string name;
  bool by_direction = false;  // the position is azimuth and elevation in degrees; else u and v in the frame
  KeyedValue position;
  std::optional<KeyedValue> value, colour, size_deg, distance;  // without one, the common option's
  std::optional<KeyedValue> on;  // "on" or "off"

  friend bool operator==(const AnimatedLight&, const AnimatedLight&) = default;
};

struct Animation {
  std::vector<std::pair<std::string, KeyedValue>> parameters;  // by their names (parameter.h)
  std::vector<AnimatedLight> lights;

  friend bool operator==(const Animation&, const Animation&) = default;
};

[[nodiscard]] CONTREJOUR_API Result<Animation> read_animation(std::string_view toml, const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<Animation> read_animation(const std::filesystem::path& file);

// The text of a file that read_animation reads as the same animation, number by number. A value with many keys has a
// table of its own with a key on each line, so that it can be corrected by hand.
[[nodiscard]] CONTREJOUR_API std::string write_animation(const Animation& animation);

// The parameters at a frame, lights aside.
[[nodiscard]] CONTREJOUR_API params::Values parameters_at(const Animation& animation, double frame);

// The time for which a frame is exposed: angle_deg / 360 of a frame, from the frame's time on, or with that time in its
// middle.
struct Shutter {
  double angle_deg = 0.0;
  bool centred = false;
};

// A time of a frame's exposure: fraction 0 is the shutter's opening, 1 its closing.
[[nodiscard]] CONTREJOUR_API double time_of_exposure(double frame, Shutter shutter, double fraction);

// The parameters at a time of a frame's exposure: numbers that change gradually are those of the time; steps, texts,
// whole numbers, the settings of detection and those of the shutter itself are those of the frame.
[[nodiscard]] CONTREJOUR_API params::Values parameters_during(const Animation& animation, double frame, double time);

// Whether a light that is on at a frame moves while the shutter is open.
[[nodiscard]] CONTREJOUR_API bool do_lights_move(const Animation& animation, double frame, Shutter shutter);

// The names of the lights that are on at a frame and have their position by direction, or in the frame.
[[nodiscard]] CONTREJOUR_API std::vector<std::string> names_of_lights_at(const Animation& animation, double frame,
                                                                         bool by_direction);

// A part of a frame's exposure, as fractions of it.
struct ExposurePart {
  double from = 0.0, to = 1.0;
};

// Adds the lights that are on at a frame to the values, as --light and --light-at. While the shutter is open a light
// takes a path, has the mean of its value, and the colour, size and distance of the middle of that time. part: that of
// the exposure; where it begins and ends at one time, so are the lights.
CONTREJOUR_API void add_lights_at(const Animation& animation, double frame, params::Values& values,
                                  Shutter shutter = {}, ExposurePart part = {});

// The first frame that has a key; 0 if there is none.
[[nodiscard]] CONTREJOUR_API int first_key(const Animation& animation);

}  // namespace contrejour
