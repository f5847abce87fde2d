// SPDX-License-Identifier: Apache-2.0
// Any bytes: the lens reader must answer in bounded time and memory, and what it takes must write and read back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "contrejour/lens.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto lens = contrejour::read_lens_toml(text, "fuzz.toml");
  if (!lens) return 0;
  const std::string written = contrejour::write_lens_toml(*lens);
  const auto again = contrejour::read_lens_toml(written, "again.toml");
  if (!again || contrejour::write_lens_toml(*again) != written) std::abort();
  return 0;
}
