// SPDX-License-Identifier: Apache-2.0
// The stations of a sweep of a known lens: their pictures, and the same pictures drawn through the lens, ghost by
// ghost. Thread-safety: pure functions.
#pragma once

#include <vector>

#include "contrejour/expert/flare_layers.h"
#include "contrejour/expert/learn_lens.h"
#include "contrejour/frame.h"
#include "contrejour/light.h"
#include "measure/fit/stations.h"

namespace contrejour::inline internal {

struct LensStations {
  SweepStations pictures;  // reduced, in units of the light
  Vec2 centre_px;          // of the reduced pictures: where the optical axis meets them
  double pixel_pitch_mm = 0;  // of the reduced pictures
  double full_pitch_mm = 0;   // of the pictures as they came
  double source_radius_px = 0;  // of the light's image
  double source_radius_rad = 0;
  bool is_mosaic = false;  // red and blue are interpolated
  Spectrum spectrum = IlluminantD65{};
  ColourSpace space = ColourSpace::Rec709;  // of the pictures, and of those that are drawn
};

[[nodiscard]] Result<LensStations> lens_stations(const LensPhotographs& photographs, const LensState& lens,
                                                 int max_width, const Context& context);

// The same stations with their pictures in ACEScg, in which the negative weights of wavelengths sum to at most 7 per
// cent of a channel (in Rec.709, 48): the mean of a reflectance then has a logarithm. A pixel counts if all its
// channels are known.
[[nodiscard]] LensStations in_acescg(LensStations stations);

// The radius about the light's image that no fit uses.
[[nodiscard]] double masked_px(const LensStations& stations);

// The pixels of the reduced pictures on the sensor.
[[nodiscard]] Frame frame_of(const LensStations& stations, Vec2 centre_px);

// The light of a station, from where its image lies: without the errors of the head's angle.
[[nodiscard]] Light light_of(const LensStations& stations, std::size_t k, const LensState& lens, const Frame& frame);

// A part of a picture, of three channels, whose top left corner lies at (left, top). Without pixels: dark.
struct Patch {
  int left = 0, top = 0;
  Image image;
};

// A picture for each of these ghosts at a station, in their order, and one of all others, relative to the light.
[[nodiscard]] Result<std::vector<Patch>> ghost_patches(const LensStations& stations, std::size_t k,
                                                       const LensState& lens, const Frame& frame,
                                                       const std::vector<Ghost>& ghosts, const Context& context);

}  // namespace contrejour::inline internal
