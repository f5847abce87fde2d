// SPDX-License-Identifier: Apache-2.0
// All stations of a sweep against one flare: residuals in standard deviations under Huber's loss, and their normal
// equations with analytic derivatives. Memory: one station's pixels for each thread.
// Thread-safety: const functions may be called at once; sums are the same bits for any number of threads.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/image.h"
#include "measure/fit/ghost_pixels.h"
#include "measure/fit/levenberg_marquardt.h"
#include "measure/fit/parameter_layout.h"

namespace contrejour::inline internal {

struct FitStation {
  double s = 0;  // >= 0
  StationFrame frame;
  Image rate;    // three channels; at saturated pixels the least value
  Image weight;  // inverse variances; 0: not to be fitted
};

// Moves the optical centre along the picture's rows, by a tangent; the light's angle changes, too.
void move_centre(FitStation& station, double centre_shift);

// A flare's picture as the fit computes it.
[[nodiscard]] Image model_image(const MeasuredFlare& flare, const FitStation& station);

struct FlareProblem {
  FlareProblem(std::span<const FitStation> all, MeasuredFlare model)
      : stations(all), flare(std::move(model)), layout(flare) {}

  std::span<const FitStation> stations;
  MeasuredFlare flare;  // ranges and parities; its coefficients are the unknowns
  ParameterLayout layout;
  // Slopes are barely determined where a fade is narrow: each counts as measured once, as it was, with this error.
  double slope_error = 3.0;
  double huber = 3.0;       // standard deviations from which residuals count linearly
  // The light's images alone determine the optical centre badly along their path; ghosts are symmetric about it. If
  // set, there is one more unknown, the last: the centre's shift as a tangent.
  bool with_centre = false;
  Context context;

  [[nodiscard]] double cost(const Eigen::VectorXd& unknowns) const;
  [[nodiscard]] NormalEquations equations(const Eigen::VectorXd& unknowns) const;
};

}  // namespace contrejour::inline internal
