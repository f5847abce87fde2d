// What the writers of design programs' files share.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/glass_catalogue.h"
#include "contrejour/write_lens.h"
#include "optics/lens_files/sequential/placement.h"

namespace contrejour {

// The shortest text that reads back as the same double.
[[nodiscard]] std::string number_text(double value);

// The fewest digits from which `back` gives the value; nothing if no number does.
[[nodiscard]] std::optional<std::string> text_giving(double value, double about,
                                                     const std::function<double(double)>& back);

// A title on one line, without quotes.
[[nodiscard]] std::string plain_title(const std::string& text);

// Tilts about x, then the new y, then the new z, right-handed, that make up a surface's pose and a turn about its axis.
struct Tilts {
  double x_rad = 0, y_rad = 0, z_rad = 0;
};
[[nodiscard]] Tilts tilts_of(const Surface& surface, double turn_rad);

// As it stands in the coordinates of a surface that is turned itself.
[[nodiscard]] ClearAperture aperture_in_turned(const ClearAperture& aperture, double turn_rad);
[[nodiscard]] Obscuration obscuration_in_turned(const Obscuration& obscuration, double turn_rad);

// A glass of the bundled catalogue by the name that its maker gives it.
struct CataloguedName {
  std::string name, maker;
};
[[nodiscard]] std::optional<CataloguedName> catalogued_name(const Glass& glass);

// From the last vertex to the sensor: as the lens has it, else the paraxial focus; one for each position of a zoom, or
// one. Errors: those of lens_at.
[[nodiscard]] Result<std::vector<double>> sensor_distances_mm(const Prescription& lens);

// What is written: a lens as it is, or a path through one (ghost_rows.h), which is no lens: its rows may be mirrors,
// its gaps negative.
struct WritableDesign {
  Prescription lens;
  std::vector<bool> is_mirror = {};  // by surface; empty: none is
  // For a path, which has no f-number and no image of its own:
  double sensor_mm = 0;  // from the last surface
  double pupil_mm = 0;  // diameter of the bundle that comes in
  double field_deg = 0;  // largest angle of light

  [[nodiscard]] bool is_path() const { return !is_mirror.empty(); }
  [[nodiscard]] bool reflects(std::size_t surface) const { return is_path() && is_mirror[surface]; }
};

// Has each surface written with the gap behind it, the last one's to the sensor, which is returned: of a lens as
// sensor_distances_mm() has it. Errors: of a lens those of validate() and lens_at; Unsupported, with the surface, for
// what `write` says is wrong.
using SurfaceWriter = std::function<std::optional<std::string>(std::size_t surface, double gap_mm)>;
[[nodiscard]] Result<std::vector<double>> write_surfaces(const WritableDesign& rows, const SurfaceWriter& write);

// The radius that reads back as this curvature, or as near as one can; "0" for a plane.
[[nodiscard]] std::string radius_text(double curvature_per_mm);

// What every such file leaves out.
[[nodiscard]] std::vector<std::string> common_losses(const Prescription& lens);

}  // namespace contrejour
