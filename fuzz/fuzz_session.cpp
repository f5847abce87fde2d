// SPDX-License-Identifier: Apache-2.0
// Any bytes as a session: values and a lens, or an error; what is read is written as the same.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "contrejour/expert/session.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = contrejour::read_session(text, "fuzz.session.json");
  if (!read) return 0;
  const std::string written = contrejour::write_session(*read);
  const auto again = contrejour::read_session(written, "again.session.json");
  if (!again || contrejour::write_session(*again) != written) std::abort();
  if (!read->prescription.empty()) (void)contrejour::lens_of_session(*read);
  return 0;
}
