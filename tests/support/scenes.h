// SPDX-License-Identifier: Apache-2.0
// Lenses, lights and frames that many tests share.
#pragma once

#include <numeric>
#include <span>

#include <doctest/doctest.h>

#include "support/csv_lens.h"
#include "support/settings.h"

namespace contrejour::test {

inline LensState bundled(const char* name, const LensSettings& settings = {}) {
  const auto lens = find_lens(name);
  REQUIRE(lens.has_value());
  const auto state = configure_lens(*lens, settings);
  REQUIRE(state.has_value());
  return *state;
}

// A bare plate of n = 1.5 behind a stop of 3 mm radius, with the sensor 10 mm from the stop. It has one ghost, (2, 3),
// an exact copy of the stop at R^2 of the direct light.
inline LensState plate() {
  Prescription lens;
  lens.surfaces = {{SurfaceKind::Stop, 0.0, 1.0, 20.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 0.0, 2.0, 30.0, {"", ConstantIndex{1.5}}, {}, 0},
                   {SurfaceKind::Refracting, 0.0, 0.0, 30.0, air(), {}, 0}};
  LensState state = configured(lens, 3.0);
  state.sensor_z_mm = 10.0;
  state.focal_length_mm = 50.0;  // arbitrary but finite: places lights outside the frame
  return state;
}

inline Light light_at(const LensState& lens, const Frame& frame, Vec2 uv) {
  Light light;
  light.direction = direction_for_image_point(lens, frame.sensor_from_uv(uv), lens.design_wavelength_nm);
  return light;
}

// One wavelength, so that all three channels are equal; the papers' ghosts, which take half the time of all.
inline Settings green(const Frame& frame) {
  Settings settings;
  settings.scope = GhostScope::OneSideOfStop;
  settings.frame = frame;
  settings.lambda_nm = {550.0};
  return settings;
}

inline Settings settings_for(const LensState& lens, int width, int height, int grid) {
  Settings settings = green(frame_on_sensor(lens, width, height));
  settings.set_grid(grid);
  return settings;
}

inline double sum(const Image& image) { return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0); }

}  // namespace contrejour::test
