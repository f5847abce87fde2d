// SPDX-License-Identifier: Apache-2.0
// Any bytes as a file of tracks in each format, as a camera and as points: an error, or lights that are written and
// read the same.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/decode_text.h"
#include "contrejour/expert/track_files.h"

namespace {

using namespace contrejour;

void check_lights(const Animation& animation) {
  const auto again = read_animation(write_animation(animation), "again.toml");
  if (!again || *again != animation) std::abort();
  params::Values values;
  add_lights_at(animation, first_key(animation), values);
}

void check_tracks(std::string_view text) {
  for (const auto format : {TrackFormat::NukeTracker, TrackFormat::Equalizer, TrackFormat::SynthEyes,
                            TrackFormat::AfterEffects, TrackFormat::Csv}) {
    const auto tracks = read_tracks(text, "fuzz.txt", format, {1920, 1080, 1000});
    if (!tracks) continue;
    for (const PointTrack& track : *tracks)
      for (std::size_t k = 0; k < track.keys.size(); ++k)
        if (!std::isfinite(track.keys[k].uv.x + track.keys[k].uv.y) ||
            (k > 0 && track.keys[k].frame <= track.keys[k - 1].frame))
          std::abort();
    check_lights(animation_of_points(*tracks, "5000").value());
  }
}

void check_world(std::string_view text) {
  const WorldSettings settings{1920, 1080, "ZXY", 1000.0, "5000"};
  const auto camera = read_chan(text, "fuzz.chan");
  const auto points = read_world_points(text, "fuzz.csv");
  const WorldPoint point{"lamp", {{0, {1.0, 2.0, -10.0}}}, false};
  const CameraPose pose{1, {0.5, 0.0, 3.0}, {10.0, 20.0, 30.0}, 40.0};
  if (camera)
    if (const auto lights = lights_of_world(*camera, std::span(&point, 1), settings)) check_lights(lights->animation);
  if (points)
    if (const auto lights = lights_of_world(std::span(&pose, 1), *points, settings)) check_lights(lights->animation);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = decode_text(std::string_view(reinterpret_cast<const char*>(data), size));
  (void)track_format(text, "fuzz.txt");
  check_tracks(text);
  check_world(text);
  return 0;
}
