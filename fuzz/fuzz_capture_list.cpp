// SPDX-License-Identifier: Apache-2.0
// Any bytes as the list of a sweep's photographs: numbers within their ranges that are written and read the same, or an
// error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "contrejour/expert/capture_list.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = read_captures(text, "fuzz.csv");
  if (!read) return 0;
  for (const PlannedCapture& c : *read) {
    if (!(c.time_s > 0.0 && c.angle_deg >= -180.0 && c.angle_deg <= 180.0 && c.station >= 1)) std::abort();
  }
  const std::string written = write_captures(*read);
  const auto again = read_captures(written, "again.csv");
  if (!again || write_captures(*again) != written) std::abort();
  (void)stations_of(*read);
  return 0;
}
