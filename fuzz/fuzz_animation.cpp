// SPDX-License-Identifier: Apache-2.0
// Any bytes as a file of lights: an error, or values that every frame accepts and that are
// written and read the same.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "contrejour/expert/animation.h"
#include "contrejour/expert/parameter_text.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace contrejour;
  const auto read = read_animation(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.toml");
  if (!read) return 0;
  for (const double frame : {-1e9, 0.0, 1001.0, 1010.5, 1e9}) {
    params::Values values = parameters_at(*read, frame);
    for (const auto& [name, value] : read->parameters)
      if (!values.given(name)) std::abort();
    add_lights_at(*read, frame, values);
    for (const char* name : {"light", "light-at"})
      for (const std::string& light : values.list(name))
        if (!params::parse_light(light)) std::abort();
  }
  (void)first_key(*read);
  const auto again = read_animation(write_animation(*read), "again.toml");
  if (!again || *again != *read) std::abort();
  return 0;
}
