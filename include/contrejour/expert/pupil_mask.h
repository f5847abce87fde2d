// SPDX-License-Identifier: Apache-2.0
// The transmission of a pupil for a wave: amplitude, and phase where it matters, on a square of samples.
// Rows from the top as in an image; x right, y up as the photographer sees the stop; the axis in the square's middle.
// Units: mm, radians. Accuracy: a straight edge covers the exact fraction of a sample. Errors: say what is wrong with a
// picture. Thread-safety: plain values.
#pragma once

#include <complex>
#include <functional>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/iris.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

struct MaskGrid {
  static constexpr int kMaxSamples = 16384;  // a side

  int side = 512;  // samples
  double pitch_mm = 0.01;

  [[nodiscard]] bool is_usable() const { return side >= 1 && side <= kMaxSamples && pitch_mm > 0.0 && pitch_mm < 1e6; }
  [[nodiscard]] Vec2 position_mm(int column, int row) const {
    return {(column + 0.5 - 0.5 * side) * pitch_mm, (0.5 * side - 0.5 - row) * pitch_mm};
  }
};

// The smallest grid that contains a circle of this radius with `samples_across` samples across it; without samples for
// invalid arguments or a side above kMaxSamples.
[[nodiscard]] CONTREJOUR_API MaskGrid grid_over(double radius_mm, int samples_across);

struct CONTREJOUR_API PupilMask {
  MaskGrid grid;
  std::vector<float> amplitude;  // [row * side + column], 0..1: the square root of the transmission
  std::vector<float> phase_rad;  // as many, or empty: flat

  // True if there are samples for all of the grid; an incomplete mask is treated as opaque.
  [[nodiscard]] bool is_complete() const {
    const auto samples = static_cast<std::size_t>(grid.side) * static_cast<std::size_t>(grid.side);
    return grid.is_usable() && amplitude.size() == samples && (real() || phase_rad.size() == samples);
  }
  [[nodiscard]] bool real() const { return phase_rad.empty(); }
  [[nodiscard]] std::complex<double> at(std::size_t sample) const {
    return real() ? std::complex<double>(amplitude[sample]) : std::polar<double>(amplitude[sample], phase_rad[sample]);
  }
  [[nodiscard]] double open_area_mm2() const;  // integral of amplitude squared
};

// Makes a mask from a signed distance in mm, negative where light passes: each sample is the open fraction of its area.
// Empty for an invalid grid.
[[nodiscard]] CONTREJOUR_API PupilMask make_mask(const MaskGrid& grid,
                                                 const std::function<double(Vec2 mm)>& distance_mm,
                                                 const Context& context = {});
[[nodiscard]] CONTREJOUR_API PupilMask make_mask(const MaskGrid& grid, const IrisOpening& opening,
                                                 double stop_radius_mm, const Context& context = {});

// One channel of a picture as amplitude, over a square as wide as the picture's longer side; black outside the picture.
// Errors: no such channel, values that are negative or not finite.
[[nodiscard]] CONTREJOUR_API Result<PupilMask> mask_of_image(const Image& image, int channel, double width_mm);

// Dust and scratches: the mask times one channel of a picture laid over its square (hullin2011 5). Errors as above.
[[nodiscard]] CONTREJOUR_API Result<PupilMask> with_dirt(PupilMask mask, const Image& dirt, int channel);

// The power transmittance of each sample of a mask, in addition to its amplitude: a sample that a speck covers in part
// transmits more power than the square of its mean amplitude; the difference is diffracted to larger angles.
using MaskPower = std::vector<float>;  // [row * side + column], 0..1, initially 1 everywhere

// Multiplies polygons with a transmittance into a mask, with exact coverage; corners are in mm of the mask's plane.
struct DimPolygon {
  std::vector<Vec2> corners_mm;  // any orientation, no crossings
  double transmission = 0;
};
CONTREJOUR_API void dim(PupilMask& mask, MaskPower& power, std::span<const DimPolygon> polygons);

}  // namespace contrejour
