// Where the light of a ghost comes through the lens: boxes of the entrance plane that together hold all of it, at every
// one of some wavelengths. In the light's meridional frame (light_frame.h) where the lens is symmetric about it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ghosts/ray_grid.h"
#include "optics/trace/by_wavelength.h"

namespace contrejour::pupils {

// What is looked for. Everything that it refers to must outlive it.
struct PupilRequest {
  const StepsByWavelength& steps;
  Ghost ghost;
  LightSource light;
  EntranceWindow window;  // of the light, in the frame that the ghost's symmetry asks for (LightWindows)
  std::span<const double> lambda_nm;  // rising; searched at the middle one, fitted to the outer ones
  double stop_times = 1.0;  // the stop counts as so many times as large
};

struct GhostPupil {
  std::vector<Rectangle> boxes;  // disjoint, with margins; each that lies aside of y = 0 comes with its mirror image
  std::uint64_t rays = 0, surface_hits = 0;
};

[[nodiscard]] GhostPupil find_ghost_pupil(const PupilRequest& request);

// The same in two steps, the second for ghosts that turn out to matter: boxes for the middle wavelength, which may
// overlap, and from them those for all. (Lenses without symmetries are searched in one.)
[[nodiscard]] GhostPupil search_ghost_pupil(const PupilRequest& request);
[[nodiscard]] GhostPupil fit_ghost_pupil(const PupilRequest& request, GhostPupil searched);

// Boxes that overlap, whose light would count twice there, as one that holds both.
[[nodiscard]] std::vector<Rectangle> disjoint(std::vector<Rectangle> boxes);

// From the boxes of a smaller stop: what comes through near them.
[[nodiscard]] GhostPupil refit_ghost_pupil(const PupilRequest& request, std::vector<Rectangle> boxes);

// Is it the image of a box on the other side of the axis of symmetry?
[[nodiscard]] bool is_mirror_image(const Rectangle& box);

// That a pupil is searched at.
[[nodiscard]] double middle_wavelength(const PupilRequest& request);

}  // namespace contrejour::pupils
