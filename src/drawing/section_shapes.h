// SPDX-License-Identifier: Apache-2.0
// The shapes of a section's glass, from the surfaces of its lens. Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/lens_section.h"

namespace contrejour::inline internal {

// A surface's clear height, limited by a sphere's radius, and its sag there.
[[nodiscard]] double drawn_height_mm(const SurfaceState& surface);
[[nodiscard]] double sag_mm(const SurfaceState& surface, double height_mm);

// Fills in the elements, surfaces, obscurations, stop and sensor of section.lens.
void add_shapes(LensSection& section);

}  // namespace contrejour::inline internal
