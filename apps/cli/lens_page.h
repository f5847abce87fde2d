// SPDX-License-Identifier: Apache-2.0
// A page (HTML, a single file) that shows many lenses.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace contrejour::cli {

struct LensCard {
  std::string id;      // a bundled name or a file
  std::string name, source;
  double focal_length_mm = 0, f_number = 0;  // as drawn
  std::string focal_lengths;                 // "70-200"
  std::size_t surfaces = 0, ghosts = 0;
  double flare = 0;  // the flux of the flare in the frame over that of the direct image
  double exposure_stops = 0;
  std::string section;             // SVG
  std::vector<std::byte> picture;  // PNG
};

struct RefusedLens {
  std::string id, reason;
};

[[nodiscard]] std::string lens_page(const std::vector<LensCard>& cards, const std::vector<RefusedLens>& refused);

}  // namespace contrejour::cli
