// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/pupil_search.h"

#include <utility>

#include "render/pupils/searches.h"

namespace contrejour::inline internal::pupils {

PupilRays::PupilRays(const OpticalPath& of, const ReflectanceTables& tables, const LightSource& light,
                     const IrisShape& shape, const EntranceWindow& entrance)
    : path(of.obscured ? without_obscurations(of) : of, tables, {{0.0, 0.0, entrance.z_mm}, light}), iris(shape.hull()),
      window(entrance) {}

PupilRays::PupilRays(PacketPath of, const EntranceWindow& entrance)
    : path(std::move(of)), iris(Iris{}), window(entrance) {}

PupilEffort effort_for_grid(int side) {
  constexpr int kFiner = 12;  // factor of rays along each side, for the finest grid of a search
  for (const PupilEffort effort : {PupilEffort::Finest, PupilEffort::Finer})
    if (first_grid_side(effort) <= kFiner * side) return effort;
  return PupilEffort::Once;
}

Pupil find_pupil(PupilRays& rays, const PupilSearch& search, RayGrid& grid) {
  if (search.along_meridian)
    return search.hint ? search_meridian_around(rays, *search.hint) : search_meridian(rays, search);
  return search.hint ? search_window_around(rays, *search.hint, grid) : search_window(rays, search, grid);
}

}  // namespace contrejour::inline internal::pupils
