// SPDX-License-Identifier: Apache-2.0
// The prescriptions of the ray oracle: a table of surfaces, with constant indices as in the oracle.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "contrejour/expert/first_order.h"
#include "contrejour/lens.h"

namespace contrejour::test {

inline Prescription read_csv_lens(const std::filesystem::path& file) {
  Prescription lens;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#' || line.starts_with("surf")) continue;
    std::vector<std::string> cells;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    Surface s;
    s.kind = cells[1] == "STOP" ? SurfaceKind::Stop : SurfaceKind::Refracting;
    s.semi_diameter_mm = std::stod(cells[2]);
    s.thickness_mm = std::stod(cells[4]);
    const double radius = std::stod(cells[5]);
    s.curvature_per_mm = radius == 0.0 ? 0.0 : 1.0 / radius;
    s.glass_after = {"", ConstantIndex{std::stod(cells[6])}};
    lens.surfaces.push_back(s);
  }
  return lens;
}

// Places the surfaces and puts the sensor in paraxial focus, without the checks of a user's file.
inline LensState configured(const Prescription& lens, double stop_radius_mm = 1.0) {
  LensState state;
  Glass medium = air();
  double z = 0.0;
  for (const Surface& s : lens.surfaces) {
    const bool stop = s.kind == SurfaceKind::Stop;
    if (stop) state.stop_index = static_cast<int>(state.surfaces.size());
    const Glass after = stop ? medium : s.glass_after;
    state.surfaces.push_back({s.kind, z, s.curvature_per_mm, s.semi_diameter_mm, medium, after, s.coating});
    medium = after;
    z += s.thickness_mm;
  }
  state.stop_radius_mm = stop_radius_mm;
  state.f_number = 1.0;
  const int last = static_cast<int>(state.surfaces.size()) - 1;
  const Abcd m = abcd_between(state.surfaces, 0, last, kLineD_nm);
  state.focal_length_mm = -1.0 / m.c;
  state.sensor_z_mm = state.surfaces.back().z_mm - m.a / m.c;
  return state;
}

}  // namespace contrejour::test
