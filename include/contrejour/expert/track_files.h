// SPDX-License-Identifier: Apache-2.0
// Tracks of other programs, and cameras with points in three dimensions -> lights with keys (animation.h).
// docs/formats/tracks.md states each format and its conventions.
// Errors: Parse with file, line and frame; Io; InvalidArgument for settings. Thread-safety: plain values and pure
// functions.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/animation.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

enum class TrackFormat { NukeTracker, Equalizer, SynthEyes, AfterEffects, Chan, Csv };

// In the order of the formats: the names that the command line has for them.
inline constexpr std::array<std::string_view, 6> kTrackFormatNames = {"nuke-tracker",  "3de",  "syntheyes",
                                                                      "after-effects", "chan", "csv"};

// The format of a file, by its name and beginning. Errors: Parse if it is like none of them.
[[nodiscard]] CONTREJOUR_API Result<TrackFormat> track_format(std::string_view text, const std::string& file);

struct TrackFileSettings {
  int width = 0, height = 0;  // of the picture that was tracked, in pixels
  int frame_offset = 0;       // added to the file's numbers of frames; up to 1e8 either way, here and below
};

struct TrackKey {
  int frame = 0;
  Vec2 uv;  // 0,0 the top left corner of the picture, 1,1 the bottom right
};

struct PointTrack {
  std::string name;
  std::vector<TrackKey> keys;  // in rising order, at least one
  bool is_sampled = false;  // in each frame: it is not visible in frames without a key. Else keys are interpolated.
};

// Any format but Chan. No two tracks have the same name.
[[nodiscard]] CONTREJOUR_API Result<std::vector<PointTrack>> read_tracks(std::string_view text, const std::string& file,
                                                                         TrackFormat format,
                                                                         const TrackFileSettings& settings);

// A light for each track, off in frames in which it is not visible. value: as on the command line; empty: none.
[[nodiscard]] CONTREJOUR_API Result<Animation> animation_of_points(std::span<const PointTrack> tracks,
                                                                   const std::string& value);

// In world units and degrees, as Nuke has them: y up; the camera looks along -z and has x to its right.
struct CameraPose {
  int frame = 0;
  Vec3 position;
  Vec3 rotation_deg;
  std::optional<double> vertical_fov_deg;
};

// A frame for each line, without holes.
[[nodiscard]] CONTREJOUR_API Result<std::vector<CameraPose>> read_chan(std::string_view text, const std::string& file,
                                                                       int frame_offset = 0);

struct WorldPoint {
  struct At {
    int frame = 0;
    Vec3 position;
  };
  std::string name;
  std::vector<At> keys;  // in rising order, at least one
  bool moves = false;  // else its only key holds for all frames
};

[[nodiscard]] CONTREJOUR_API Result<std::vector<WorldPoint>> read_world_points(std::string_view text,
                                                                               const std::string& file,
                                                                               int frame_offset = 0);

struct WorldSettings {
  int width = 0, height = 0;  // of the frame, whose pixels are square
  std::string rotation_order = "ZXY";  // the axis that is rotated about first comes first
  std::optional<double> unit_mm;  // of the world's unit; without it the lights are at infinity
  std::string value;  // of all lights, as on the command line; empty: none
};

struct WorldLights {
  Animation animation;  // directions and distances; hfov, if the camera has a field of view
  std::vector<std::string> never_seen;  // points that are never in front of the camera
};

// Errors: InvalidArgument that names the frame in which a moving point has no position; a rotation order that is none.
[[nodiscard]] CONTREJOUR_API Result<WorldLights> lights_of_world(std::span<const CameraPose> camera,
                                                                 std::span<const WorldPoint> points,
                                                                 const WorldSettings& settings);

// The whole text of such a file, in UTF-8. Errors: Io, Parse if it is larger than 64 MB.
[[nodiscard]] CONTREJOUR_API Result<std::string> read_track_text(const std::filesystem::path& file);

}  // namespace contrejour
