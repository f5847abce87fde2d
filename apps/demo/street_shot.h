// SPDX-License-Identifier: Apache-2.0
// A moving shot of the street, for tests of sequences: the camera walks, pans, tilts and shakes; poles pass in front of
// lamps; a car turns and its headlights sweep across the camera; two lights cross. Each frame is made by formulas from
// the seed, the same on every machine up to rounding, and the true position and flux of every light are known.
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/animation.h"
#include "contrejour/image.h"
#include "demo/street_camera.h"
#include "demo/street_scene.h"

namespace contrejour::demo {

struct ShotSettings {
  int width = 1280, height = 720;
  int frame_count = 96;  // over which the same shot is spread: fewer frames are farther apart
  int seed = 1;  // of the camera's shake, the noise and the grain
  bool noise = true;
  double hfov_rad = 0.5;
};

struct ShotLight {
  std::string name;
  Lamp lamp;
  bool in_haze = true;  // false: beyond it
};

// The camera and the lights at one time of the shot.
struct ShotMoment {
  CameraPose camera;
  std::vector<ShotLight> lights;  // the same ones in the same order at all times
};

[[nodiscard]] std::vector<Pole> shot_poles();
[[nodiscard]] ShotMoment shot_moment(const ShotSettings& settings, int frame);  // frame: from 0

// A light in a frame, as a perfect detector would measure it.
struct TrueLight {
  Vec2 position_px;
  Rgb flux{};  // the sum of its pixels, without noise
  bool is_in_picture = false;
};

struct ShotFrame {
  Image image;
  std::vector<TrueLight> lights;  // one for each of the moment's
};

[[nodiscard]] ShotFrame make_frame(const ShotSettings& settings, int frame);

// The true lights as a file for `apply --lights`; frames are numbered from `first`.
[[nodiscard]] Animation true_animation(const ShotSettings& settings, const std::vector<std::vector<TrueLight>>& frames,
                                       int first);

}  // namespace contrejour::demo
