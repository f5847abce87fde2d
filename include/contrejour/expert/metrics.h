// SPDX-License-Identifier: Apache-2.0
// The difference of image B from image A.
// Samples that are NaN or infinite are left out of the peak, the sums and max_abs_error; where A and B differ in
// them (not both NaN, nor the same infinity) the sample counts as an error of one peak and is counted.
// Errors: InvalidArgument when the sizes or channels differ or are empty. Thread-safety: pure.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

struct Comparison {
  // 10 log10(P^2 / mean square error), both clipped at P and -P; none when then equal.
  std::optional<double> psnr_db;
  double peak = 0;                  // P: A's 99.9th percentile over pixels and channels; if 0, A's largest, then B's
  double max_abs_error = 0;         // before clipping
  std::vector<double> flux_ratio;   // per channel, sum of B over sum of A; 1 when both are 0
  std::uint64_t non_finite_mismatches = 0;
};

[[nodiscard]] CONTREJOUR_API Result<Comparison> compare(const Image& a, const Image& b);

// Quantile q (0..1) of the finite samples, between neighbours by linear interpolation; 0 if there are none.
[[nodiscard]] CONTREJOUR_API double quantile_of_samples(const Image& image, double q);

}  // namespace contrejour
