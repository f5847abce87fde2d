// SPDX-License-Identifier: Apache-2.0
// Any bytes as a page of refractiveindex.info: a glass whose index is a number within its range, or an error.
#include <cstdlib>
#include <string_view>

#include "contrejour/expert/glass_catalogue.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  const auto read = read_glass_yaml({reinterpret_cast<const char*>(data), size}, "fuzz.yml", "FUZZ", "GLASS");
  if (!read) return 0;
  const CatalogueEntry& entry = read->glasses.front();
  const auto range = wavelength_range_nm(entry.glass);
  if (!range || !(refractive_index(entry.glass, range->first_nm) > 0.0)) std::abort();
  (void)refractive_index(entry.glass, 550.0, {80.0, 0.5});
  const double tau = internal_transmittance(entry.glass, 550.0, 10.0);
  if (!(tau >= 0.0 && tau <= 1.0)) std::abort();
  return 0;
}
