// SPDX-License-Identifier: Apache-2.0
// Any bytes as a spectrum: a table of which some is visible, or an error; what is read is written as the same, and has
// bands whose weights are finite.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "contrejour/expert/spectrum_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = contrejour::read_spectrum(text, "fuzz.csv");
  if (!read) return 0;
  const auto again = contrejour::read_spectrum(contrejour::write_spectrum(*read), "again.csv");
  if (!again || *again != *read) std::abort();
  for (const auto& band : contrejour::spectral_bands(3, *read, contrejour::ColourSpace::Rec709)) {
    if (!std::isfinite(band.lambda_nm + band.weight[0] + band.weight[1] + band.weight[2])) std::abort();
  }
  return 0;
}
