// SPDX-License-Identifier: Apache-2.0
// Any bytes as a lens of Optical Bench.
#include "lens_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = contrejour::fuzzed_text(data, size);
  (void)contrejour::read_and_back(contrejour::read_optical_bench, {text, "fuzz"});
  return 0;
}
