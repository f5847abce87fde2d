// SPDX-License-Identifier: Apache-2.0
// The pupil and the point spread of one light of a document, as pictures: what the iris panel shows. The point spread
// is the image of a point in the light's place by diffraction, finer than the picture's pixels. Thread-safety: as
// LatestJob; the rest is pure.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"
#include "studio/core/latest_job.h"

namespace contrejour::studio {

inline constexpr int kPupilSide = 256, kSpreadSide = 256;  // pixels

struct PointSpreadOrder {
  params::Values values;
  std::shared_ptr<const LensState> lens;
  std::size_t light = 0;
};

struct PointSpreadAnswer {
  std::vector<std::uint32_t> pupil;  // kPupilSide^2, rows from the top; white passes light
  std::vector<std::uint32_t> spread;  // kSpreadSide^2: the logarithm of the level, six decades
  double open_fraction = 0;  // of the light's flux that dirt lets through
  double radius = 0;  // of the pupil as seen from the image, a cosine: 1 / (2 N) on the axis
  double width_um = 0;  // of the point spread's picture, on the sensor
  std::string error;
};

using PointSpreadJob = LatestJob<PointSpreadOrder, PointSpreadAnswer>;
[[nodiscard]] PointSpreadJob::Work point_spread_work();

// Pixels of half a wavelength times the f-number: the first dark ring of a round pupil has a diameter of five.
[[nodiscard]] double spread_pitch_mm(const LensState& lens);
// In the middle of a square of kSpreadSide pixels. Errors: there is no such light; those of rendering.
[[nodiscard]] Result<Image> point_spread(const PointSpreadOrder& order, const Context& context);
// Six decades from the brightest level down, as codes of sRGB.
[[nodiscard]] std::vector<std::uint32_t> logarithmic(const Image& rgb);

}  // namespace contrejour::studio
