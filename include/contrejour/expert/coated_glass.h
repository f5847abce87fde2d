// SPDX-License-Identifier: Apache-2.0
// A coating on a glass in air, in bulk: reflectances by wavelength and angle, the films that a design has on the glass,
// and films refined towards target reflectances. Exact as coating.h; the optimum of a refinement is local.
// Errors: InvalidArgument for arrays of different lengths, for wavelengths, angles and targets out of range, and for
// coatings without films where films are needed. Thread-safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/coating.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

// For unpolarised light from air at angles of incidence from 0 to pi / 2; element k has wavelength k and angle k.
[[nodiscard]] CONTREJOUR_API Result<std::vector<double>> coated_reflectances(const Coating& coating, const Glass& glass,
                                                                             std::span<const double> lambda_nm,
                                                                             std::span<const double> angle_rad);
[[nodiscard]] CONTREJOUR_API Result<std::vector<double>> coated_transmittances(const Coating& coating,
                                                                               const Glass& glass,
                                                                               std::span<const double> lambda_nm,
                                                                               std::span<const double> angle_rad);

// The films, from air to glass: of a stack, of a design, of a quarter wave.
[[nodiscard]] CONTREJOUR_API Result<FilmStack> films_on(const Coating& coating, const Glass& glass);

// These films with thicknesses that minimise the sum of (weight (R - target))^2 at normal incidence. No weights: all 1.
[[nodiscard]] CONTREJOUR_API Result<FilmStack> refined_to_targets(const Coating& start, const Glass& glass,
                                                                  std::span<const double> lambda_nm,
                                                                  std::span<const double> target,
                                                                  std::span<const double> weight = {});

}  // namespace contrejour
