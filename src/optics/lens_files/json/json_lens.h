// SPDX-License-Identifier: Apache-2.0
// Lens files in JSON of several programs, distinguished by their keys.
#pragma once

#include <string>
#include <string_view>

#include "optics/lens_files/json/json_fields.h"
#include "optics/lens_files/read_lens.h"

namespace contrejour::inline internal {

// A format, recognised by its outermost keys.
struct JsonLensFormat {
  std::string_view name;
  bool (*is)(const JsonField& root);
  Result<Prescription> (*read)(const JsonField& root, const LensText& in);
  bool many = false;  // a file holds many lenses, each with its key
};

[[nodiscard]] bool is_roa(const JsonField& root);
[[nodiscard]] Result<Prescription> read_roa(const JsonField& root, const LensText& in);

[[nodiscard]] bool is_optiland(const JsonField& root);
[[nodiscard]] Result<Prescription> read_optiland(const JsonField& root, const LensText& in);

[[nodiscard]] bool is_realflare(const JsonField& root);
[[nodiscard]] Result<Prescription> read_realflare(const JsonField& root, const LensText& in);

[[nodiscard]] bool is_deeplens(const JsonField& root);
[[nodiscard]] Result<Prescription> read_deeplens(const JsonField& root, const LensText& in);

// One lens of many, by its key.
[[nodiscard]] bool is_lentil(const JsonField& root);
[[nodiscard]] Result<Prescription> read_lentil(const JsonField& root, const LensText& in);

// Reports an error for more surfaces than are supported.
void refuse_many_surfaces(const JsonField& surfaces);

// Adds a list's coefficients of r^first, r^(first + step), ... to the shape's. A coefficient of an unsupported power is
// an error, unless it is 0.
void add_powers(const JsonField& list, std::size_t first, std::size_t step, SurfaceShape& shape);

[[nodiscard]] std::string lower_case(std::string text);  // of ASCII letters

// The error that stopped the reading of a file.
[[nodiscard]] inline tl::unexpected<Error> stopped_by(const JsonErrors& errors) {
  return tl::unexpected<Error>(*errors.first);
}

}  // namespace contrejour::inline internal
