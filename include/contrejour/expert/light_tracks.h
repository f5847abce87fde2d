// SPDX-License-Identifier: Apache-2.0
// Lights that were detected in each frame of a shot (light_detection.h) -> lights with an identity over time, and these
// as keys of a file (animation.h). docs/sequences.md describes what is done.
// A light is expected where its velocity takes it, at first as the shot followed backwards shows it; lights and
// detections are then paired so that the sum of all pairs' likelihoods is largest, by position, flux, colour and size.
// Lights whose areas meet share one detection, lights that something thin divides take several, and a light that is
// hidden for a few frames keeps its name. Deterministic. Thread-safety: plain values and pure functions.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/expert/animation.h"
#include "contrejour/expert/light_detection.h"
#include "contrejour/export.h"
#include "contrejour/image_io.h"

namespace contrejour {

// Pixels are those of the display window, whose top left corner is (0, 0).
struct FrameLights {
  int frame = 0;
  PixelRegion picture;  // the pixels that the file has: its data window
  std::vector<DetectedLight> lights;
};

// A detection in the data window of a picture.
[[nodiscard]] CONTREJOUR_API FrameLights frame_lights(int frame, const Detection& found, const PixelWindow& data,
                                                      const PixelWindow& display);

// The threshold for all frames of a shot, since one that follows each frame would make fluxes jump: the median of some
// frames' automatic thresholds, those without a light left out. None: no frame has a light.
[[nodiscard]] CONTREJOUR_API std::optional<double> shot_threshold(std::span<const Threshold> thresholds);

struct TrackingSettings {
  double search_px = 64;  // > 0; how far a light of unknown velocity may move from frame to frame
  int max_gap = 5;  // frames that a light may be hidden for; it is another light afterwards
  int min_frames = 2;  // lights that are seen in fewer frames are left out, as noise
};

struct TrackPoint {
  int frame = 0;
  Vec2 position_px;
  Rgb flux{};
  double radius_px = 0;  // root mean square
};

// A light in the frames that it is seen in, in rising order.
struct LightTrack {
  std::vector<TrackPoint> points;
  bool begins_apart = true;  // false: it begins by leaving the area of another light, whose flux it then takes over
};

// Frames are in rising order; numbers may be left out. Tracks are in the order of their first frames.
[[nodiscard]] CONTREJOUR_API std::vector<LightTrack> track_lights(std::span<const FrameLights> frames,
                                                                  const TrackingSettings& settings = {});

struct TrackKeySettings {
  int width = 0, height = 0;  // of the display window
  int max_lights = 64;  // those with the largest flux at any time
  int fade_frames = 2;  // in which a light appears before the frame it is first seen in, and disappears likewise
  double position_tolerance_px = 0.05;  // what leaving out keys may change a position by
  double value_tolerance = 0.01;  // and a value, relative to the value or a twentieth of the light's largest
  std::optional<double> pixel_deg;  // gives the lights a size: the angle of a pixel in the middle of the frame
};

// Keys in the frames of the shot, which are in rising order: positions as u, v, values as fluxes; "on" is off where the
// light is neither seen nor fading. Detection is switched off (the parameter "detect"), since these are its lights.
// Outside the frames that it is seen in, a light moves on at its velocity. Nothing fades at the ends of the shot.
[[nodiscard]] CONTREJOUR_API Animation animation_of_tracks(std::span<const LightTrack> tracks,
                                                           std::span<const int> frames,
                                                           const TrackKeySettings& settings);

}  // namespace contrejour
