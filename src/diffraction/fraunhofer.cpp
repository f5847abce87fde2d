// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/fraunhofer.h"

#include <cmath>
#include <complex>

#include <fmt/format.h>

#include "base/tasks.h"
#include "base/units.h"
#include "diffraction/chirp_z.h"

namespace contrejour {
namespace {

constexpr int kMaxPoints = 16384;

}  // namespace

Result<FraunhoferPattern> fraunhofer_pattern(const PupilMask& mask, const FraunhoferSettings& settings,
                                             const Context& context) {
  for (const double length : {settings.distance_mm, settings.lambda_nm, settings.grid.pitch_mm, mask.grid.pitch_mm})
    if (!(length > 0.0) || !std::isfinite(length))
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("a pattern's distance, wavelength and pitches must be positive, not {}", length));
  if (settings.grid.side < 1 || settings.grid.side > kMaxPoints)
    return failure(
        ErrorCode::InvalidArgument,
        fmt::format("a pattern of {} points a side is out of range; choose 1 to {}", settings.grid.side, kMaxPoints));
  const double open_mm2 = mask.is_complete() ? mask.open_area_mm2() : 0.0;
  if (!(open_mm2 > 0.0) || !std::isfinite(open_mm2 * settings.flux))
    return failure(ErrorCode::InvalidArgument, "a mask that lets nothing through has no pattern");
  Context steps = context;  // without progress: the transform makes two passes, each of which would report from 0
  steps.progress = {};
  const double lambda_d_mm2 = mm_from_nm(settings.lambda_nm) * settings.distance_mm;
  const auto samples = static_cast<std::size_t>(mask.grid.side);
  const auto points = static_cast<std::size_t>(settings.grid.side);
  const ChirpZ transform(centred_points(samples, mask.grid.pitch_mm),
                         centred_points(points, settings.grid.pitch_mm / lambda_d_mm2));
  std::vector<std::complex<double>> wave(samples * samples);
  for (std::size_t k = 0; k < wave.size(); ++k) wave[k] = mask.at(k);
  wave = transform.transform_2d(wave, steps);
  if (context.cancelled()) return interrupted();
  FraunhoferPattern pattern{settings.grid, {}};

  // Goodman 2005 eq. 4-25: E = |integral of U exp(-2 pi i x.xi / (lambda d))|^2 / (lambda d)^2, whose integral is that
  // of |U|^2 (Parseval).
  const double sample_mm2 = mask.grid.pitch_mm * mask.grid.pitch_mm;
  const double scale = settings.flux * sample_mm2 * sample_mm2 / (lambda_d_mm2 * lambda_d_mm2 * open_mm2);
  pattern.irradiance_per_mm2.resize(wave.size());
  for (std::size_t k = 0; k < wave.size(); ++k) pattern.irradiance_per_mm2[k] = scale * std::norm(wave[k]);
  return pattern;
}

}  // namespace contrejour
