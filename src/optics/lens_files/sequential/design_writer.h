// SPDX-License-Identifier: Apache-2.0
// Code that the writers of design programs' files share.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/expert/write_lens.h"
#include "optics/lens_files/sequential/placement.h"

namespace contrejour::inline internal {

// The shortest text that reads back as the same double.
[[nodiscard]] std::string number_text(double value);

// The shortest number from which `back` gives the value; nothing if there is none.
[[nodiscard]] std::optional<std::string> text_giving(double value, double about,
                                                     const std::function<double(double)>& back);

// A title on one line, without quotes.
[[nodiscard]] std::string plain_title(const std::string& text);

// Tilts about x, then the new y, then the new z, right-handed, that combine a surface's pose and a rotation about its
// axis.
struct Tilts {
  double x_rad = 0, y_rad = 0, z_rad = 0;
};
[[nodiscard]] Tilts tilts_of(const Surface& surface, double rotation_rad);

// The aperture in the coordinates of a rotated surface.
[[nodiscard]] ClearAperture aperture_in_rotated(const ClearAperture& aperture, double rotation_rad);
[[nodiscard]] Obscuration obscuration_in_rotated(const Obscuration& obscuration, double rotation_rad);

// A glass of the bundled catalogue by the name that its maker gives it.
struct CataloguedName {
  std::string name, maker;
};
[[nodiscard]] std::optional<CataloguedName> catalogued_name(const Glass& glass);

// Distances from the last vertex to the sensor: the lens's own, else the paraxial focus; one for each zoom position.
// Errors: those of configure_lens.
[[nodiscard]] Result<std::vector<double>> sensor_distances_mm(const Prescription& lens);

// The design to write: a lens, or a path through one (ghost_rows.h), whose rows may be mirrors and whose gaps may be
// negative.
struct WritableDesign {
  Prescription lens;
  std::vector<bool> is_mirror = {};  // by surface; empty: no mirrors
  // For a path, which has no f-number and no image of its own:
  double sensor_mm = 0;  // from the last surface
  double pupil_mm = 0;  // diameter of the incident bundle
  double field_deg = 0;  // largest angle of light

  [[nodiscard]] bool is_path() const { return !is_mirror.empty(); }
  [[nodiscard]] bool reflects(std::size_t surface) const { return is_path() && is_mirror[surface]; }
};

// Calls `write` for each surface with the gap behind it; the last gap, to the sensor, is returned: for a lens that of
// sensor_distances_mm(). Errors: for a lens those of validate() and configure_lens; Unsupported, with the surface, for
// problems that `write` returns.
using SurfaceWriter = std::function<std::optional<std::string>(std::size_t surface, double gap_mm)>;
[[nodiscard]] Result<std::vector<double>> write_surfaces(const WritableDesign& rows, const SurfaceWriter& write);

// The radius that reads back as this curvature or the nearest possible one; "0" for a plane.
[[nodiscard]] std::string radius_text(double curvature_per_mm);

// The losses common to all such files.
[[nodiscard]] std::vector<std::string> common_losses(const Prescription& lens);

}  // namespace contrejour::inline internal
