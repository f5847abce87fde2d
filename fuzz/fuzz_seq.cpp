// SPDX-License-Identifier: Apache-2.0
// Any bytes as a sequence of CODE V, written as one too.
#include "contrejour/expert/write_lens.h"
#include "lens_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  const std::string text = fuzzed_text(data, size);
  (void)looks_like_seq(text);
  const auto lens = read_and_back(read_seq, {text, "fuzz"});
  if (!lens) return 0;
  if (const auto written = write_lens_seq(*lens)) (void)read_seq({written->text, "again.seq"});
  return 0;
}
