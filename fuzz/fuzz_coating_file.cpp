// SPDX-License-Identifier: Apache-2.0
// Any bytes as measured reflectances: a table whose every value is a share, or an error.
#include <cstdlib>
#include <string_view>

#include "contrejour/expert/coating_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = read_measured_coating(text, "fuzz.csv");
  if (!read) return 0;
  const Coating coating{"", *read};
  for (const double nm : {100.0, 400.0, 555.0, 800.0}) {
    for (const double cosine : {1.0, 0.7, 1e-9}) {
      const double r = reflectance(coating, 1.0, 1.5, cosine, nm);
      if (!(r >= 0.0 && r <= 1.0)) std::abort();
    }
  }
  return 0;
}
