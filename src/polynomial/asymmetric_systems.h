// SPDX-License-Identifier: Apache-2.0
// Least squares of the outputs of a zone without axial symmetry, at one degree.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "polynomial/asymmetric_basis.h"
#include "polynomial/fit_rays.h"
#include "polynomial/least_squares.h"

namespace contrejour::inline internal::polynomial {

// An output's value at a wavelength of the fit and a ray.
using RayValue = std::function<double(std::size_t wavelength, std::size_t ray)>;

// Each system is made when an output of its weights of rays and its parities is first fitted.
class AsymmetricSystems {
 public:
  // points: of the fit's rays, which must outlive it.
  AsymmetricSystems(int degree, const std::vector<AsymmetricPoint>& points) : degree_(degree), points_(points) {}

  // The polynomial that fits values of rays best; none if there are too few rays. weighted: must outlive it.
  // wavelength_step, negligible: as for OutputFit.
  [[nodiscard]] std::optional<ChebyshevSum> fit(const WeightedRays& weighted, const Parities& parities,
                                                int wavelength_step, const RayValue& value, double negligible);

 private:
  struct One {
    const WeightedRays* weighted = nullptr;
    Parities parities;
    std::size_t terms = 0;
    std::vector<std::size_t> rows;  // of the weighted rays
    std::optional<LeastSquares> squares;
  };

  const One& system(const WeightedRays& weighted, const Parities& parities);

  int degree_;
  const std::vector<AsymmetricPoint>& points_;
  std::vector<std::unique_ptr<One>> made_;
};

}  // namespace contrejour::inline internal::polynomial
