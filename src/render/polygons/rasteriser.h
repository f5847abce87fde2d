// SPDX-License-Identifier: Apache-2.0
// A rasteriser draws lists of polygons as pixels. A rasteriser outlives the frames that it draws, and what it keeps
// between them (scratch memory, or a device's buffers) changes no picture. Each polygon adds its area in a pixel times
// its irradiance at the pixel's centre times its pattern's transmittance; lists are added in their order.
// Thread-safety: a rasteriser may serve several threads at once; a batch belongs to one, except for set().
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "contrejour/context.h"
#include "contrejour/image.h"
#include "render/polygons/pattern_atlas.h"
#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::raster {

enum class RasterMode : std::uint8_t { Write, Add };

// An image of a frame, or of the part of it that begins at (left, top).
struct RasterTarget {
  Image& image;
  int left = 0, top = 0;
};

// Pixels of a frame, from (x0, y0) to (x1, y1), excluding the last ones; none if x1 <= x0.
struct PixelArea {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// Lists of polygons that are drawn together.
class PolygonBatch {
 public:
  PolygonBatch() = default;
  PolygonBatch(const PolygonBatch&) = delete;
  PolygonBatch& operator=(const PolygonBatch&) = delete;
  virtual ~PolygonBatch() = default;

  // Appends this many empty lists.
  virtual void extend(std::size_t lists) = 0;
  // Sets a list. Different threads may set different lists at once.
  virtual void set(std::size_t list, PolygonList polygons) = 0;
  [[nodiscard]] virtual std::size_t bytes() const = 0;  // of all lists

  // An area that contains all pixels which polygons may touch.
  [[nodiscard]] virtual PixelArea touched() const = 0;
  // Writes the light of all lists to all pixels of the target, or adds it. The target is the whole frame, or contains
  // touched(). Incomplete when cancelled.
  virtual void draw(RasterMode mode, const Context& context, const RasterTarget& target) = 0;
};

class Rasteriser {
 public:
  Rasteriser() = default;
  Rasteriser(const Rasteriser&) = delete;
  Rasteriser& operator=(const Rasteriser&) = delete;
  virtual ~Rasteriser() = default;

  // An empty batch for a frame of this size. atlas: the one that patterns refer to, which must outlive the batch; null
  // if none does.
  [[nodiscard]] virtual std::unique_ptr<PolygonBatch> new_batch(int width, int height, const PatternAtlas* atlas) = 0;
};

}  // namespace contrejour::inline internal::raster
