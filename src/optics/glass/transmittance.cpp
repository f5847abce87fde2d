// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "contrejour/expert/glass.h"

namespace contrejour {
namespace {

// Interpolates linearly between the table's wavelengths; constant beyond.
double absorption_per_mm(const std::vector<Absorption>& table, double lambda_nm) {
  const auto above = std::upper_bound(table.begin(), table.end(), lambda_nm,
                                      [](double nm, const Absorption& row) { return nm < row.lambda_nm; });
  if (above == table.begin()) return table.front().per_mm;
  const Absorption& low = *(above - 1);
  if (above == table.end()) return low.per_mm;
  const double fraction = (lambda_nm - low.lambda_nm) / (above->lambda_nm - low.lambda_nm);
  return low.per_mm + fraction * (above->per_mm - low.per_mm);
}

}  // namespace

double internal_transmittance(const Glass& glass, double lambda_nm, double path_mm) {
  const auto* known = std::get_if<CatalogueGlass>(&glass.dispersion);
  if (known == nullptr || known->data().absorption.empty()) return 1.0;
  return std::exp(-absorption_per_mm(known->data().absorption, lambda_nm) * path_mm);
}

}  // namespace contrejour
