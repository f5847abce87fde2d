// SPDX-License-Identifier: Apache-2.0
// One ghost's flux over the pixels of a frame, and the exact spreading of a polygon of light over them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::reference {

class FluxImage {
 public:
  FluxImage(int width, int height);

  // Spreads flux evenly over a convex polygon given in pixels; each pixel gets the fraction that it covers. Light
  // outside the image is lost. Either orientation; a polygon without area is drawn as a line.
  void add_polygon(std::span<const Vec2> polygon, double flux);

  // Adds gain[c] * flux to an interleaved image of three channels.
  void add_to(std::vector<double>& rgb, const std::array<double, 3>& gain) const;

 private:
  void add_pixel(int x, int y, double flux);
  void add_sliver(std::span<const Vec2> polygon, double flux);

  int width_, height_;
  int first_row_, last_row_;  // touched so far; empty while first > last
  std::vector<double> flux_;
};

}  // namespace contrejour::inline internal::reference
