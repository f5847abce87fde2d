// Any bytes as a JSON lens of any program that has one: lenses that can be set and written, and read back the same, or
// an error. Of files with many lenses those with the keys 1 and 2.
#include <cstdlib>
#include <string_view>

#include "base/decode_text.h"
#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string decoded = decode_text(text);
  for (const char* key : {"", "1", "2"}) {
    const auto lens = read_json_lens({decoded, "fuzz", nullptr, key});
    if (!lens) continue;
    (void)lens_at(*lens);
    const std::string written = write_lens_toml(*lens);
    const auto again = read_lens_toml(written, "again.toml");
    if (!again || write_lens_toml(*again) != written) std::abort();
  }
  return 0;
}
