// SPDX-License-Identifier: Apache-2.0
// The pupil of a ghost: boxes of the entrance plane that together contain all of its light, at each of some
// wavelengths, in the light's meridional frame (light_frame.h) if the lens has axial symmetry.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ghosts/ray_grid.h"
#include "optics/trace/by_wavelength.h"

namespace contrejour::inline internal::pupils {

// The ghost, light and lens of a search. Everything that it refers to must outlive it.
struct PupilRequest {
  const StepsByWavelength& steps;
  Ghost ghost;
  LightSource light;
  EntranceWindow window;  // of the light, in the frame for the ghost's symmetry (LightWindows)
  std::span<const double> lambda_nm;  // rising; searched at the middle one first, fitted to the outer ones
  double stop_times = 1.0;  // factor on the stop's radius
  const Context* context = nullptr;  // once it is cancelled, boxes may be missing; null: never
};

struct GhostPupil {
  std::vector<Rectangle> boxes;  // disjoint, with margins; each one that does not touch y = 0 comes with its mirror
                                 // image
  std::uint64_t rays = 0, surface_hits = 0;
};

[[nodiscard]] GhostPupil find_ghost_pupil(const PupilRequest& request);

// The same in two steps, the second only for ghosts that are drawn: boxes for the middle wavelength, or for an outer
// one if nothing gets through there, which may overlap; and from them those for all wavelengths. (Lenses without
// symmetries are searched in one step.)
[[nodiscard]] GhostPupil search_ghost_pupil(const PupilRequest& request);
[[nodiscard]] GhostPupil fit_ghost_pupil(const PupilRequest& request, GhostPupil searched);

// Merges boxes that overlap, whose light would count twice, into one that contains both.
[[nodiscard]] std::vector<Rectangle> disjoint(std::vector<Rectangle> boxes);

// Fits the boxes of a smaller stop to this one.
[[nodiscard]] GhostPupil refit_ghost_pupil(const PupilRequest& request, std::vector<Rectangle> boxes);

// True if the box is the mirror image of one on the other side of the axis of symmetry.
[[nodiscard]] bool is_mirror_image(const Rectangle& box);

// The wavelength at which a pupil is searched first.
[[nodiscard]] double middle_wavelength(const PupilRequest& request);

}  // namespace contrejour::inline internal::pupils
