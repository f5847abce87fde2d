// SPDX-License-Identifier: Apache-2.0
#include "diffraction/band_shifts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

BandShifts shifts_of(std::span<const SpectralBand> bands) {
  const auto [low, high] = std::minmax_element(bands.begin(), bands.end(),
                                               [](const auto& a, const auto& b) { return a.lambda_nm < b.lambda_nm; });
  BandShifts shifts;
  shifts.lambda_nm = std::sqrt(low->lambda_nm * high->lambda_nm);
  const auto rows_of = [&](double nm) { return kRowsPerOctave * std::log2(nm / shifts.lambda_nm); };
  shifts.first = static_cast<int>(std::floor(rows_of(low->lambda_nm)));
  const int last = static_cast<int>(std::floor(rows_of(high->lambda_nm))) + 1;
  shifts.weight.resize(static_cast<std::size_t>(last - shifts.first + 1));
  for (const SpectralBand& band : bands) {
    const double position = rows_of(band.lambda_nm) - shifts.first;
    const auto k = static_cast<std::size_t>(position);
    const double t = position - static_cast<double>(k);
    for (const std::size_t i : {k, k + 1}) {
      // A pattern twice as wide has a quarter of the density.
      const double spread = std::exp2(-2.0 * (shifts.first + static_cast<double>(i)) / kRowsPerOctave);
      for (std::size_t c = 0; c < 3; ++c)
        shifts.weight[i][c] += static_cast<float>(band.weight[c] * spread * (i == k ? 1.0 - t : t));
    }
  }
  return shifts;
}

}  // namespace contrejour::inline internal
