// The middle of a starburst, where it is finer than pixels.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "contrejour/colour.h"
#include "contrejour/image.h"
#include "contrejour/vec.h"
#include "diffraction/starburst_rings.h"

namespace contrejour {

// Pixels are counted in int; so far away nothing is seen.
[[nodiscard]] inline bool is_drawable(Vec2 centre_px) {
  return std::abs(centre_px.x) < 1e8 && std::abs(centre_px.y) < 1e8;
}

// Adds what is laid onto the pixels about the centre; read_core_row leaves that out.
void paint_core(Image& image, const StarburstRings& rings, Vec2 centre_px, const Rgb& flux, const Context& context);

// The same for any place of the centre: on cells a kCellsPerPixel-th of a pixel wide about it, summed from the first
// row and column on: flux within (x, y) cells is at [(y * (kCoreCells + 1) + x) * 3 + c].
inline constexpr int kCellsPerPixel = 8;
inline constexpr int kCorePixels = 22;
inline constexpr int kCoreCells = kCorePixels * kCellsPerPixel;
[[nodiscard]] std::vector<double> core_flux(const StarburstRings& rings, const Context& context);

// Replaces the pixels near the centre in a row of densities, rgb[3 x + c], y pixels below the centre.
void read_core_row(const StarburstRings& rings, Vec2 centre_px, double y, std::size_t width, float* rgb);

}  // namespace contrejour
