// SPDX-License-Identifier: Apache-2.0
// Any bytes as a JSON lens of any program that has one; of files with many lenses those with the keys 1 and 2.
#include "lens_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = contrejour::fuzzed_text(data, size);
  for (const char* key : {"", "1", "2"})
    (void)contrejour::read_and_back(contrejour::read_json_lens, {text, "fuzz", nullptr, key});
  return 0;
}
