// SPDX-License-Identifier: Apache-2.0
// From exposures of a camera to one picture of high dynamic range with its variance; and a camera to test with, which
// makes such exposures of a known picture.
// Units: raw values in DN; merged pixels are rates in DN per second, from Bayer blocks of 2 x 2 (no demosaicing), so a
// merged picture has half the size. Errors: InvalidArgument, Cancelled. Thread-safety: pure functions; the same bits
// for any number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

enum class BayerPattern { Rggb, Bggr, Grbg, Gbrg };  // rows of a block from the top, left to right

// One exposure as the sensor delivers it.
struct RawFrame {
  int width = 0, height = 0;  // even
  BayerPattern pattern = BayerPattern::Rggb;
  double black_dn = 0, white_dn = 0;  // levels of no light and of saturation
  double time_s = 0;
  std::vector<std::uint16_t> dn;  // row by row from the top
};

// The sensor's noise: photons (Poisson) and reading (normal), at one sensitivity.
struct SensorNoise {
  double electrons_per_dn = 0.5;
  double read_electrons = 3.0;
};

struct SensorModel {
  SensorNoise noise;
  BayerPattern pattern = BayerPattern::Rggb;
  double black_dn = 512.0, white_dn = 16383.0;  // of 14 bits
};

// Exposes an RGB picture of rates in DN per second, of even width and height. seed: of the noise; a pixel's noise
// depends on the seed and its position only.
[[nodiscard]] CONTREJOUR_API Result<RawFrame> expose(const Image& rate, const SensorModel& sensor, double time_s,
                                                     std::uint64_t seed, const Context& context = {});

// A rectangle of raw pixels that sees the source steadily, for example a white patch beside the camera.
struct MonitorPatch {
  int x = 0, y = 0, width = 0, height = 0;
  double rate = 0;  // its mean rate when the source is as it should be, DN per second
};

struct MergeSettings {
  SensorNoise noise;
  double saturated = 0.9;  // of the range from black to white: from there on, a value and its neighbours are dropped
  double max_disagreement = 0.03;  // between exposures; an exposure that is farther off is left out
  std::optional<MonitorPatch> monitor;  // each exposure is divided by its level there
};

struct CapturedImage {
  Image rate;      // three channels
  Image variance;  // of each, > 0
  Image valid;     // 1, or 0 where every exposure is saturated: rate is then a lower bound
  std::vector<std::string> warnings;
  // The mosaic of the exposures: red and blue pixels lie beside the middle of a block. None: the channels lie on one
  // another.
  std::optional<BayerPattern> pattern = std::nullopt;
};

// Merges exposures of different times of one scene by inverse variances. background: exposures with the light blocked
// or the lens covered; those of the same time as an exposure are averaged and subtracted, else the black level is.
// Errors: InvalidArgument for no exposure, frames that differ in size or pattern or have no range, a patch outside.
[[nodiscard]] CONTREJOUR_API Result<CapturedImage> merge_exposures(std::span<const RawFrame> exposures,
                                                                   std::span<const RawFrame> background,
                                                                   const MergeSettings& settings = {},
                                                                   const Context& context = {});

}  // namespace contrejour
