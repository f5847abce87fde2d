// How far polynomials through a ghost's rays may be off, from what that does to pixels.
#pragma once

#include "contrejour/frame.h"
#include "render/adaptive/maps/rays.h"

namespace contrejour::adaptive {

// What is seen of a ghost, or of some part of one: its level where most of its light is, a pixel's value, and its area
// there.
struct Spread {
  double level = 0.0, area_px = 0.0;
};

// What may go wrong in all that a painter is asked to paint at once.
struct ErrorBudget {
  double squared_error = 0;  // pixel values squared, summed over the frame; infinite: no limit
  double peak = 1;           // of the frame's pixel values
  Spread about = {};         // what is known of its light beforehand; none: nothing
};

struct Tolerance {
  double position_px = 0, stop = 0, weight = 0;  // stop radii; relative to the largest weight
  double level = 0;  // of the ghost that this is for, a pixel's value
  double lost_mm2 = 0;   // of the entrance, whose light may be lost in one part of a box
  double colour_px = 0;  // that wavelengths may be off for colours to stay what they are, however dim
};

// Of the ghost that a box's sheet is of. weight: the largest of any channel at any of its nodes, all wavelengths
// together. shared_flux: LightSource's.
[[nodiscard]] Tolerance tolerance_for(const RaySheet& sheet, double weight, double shared_flux, const Frame& frame,
                                      const ErrorBudget& budget);

}  // namespace contrejour::adaptive
