// SPDX-License-Identifier: Apache-2.0
// Any bytes as a sequential lens of Zemax, written as one too.
#include "contrejour/expert/write_lens.h"
#include "lens_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  const std::string text = fuzzed_text(data, size);
  (void)looks_like_zmx(text);
  const auto lens = read_and_back(read_zmx, {text, "fuzz"});
  if (!lens) return 0;
  if (const auto written = write_lens_zmx(*lens)) (void)read_zmx({written->text, "again.zmx"});
  return 0;
}
