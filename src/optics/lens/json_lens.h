// Lens files in JSON of several programs, told apart by their keys.
#pragma once

#include <string_view>

#include "optics/lens/json_fields.h"
#include "optics/lens/read_lens.h"

namespace contrejour {

// A lens of this program is there, as far as its outermost keys tell.
struct JsonLensFormat {
  std::string_view name;
  bool (*is)(const JsonField& root);
  Result<Prescription> (*read)(const JsonField& root, const LensText& in);
  bool many = false;  // a file holds many lenses, each with its key
};

[[nodiscard]] bool is_realflare(const JsonField& root);
[[nodiscard]] Result<Prescription> read_realflare(const JsonField& root, const LensText& in);

// One lens of many, by its key.
[[nodiscard]] bool is_lentil(const JsonField& root);
[[nodiscard]] Result<Prescription> read_lentil(const JsonField& root, const LensText& in);

// The list's item of that number is one surface too many, said with its line.
void refuse_many_surfaces(const JsonField& surfaces);

// The error that stopped the reading of a file.
[[nodiscard]] inline tl::unexpected<Error> stopped_by(const JsonErrors& errors) {
  return tl::unexpected<Error>(*errors.first);
}

}  // namespace contrejour
