// SPDX-License-Identifier: Apache-2.0
// Lenses and single ghosts for the tests of this folder: the bundle's ghost and the reference's, by pixel.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/ghost.h"
#include "contrejour/lens.h"
#include "render/bundle/cell_raster.h"
#include "render/pupils/pupil_search.h"
#include "render/reference/flux_image.h"
#include "render/reference/pupil_cells.h"

namespace contrejour::test {

inline LensState lens(const std::string& name, double f_number, double focal_length_mm = 0.0, int blades = 0) {
  const auto prescription = find_lens(name);
  REQUIRE(prescription.has_value());
  LensSettings settings;
  settings.f_number = f_number;
  if (focal_length_mm > 0.0) settings.focal_length_mm = focal_length_mm;
  settings.iris.blades = blades;
  const auto state = configure_lens(*prescription, settings);
  REQUIRE(state.has_value());
  return *state;
}

struct GhostImage {
  std::vector<double> flux;  // mm^2 at E0 = 1, by pixel
  bool folded = false;       // cells of either orientation are open

  [[nodiscard]] double total() const {
    double sum = 0.0;
    for (const double f : flux) sum += f;
    return sum;
  }
  [[nodiscard]] double peak() const { return *std::max_element(flux.begin(), flux.end()); }
};

// Whether the map preserves the orientation of some open cells and reverses that of others.
inline bool is_folded(const RayGrid& grid) {
  bool up = false;
  bool down = false;
  for (int iy = 0; iy < grid.cells(); ++iy) {
    for (int ix = 0; ix < grid.cells(); ++ix) {
      const auto v = grid.corners(ix, iy);
      if (std::any_of(v.begin(), v.end(), [&](std::size_t k) { return grid.blocked[k] > 0.0F; })) continue;
      const auto at = [&](std::size_t k) { return Vec2{grid.sensor_x_mm[v[k]], grid.sensor_y_mm[v[k]]}; };
      const double area = cross(at(2) - at(0), at(3) - at(1));
      up = up || area > 0.0;
      down = down || area < 0.0;
    }
  }
  return up && down;
}

inline GhostImage bundle_ghost(const LensState& state, Ghost ghost, Vec3 direction, const Frame& frame, int side,
                               double lambda_nm = 550.0) {
  GhostImage image;
  image.flux.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  const OpticalPath path = ghost_path(state, ghost, lambda_nm);
  const ReflectanceTables tables(state, lambda_nm);
  const IrisShape iris(state.iris);
  const EntranceWindow window = entrance_window(state, direction);
  RayGrid grid;
  const pupils::Pupil pupil = find_pupil(pupils::PupilRays(path, tables, direction, iris, window), {});
  if (pupil.is_empty()) return image;
  const auto precision = precision_for(path, tables, direction, window.z_mm, pupil.box(), side, frame.pixel_pitch_mm);
  grid.trace(path, tables, iris, direction, window.z_mm, pupil.box(), side, precision);
  image.folded = is_folded(grid);
  bundle::CellRaster raster(grid, iris, frame, direction.z);
  const bundle::FluxBox box = raster.draw([] { return false; });
  for (int y = box.box().y0; y < box.box().y1; ++y) {
    const auto row = box.row(y);
    std::copy(row.begin(), row.end(), image.flux.begin() + static_cast<std::ptrdiff_t>(y) * frame.width + box.box().x0);
  }
  return image;
}

inline GhostImage reference_ghost(const LensState& state, Ghost ghost, Vec3 direction, const Frame& frame,
                                  double density = 1.0, double lambda_nm = 550.0) {
  reference::FluxImage flux(frame.width, frame.height);
  reference::for_each_lit_polygon(
      ghost_path(state, ghost, lambda_nm), state.iris, direction, entrance_window(state, direction), frame,
      reference::CellLimits::for_density(density), [] { return false; },
      [&](std::span<const Vec2> pixels, double f) { flux.add_polygon(pixels, f); });
  const std::size_t count = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  std::vector<double> rgb(3 * count);
  flux.add_to(rgb, {1.0, 0.0, 0.0});
  GhostImage image;
  for (std::size_t k = 0; k < count; ++k) image.flux.push_back(rgb[3 * k]);
  return image;
}

}  // namespace contrejour::test
