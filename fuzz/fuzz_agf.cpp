// SPDX-License-Identifier: Apache-2.0
// Any bytes as an AGF catalogue: glasses whose index is a number within their range, or an error.
#include <cstdlib>
#include <string_view>

#include "contrejour/expert/glass_catalogue.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  auto read = read_agf({reinterpret_cast<const char*>(data), size}, "fuzz.agf", "FUZZ");
  if (!read) return 0;
  for (const CatalogueEntry& entry : read->glasses) {
    const auto range = wavelength_range_nm(entry.glass);
    const double nm = range ? range->first_nm : kLineD_nm;
    if (!(refractive_index(entry.glass, nm) > 0.0)) std::abort();
    (void)refractive_index(entry.glass, nm, {80.0, 0.5});
    const double tau = internal_transmittance(entry.glass, 550.0, 10.0);
    if (!(tau >= 0.0 && tau <= 1.0)) std::abort();
  }
  const std::string first = read->glasses.front().summary.name;
  GlassCatalogue catalogue;
  catalogue.add(std::move(read->glasses));
  (void)catalogue.find(first);
  (void)catalogue.closest(1.5, 60.0, 3);
  return 0;
}
