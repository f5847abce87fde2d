// SPDX-License-Identifier: Apache-2.0
// Random points of one ghost, and the pixels that their light falls on: the unit of work of the threads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/adaptive/item.h"

namespace contrejour::inline internal::splatting {

// Some rows of the points of one ghost and light at one wavelength.
struct Band {
  const adaptive::Item* item = nullptr;  // with boxes
  const PlannedPass* pass = nullptr;
  std::uint64_t key = 0;  // of the item's and the pass's random numbers
  int first_row = 0, end_row = 0;
};

// The flux on the pixels that a band's light falls on.
struct SplattedBand {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<double> flux;  // rows from the top; mm^2 at E0 = 1
  std::uint64_t rays = 0, surface_hits = 0;  // traced
  std::uint64_t lit = 0;
};

// A point that gets through the lens, in pixels of the frame.
struct LitPoint {
  std::int32_t x = 0, y = 0;
  float transmission = 0.0F;
};

// Draws bands; of one frame, by any number of threads.
class BandSplatter {
 public:
  // points: along each side of the bounds of a ghost's light. All else must outlive this object.
  BandSplatter(const adaptive::Scene& scene, const Frame& frame, int points)
      : scene_(scene), frame_(frame), points_(points) {}

  // Incomplete once the context is cancelled.
  [[nodiscard]] SplattedBand draw(const Band& band, const Context& context) const;

 private:
  struct Start {
    pupils::RaySource& source;
    const LightFrame& light;
    Vec2 low_mm, step_mm;  // of the points' cells
  };

  [[nodiscard]] std::unique_ptr<pupils::FittedGhost> fit_of(const adaptive::Item& item, const LightFrame& light) const;
  [[nodiscard]] std::unique_ptr<pupils::RaySource> source_of(const Band& band, const LightFrame& light,
                                                             const pupils::FittedGhost* fitted) const;
  [[nodiscard]] std::vector<LitPoint> lit_points(const Band& band, const Start& start, const Context& context,
                                                 SplattedBand& counts) const;

  const adaptive::Scene& scene_;
  const Frame& frame_;
  int points_;
};

}  // namespace contrejour::inline internal::splatting
