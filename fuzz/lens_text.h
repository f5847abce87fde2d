// SPDX-License-Identifier: Apache-2.0
// What every harness of a lens reader demands: bytes are a lens that can be set and written, and reads back the same,
// or an error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/decode_text.h"
#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"

namespace contrejour {

using LensReader = Result<Prescription> (*)(const LensText& in);

[[nodiscard]] inline std::string fuzzed_text(const std::uint8_t* data, std::size_t size) {
  return decode_text(std::string_view(reinterpret_cast<const char*>(data), size));
}

// The lens, if it is one.
inline Result<Prescription> read_and_back(LensReader read, const LensText& in) {
  auto lens = read(in);
  if (!lens) return lens;
  (void)configure_lens(*lens);
  const std::string written = write_lens_toml(*lens);
  const auto again = read_lens_toml(written, "again.toml");
  if (!again || write_lens_toml(*again) != written) std::abort();
  return lens;
}

}  // namespace contrejour
