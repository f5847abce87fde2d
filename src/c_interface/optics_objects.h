// SPDX-License-Identifier: Apache-2.0
// The contents of the opaque types of contrejour_optics.h. Thread-safety: plain values.
#pragma once

#include <string>
#include <vector>

#include <contrejour_optics.h>

#include "c_interface/objects.h"
#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/coating.h"
#include "contrejour/expert/lens_section.h"

struct cj_glass {
  contrejour::Glass glass;
};

struct cj_coating {
  contrejour::Coating coating;
  std::string description;
};

struct cj_text {
  std::string text;
  std::vector<std::string> notes;
};

// A line's points as z, y, z, y, ...
struct cj_section {
  struct Line {
    cj_line_kind kind = CJ_LINE_SURFACE;
    bool is_blocked = false;
    std::size_t index = 0;
    std::vector<double> points_mm;
  };
  std::string svg;
  std::vector<Line> lines;
};

namespace contrejour::inline internal {

// 0 stands for the lens's design wavelength. Errors: no wavelength of light.
[[nodiscard]] inline Result<double> wavelength_of(const LensState& lens, double wavelength_nm) {
  if (wavelength_nm == 0.0) return lens.design_wavelength_nm;
  if (is_wavelength(wavelength_nm)) return wavelength_nm;
  return invalid_argument("a wavelength is out of range; give nm, as 550, or 0");
}

// A ghost of the lens. Errors: the lens has no such ghost.
[[nodiscard]] Result<Ghost> ghost_of_surfaces(const LensState& lens, const int32_t surfaces[4]);

}  // namespace contrejour::inline internal
