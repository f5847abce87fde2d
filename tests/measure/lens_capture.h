// SPDX-License-Identifier: Apache-2.0
// A simulated sweep of a lens: exact renderer, mosaic, noise, brackets, jitter; merged as photographs are.
#pragma once

#include <optional>
#include <vector>

#include "base/units.h"
#include "contrejour/expert/learn_lens.h"
#include "contrejour/expert/sweep.h"

namespace contrejour::testing {

// Stopped down, out-of-focus ghosts are small and sharp.
inline const LensSettings kStopped{.f_number = 11.0};

struct LensCapture {
  SweepSettings settings;
  std::vector<CapturedImage> pictures;
  std::vector<std::optional<DirectFlux>> direct;
  SweepGeometry geometry;

  // The same sweep as photographs of a lens that is believed to be this one.
  [[nodiscard]] LensPhotographs photographs(Prescription lens, LensSettings lens_settings = {}) const {
    LensPhotographs all;
    all.lens = std::move(lens);
    all.settings = std::move(lens_settings);
    for (const double angle : settings.angles_deg) all.sweep.angles_rad.push_back(rad_from_deg(angle));
    const double light = settings.light_rate / 4.0;  // pixels of half the raw size
    all.sweep.light = {light, light, light};
    all.sweep.direct = direct;
    all.sweep.picture = [this](std::size_t k) -> Result<CapturedImage> { return pictures[k]; };
    all.geometry = geometry;
    return all;
  }
};

inline LensCapture capture_lens(const LensState& lens, int width, int stations, double part_of_field = 0.9) {
  LensCapture all;
  all.settings.angles_deg = even_angles_deg(part_of_field * largest_angle_deg(lens), stations);
  all.settings.width = width;
  all.settings.height = 2 * static_cast<int>(0.5 * width * lens.sensor_height_mm / lens.sensor_width_mm);
  all.settings.light_rate = automatic_light_rate(lens, all.settings).value();
  std::vector<DirectImage> lights;
  for (std::size_t k = 0; k < all.settings.angles_deg.size(); ++k) {
    const SweepStation station = simulate_station(lens, all.settings, k).value();
    all.pictures.push_back(merge_exposures(station.exposures, station.background).value());
    const auto at = direct_flux(station.direct);
    all.direct.push_back(at ? std::optional(*at) : std::nullopt);
    if (at) lights.push_back({rad_from_deg(station.angle_deg), at->position_px});
  }
  all.geometry = fit_geometry(lights, expected_centre(all.pictures[0].rate.width, all.pictures[0].rate.height)).value();
  return all;
}

}  // namespace contrejour::testing
