// SPDX-License-Identifier: Apache-2.0
// What the files of design programs (Zemax, CODE V) have in common: surfaces from the object to the image in units of
// the lens, breaks of the coordinates between them, and the light they were designed for. Readers fill in this
// structure and prescription_of converts it, so that all such formats are interpreted alike (docs/formats/zemax.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/lens.h"
#include "optics/lens_files/sequential/placement.h"

namespace contrejour::inline internal {

enum class OpeningShape { Round, Rectangle, Ellipse };

// An aperture that a file puts on a surface, in its units.
struct DesignOpening {
  OpeningShape shape = OpeningShape::Round;
  double half_x = 0, half_y = 0;  // radius of a round one: both
  Vec2 centre{};
  double rotation_rad = 0;  // from x towards y
  double circle = 0;  // additional circle about the axis; 0: none
  int line = 0;
};

// A solve that determines a thickness from those in front of it; the file's number is that of one position.
struct ThicknessSolve {
  enum class Kind { Pickup, Sum, Pair } kind = Kind::Pickup;
  int from = 0;                  // surface
  double scale = 1, offset = 0;  // Pickup: scale * thickness + offset; offset is what the thicknesses from there on
                                 // (Sum) or the two (Pair) add up to
};

struct DesignSurface {
  int line = 0;
  double curvature = 0, thickness = 0;
  SurfaceShape shape;
  Glass glass_after = air();
  bool is_stop = false;
  double semi_diameter = 0;     // 0: not stated
  bool is_semi_fixed = false;   // by the designer; else computed by the program for its rays
  std::optional<DesignOpening> opening;
  Obscuration obscuration;      // in the file's units
  Placement move;  // of the coordinates, before this surface and for all following ones
  Placement own;   // of this surface alone, after that
  std::optional<ThicknessSolve> solve;
  bool is_break = false;  // no surface, only a move of the coordinates and a thickness
};

// One of a zoom.
struct DesignPosition {
  std::vector<double> thickness;  // of all surfaces
  double nominal_focal_mm = 0;    // as stated in the title; 0: none
};

enum class DesignAperture { Untold, ByStop, EntrancePupil, FNumber, WorkingFNumber, ObjectNA };
enum class FieldKind { Angle_deg, ObjectHeight, ImageHeight };

struct SequentialDesign {
  std::string program;  // "Zemax": for messages
  std::string name, source;
  std::string file;
  double unit_mm = 1.0;
  std::vector<DesignSurface> surfaces;  // the object first, the image last: its thickness is added to the gap before it
  std::vector<DesignPosition> positions;  // empty for a lens that does not zoom
  DesignAperture aperture = DesignAperture::Untold;
  double aperture_value = 0;
  FieldKind field = FieldKind::Angle_deg;
  double largest_field = 0;
  double largest_x = 0, largest_y = 0;  // of any field
  double image_semi_diameter = 0;  // 0: not stated
  bool is_focused = false;  // a solve puts the image surface at the paraxial focus
  std::optional<double> wavelength_nm;
  std::vector<std::string> warnings;

  // True if the stop's own size, when known, is the aperture.
  [[nodiscard]] bool is_by_stop() const {
    return aperture == DesignAperture::ByStop || aperture == DesignAperture::Untold;
  }
  void add_field(double x, double y) {
    largest_field = std::max(largest_field, std::hypot(x, y));
    largest_x = std::max(largest_x, std::abs(x));
    largest_y = std::max(largest_y, std::abs(y));
  }
};

// An empty design for a program's file.
[[nodiscard]] SequentialDesign design_from(std::string program, const std::string& file);

// Converts a design to our lens:
// - A design without a name gets that of its file.
// - Surfaces at which nothing is refracted, blocked or stopped become part of the gap.
// - A stop on a surface becomes a row of its own at that surface's vertex, in front of it.
// - The f-number is that for distant objects; unknown semi-diameters follow from the design's beam.
// - The sensor has the image circle of the widest field, and is at the image surface if that is near the focus of
//   distant objects.
// - Positions for distant objects are those of a zoom; near ones are omitted, since focusing moves the sensor.
// Errors: no lens; a decentred or tilted stop or image surface; those of completed().
[[nodiscard]] Result<Prescription> prescription_of(const SequentialDesign& design);

}  // namespace contrejour::inline internal
