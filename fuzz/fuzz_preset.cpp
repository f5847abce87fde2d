// SPDX-License-Identifier: Apache-2.0
// Any bytes as a look: names and values, or an error; what is read is written as the same.
#include <cstdlib>
#include <string_view>

#include "contrejour/expert/key_values.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = contrejour::read_key_values(text, "fuzz.toml", "a page");
  if (!read) return 0;
  const auto again = contrejour::read_key_values(contrejour::write_key_values(*read), "again.toml", "a page");
  if (!again || again->size() != read->size()) std::abort();
  for (std::size_t k = 0; k < read->size(); ++k) {
    if ((*again)[k].key != (*read)[k].key || (*again)[k].texts != (*read)[k].texts) std::abort();
  }
  return 0;
}
