// SPDX-License-Identifier: Apache-2.0
// Bright areas of a scene-linear photograph -> lights: connected areas (8 neighbours) above a threshold.
// A pixel's level is its largest channel; its weight rises from 0 at the threshold to 1 at threshold * (1 + softness),
// so a light that brightens frame by frame fades in (docs/formats/images.md). NaN, infinite and negative samples count
// as 0, and pixels above max_value are scaled down to that level, in their colour. Deterministic; O(pixels).
// Thread-safety: pure.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

// Pixels [x0, x1) x [y0, y1).
struct PixelRegion {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct DetectionSettings {
  std::optional<double> threshold;  // level, scene-linear; none: automatic_threshold
  double softness = 0.25;           // >= 0; 0 makes the threshold hard
  int max_lights = 32;              // >= 1; the rest is merged into the nearest of these
  int min_pixels = 1;               // smaller areas (hot pixels) are no lights
  double max_value = kMaxLevel;    // > 0, at most kMaxLevel: upper limit of a pixel's level
  std::vector<PixelRegion> regions;  // only within these; none: everywhere

  // Above every real light: the sun's disc is 1.6e9 cd/m^2.
  static constexpr double kMaxLevel = 1e10;
};

struct DetectedLight {
  Vec2 centroid_px;          // flux-weighted; the top-left pixel's centre is (0.5, 0.5)
  Rgb flux{};                // sum of weight * value over the area's pixels
  double rms_radius_px = 0;  // flux-weighted, about the centroid; of a single pixel sqrt(1/6)
  int min_x = 0, min_y = 0, max_x = 0, max_y = 0;  // pixels, inclusive
  std::int64_t pixel_count = 0;
  double peak = 0;       // largest level in the picture, not limited
  int merged_areas = 1;  // how many areas this light stands for
  std::vector<int> areas;  // indices into Detection::areas
};

// How a threshold was found.
enum class ThresholdSource {
  Given,
  Gap,        // the gap in level between lit surfaces and light sources
  Clipped,    // the picture ends at white, as those of 8 bits do
  Brightest,  // no gap, as with a window or the sky: everything within two stops of the brightest
  Region,     // the same within the regions, if nothing in them exceeds the whole picture's threshold
  None,       // no light: nothing is much brighter than the rest, or than white
};

struct Threshold {
  double level = 0;
  ThresholdSource source = ThresholdSource::None;
};

struct Detection {
  double threshold = 0;               // the one used
  ThresholdSource source = ThresholdSource::Given;
  double brightest = 0;               // level, within the regions
  Vec2 brightest_px;                  // the middle of the first such pixel
  double softness = 0.25;             // as in the settings
  std::vector<DetectedLight> lights;  // by flux (r + g + b), largest first
  int areas_found = 0;                // before merging
  double max_value = DetectionSettings::kMaxLevel;  // as in the settings
  std::int64_t capped_pixels = 0;     // pixels of areas that exceed it
  std::vector<DetectedLight> areas;   // all, in the order of their first pixels, those too small to be lights too
  std::vector<std::int32_t> area_of_pixel;  // rows from the top; -1: none
};

// Errors: InvalidArgument (not three channels, settings out of range).
[[nodiscard]] CONTREJOUR_API Result<Detection> detect_lights(const Image& rgb, const DetectionSettings& settings = {});

// The matte: the weight that detect_lights gave each pixel, 0..1, one channel. Areas that are too small to be lights
// count too. Empty for a detection in an image of another size.
[[nodiscard]] CONTREJOUR_API Image light_matte(const Image& rgb, const Detection& detection);

// The part of the picture that contains a light's areas: weight * value in each of their pixels and 0 elsewhere, three
// channels. Its pixel (0, 0) is the picture's (min_x, min_y). Empty for a detection in an image of another size.
[[nodiscard]] CONTREJOUR_API Image picture_of_areas(const Image& rgb, const Detection& detection,
                                                    const DetectedLight& light);

// The level above which a pixel belongs to a light and not to a lit surface, from the picture's own statistics
// (docs/formats/images.md). Nothing is above it where the source is None.
[[nodiscard]] CONTREJOUR_API Threshold automatic_threshold(const Image& rgb);

}  // namespace contrejour
