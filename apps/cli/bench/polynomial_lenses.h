// SPDX-License-Identifier: Apache-2.0
// Whole-field fits of the lenses of bodonyi2023, against what they must reach: errors of rays that no fit has used,
// times, files, and pictures beside those of `reference` and `adaptive`. At each lens's f-number of that paper and wide
// open, from one fit.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/bench/scene.h"
#include "cli/console.h"
#include "contrejour/context.h"
#include "contrejour/expert/polynomial.h"

namespace contrejour::cli {

inline constexpr const char* kLensFitsTable = "lenses";
inline constexpr const char* kLensPicturesTable = "lens-pictures";

struct PolynomialLensOptions {
  bool fits = false, pictures = false;  // the tables that are wanted
  std::vector<std::string> systems;  // keys of paper_systems(); empty: all
  std::string cache = {};  // folder of the reference's pictures; may be empty
  params::Values values;  // of scenes and methods, the size of pictures among them
};

// Errors of rays at random places of the field, wavelengths and pupil points, by the scalar tracer. Rays count that get
// through and land on the sensor or next to it.
struct LensFitErrors {
  double f_number = 0.0;
  double median_px = 0.0;  // of the ghosts' 95th percentiles of the error on the sensor, in its width / 1920
  double weighted_px = 0.0;  // their mean, weighted by the fluxes of the ghosts' fitted zones, wide open
  double weighted_transmittance = 0.0, worst_transmittance = 0.0;  // of 95th percentiles, relative to the largest value
  int rays = 0;
};

struct LensFit {
  const PaperSystem* system = nullptr;
  std::shared_ptr<const LensPolynomials> fit;
  double processor_s = 0.0, clock_s = 0.0;
  std::size_t bytes = 0;  // of the file
  int threads = 0;
  std::vector<LensFitErrors> errors;  // at the paper's f-number, and wide open
};

struct LensPicture {
  const PaperSystem* system = nullptr;
  double f_number = 0.0;
  int width = 0, height = 0;
  std::optional<double> adaptive_db, polynomial_db;  // against `reference`; none: equal
  double adaptive_flux = 1.0, polynomial_flux = 1.0;  // over the reference's, of the channel that differs most
  double traced_flux = 0.0;  // fraction of the light in the frame whose ghosts the fit leaves to the tracer
};

struct PolynomialLenses {
  std::vector<LensFit> fits;
  std::vector<LensPicture> pictures;
};

[[nodiscard]] Result<PolynomialLenses> measure_polynomial_lenses(const PolynomialLensOptions& options,
                                                                 const Context& context);

// The errors of a fit with the stop's radius of a lens's state.
[[nodiscard]] LensFitErrors errors_of_fit(const LensPolynomials& fit, const LensState& lens);

[[nodiscard]] std::string polynomial_lenses_text(const PolynomialLenses& lenses);
[[nodiscard]] Json polynomial_lenses_json(const PolynomialLenses& lenses);

}  // namespace contrejour::cli
