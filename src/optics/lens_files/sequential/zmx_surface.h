// SPDX-License-Identifier: Apache-2.0
// A SURF block of a Zemax file, and its conversion to a surface.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {

// GLAS: a name, or an index and an Abbe number.
struct ZmxGlass {
  // The kind of glass: by name, by the row's numbers, picked up from another surface, a substitutable one, or a named
  // one with an offset of index and Abbe number.
  enum class Status { Named, Model, PickedUp, Substitute, Offset, Other };

  int line = 0;
  std::string name = {};
  Status status = Status::Named;
  int from = 0;  // surface that it is picked up from
  double n_d = 0, v_d = 0, d_pgf = 0;
  double more_n_d = 0, more_v_d = 0;  // offset from the named glass

  [[nodiscard]] bool is_blank() const { return name.empty() || name.starts_with("___"); }
};

struct ZmxSurface {
  int line = 0;
  std::string type = "STANDARD";
  double curvature = 0, conic = 0;
  double thickness = 0;  // infinite at distant objects
  std::map<int, double> parm, xdat;
  std::optional<ZmxGlass> glass;
  double semi_diameter = 0;
  bool is_semi_fixed = false;
  bool is_stop = false;
  std::optional<DesignOpening> opening;
  Obscuration obscuration;
  std::string coating;  // its name and line
  int own_tilt_line = 0;  // of SCBD, a decentre or tilt of the surface alone; 0: none
  bool floats = false;  // FLAP: an aperture of the semi-diameter's size
  std::optional<ThicknessSolve> solve;
  bool is_to_focus = false;  // MAZH 0 0: the next surface is at the paraxial focus

  [[nodiscard]] double parameter(int k) const {
    const auto at = parm.find(k);
    return at == parm.end() ? 0.0 : at->second;
  }
  [[nodiscard]] double extra(int k) const {
    const auto at = xdat.find(k);
    return at == xdat.end() ? 0.0 : at->second;
  }
};

// Errors: Unsupported for an unsupported type or term.
[[nodiscard]] Result<DesignSurface> zmx_surface(const ZmxSurface& in, int index, const std::string& file);

// The glass by name: of the makers in GCAT's list, then of any; else by the row's own numbers, with a warning. Errors:
// Unsupported for a mirror, InvalidArgument for a name that no catalogue has.
[[nodiscard]] Result<Glass> zmx_glass(const ZmxGlass& in, std::span<const std::string> makers, GlassFinder& finder,
                                      const std::string& file, std::vector<std::string>& warnings);

}  // namespace contrejour::inline internal
