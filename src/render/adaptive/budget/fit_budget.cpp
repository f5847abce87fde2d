// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/fit_budget.h"

#include <cmath>

namespace contrejour::inline internal::adaptive {
namespace {

// Interpolation over wavelengths (FirstRaysOptions): the fraction of the tolerance that it may use, as the error of
// fits is added to it, and the largest error of a transmittance's distribution over the ghost.
constexpr double kPredictedFraction = 0.5, kMaxTint = 0.03;

}  // namespace

FirstRays first_rays_within(const ErrorBudget& budget, GhostTracers& tracers, const WavelengthSamples& samples,
                            const Rectangle& box, const Frame& frame) {
  const ToleranceOf tolerance_of = [&](const LobattoRays& ray_set, double weight, double shared_flux) {
    return tolerance_for(ray_set, weight, shared_flux, frame, budget);
  };
  // Without an error limit single precision is accurate enough.
  const auto precision = std::isfinite(budget.squared_error) ? PacketPrecision::Double : PacketPrecision::Float;
  return first_rays(tracers, samples, box, tolerance_of,
                    {kMinNodes, precision, frame.pixel_pitch_mm, kPredictedFraction, kMaxTint});
}

}  // namespace contrejour::inline internal::adaptive
