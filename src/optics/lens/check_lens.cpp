// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/check_lens.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/scalar.h"
#include "optics/lens/iris_closing.h"
#include "optics/lens/validate.h"

namespace contrejour {
namespace {

constexpr double kFarthest_mm = 1e7;  // from the first vertex
constexpr double kLargest_mm = 1e5;
constexpr double kFirst_nm = 380.0, kLast_nm = 780.0;
constexpr double kMaxMediumIndex = 5.0;  // as of a prescription's glasses

tl::unexpected<Error> refused_at(std::size_t index, const std::string& what) {
  return invalid_argument(fmt::format("surface {}: {}", index + 1, what));
}

// Checks the ends of the visible range and the design wavelength: glasses from files were checked between them when
// read.
bool is_medium(const Glass& glass, double design_nm) {
  const auto fits = [&](double nm) { return within(refractive_index(glass, nm), 1.0 - 1e-9, kMaxMediumIndex); };
  return fits(kFirst_nm) && fits(design_nm) && fits(kLast_nm);
}

// As coating_problem(), without checking the values of a measured coating, of which there may be a million.
std::optional<std::string> films_problem(const Coating& coating) {
  const auto* const measured = std::get_if<MeasuredCoating>(&coating.films);
  if (measured == nullptr) return coating_problem(coating);
  const std::size_t wanted = measured->lambda_nm.size() * measured->angle_deg.size();
  if (wanted > 0 && measured->reflectance.size() == wanted) return std::nullopt;
  return "a measured coating needs a reflectance for each wavelength and angle";
}

Result<void> check_surface(const LensState& lens, std::size_t index) {
  const SurfaceState& s = lens.surfaces[index];
  if (!within(s.z_mm, -kFarthest_mm, kFarthest_mm)) return refused_at(index, fmt::format("it stands at {} mm", s.z_mm));
  if (!within(s.semi_diameter_mm, 1e-6, kLargest_mm))
    return refused_at(index, fmt::format("its semi-diameter is {} mm", s.semi_diameter_mm));
  if (s.kind == SurfaceKind::Sensor && index + 1 < lens.surfaces.size())
    return refused_at(index, "a sensor, and more surfaces behind it");
  Surface shaped;
  shaped.curvature_per_mm = s.curvature_per_mm;
  shaped.semi_diameter_mm = s.semi_diameter_mm;
  shaped.shape = s.shape;
  shaped.pose = s.pose;
  shaped.aperture = s.aperture;
  shaped.obscuration = s.obscuration;
  if (const auto problem = shape_problem(shaped)) return refused_at(index, *problem);
  if (const auto problem = aperture_problem(shaped)) return refused_at(index, *problem);
  if (const auto problem = obscuration_problem(shaped)) return refused_at(index, *problem);
  if (const auto problem = films_problem(s.coating)) return refused_at(index, *problem);
  if (!is_medium(s.before, lens.design_wavelength_nm) || !is_medium(s.after, lens.design_wavelength_nm))
    return refused_at(index, fmt::format("an index beside it is not from 1 to {} in the visible", kMaxMediumIndex));
  return {};
}

Result<void> check_surfaces(const LensState& lens) {
  if (lens.surfaces.empty()) return invalid_argument("the lens state has no surfaces; make it with configure_lens()");
  if (lens.surfaces.size() > kMaxLensSurfaces)
    return invalid_argument(
        fmt::format("{} surfaces; at most {} are computed", lens.surfaces.size(), kMaxLensSurfaces));
  const auto count = [&](SurfaceKind kind) {
    return std::count_if(lens.surfaces.begin(), lens.surfaces.end(),
                         [&](const SurfaceState& s) { return s.kind == kind; });
  };
  const bool named =
      has_stop(lens) && lens.surfaces[static_cast<std::size_t>(lens.stop_index)].kind == SurfaceKind::Stop;
  if (!named || count(SurfaceKind::Stop) != 1) return invalid_argument("stop_index must name the only stop");
  if (count(SurfaceKind::Refracting) == 0) return invalid_argument("no surface refracts; a stop alone is no lens");
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k)
    if (auto good = check_surface(lens, k); !good) return good;
  return {};
}

Result<void> check_figures(const LensState& lens) {
  const auto positive = [](double value, double largest) { return value > 0.0 && value <= largest; };
  if (!within(lens.design_wavelength_nm, 100.0, 1e5))
    return invalid_argument(fmt::format("a design wavelength of {} nm", lens.design_wavelength_nm));
  if (!positive(lens.stop_radius_mm, kLargest_mm))
    return invalid_argument(fmt::format("a stop of radius {} mm lets no light through", lens.stop_radius_mm));
  if (!within(lens.sensor_z_mm, -kFarthest_mm, kFarthest_mm))
    return invalid_argument(fmt::format("a sensor at {} mm", lens.sensor_z_mm));
  if (!positive(lens.sensor_width_mm, kLargest_mm) || !positive(lens.sensor_height_mm, kLargest_mm))
    return invalid_argument(fmt::format("a sensor of {} x {} mm", lens.sensor_width_mm, lens.sensor_height_mm));
  if (std::isnan(lens.focal_length_mm) || lens.focal_length_mm == 0.0)
    return invalid_argument(fmt::format("a focal length of {} mm", lens.focal_length_mm));
  if (!positive(lens.f_number, kLargestFNumber))
    return invalid_argument(fmt::format("an f-number of {}", lens.f_number));
  if (!(lens.object_distance_mm > 0.0))
    return invalid_argument(fmt::format("an object at a distance of {} mm", lens.object_distance_mm));
  const SensorGrating& grating = lens.sensor_grating;
  if (grating.orders < 0 || grating.orders > SensorStack::kMaxOrders || !positive(grating.pitch_mm, kLargest_mm) ||
      !positive(grating.fill, 1.0))
    return invalid_argument("the sensor's grating is none: its orders, pitch or fill are out of range");
  return {};
}

}  // namespace

Result<void> check_lens(const LensState& lens) {
  if (auto good = check_figures(lens); !good) return good;
  if (auto good = check_surfaces(lens); !good) return good;
  if (auto good = check_iris(lens.iris); !good) return good;
  return check_dirt(lens.dirt);
}

}  // namespace contrejour
