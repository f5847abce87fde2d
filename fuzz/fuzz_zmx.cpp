// Any bytes as a sequential lens of Zemax: one that can be set, written here and there and read again, or an error.
#include <cstdlib>
#include <string_view>

#include "base/decode_text.h"
#include "contrejour/lens.h"
#include "contrejour/write_lens.h"
#include "optics/lens_files/read_lens.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string decoded = decode_text(text);
  (void)looks_like_zmx(decoded);
  const auto lens = read_zmx({decoded, "fuzz"});
  if (!lens) return 0;
  (void)lens_at(*lens);
  const std::string written = write_lens_toml(*lens);
  const auto again = read_lens_toml(written, "again.toml");
  if (!again || write_lens_toml(*again) != written) std::abort();
  if (const auto back = write_lens_zmx(*lens)) (void)read_zmx({back->text, "again.zmx"});
  return 0;
}
