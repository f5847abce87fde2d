// SPDX-License-Identifier: Apache-2.0
// From the primitives of all ghosts to the picture: one buffer, tile lists, traversal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "contrejour/context.h"
#include "contrejour/expert/render_statistics.h"
#include "contrejour/frame.h"
#include "contrejour/image.h"
#include "contrejour/method_options.h"
#include "ghosts/iris_shape.h"
#include "render/tiled/primitive.h"
#include "render/tiled/tile_lists.h"
#include "render/tiled/tile_traversal.h"

namespace contrejour::inline internal::tiled {

// When the buffer exceeds these limits, tiles are built and traversed before more is added, so that memory stays
// bounded. The picture does not depend on them: every pixel continues its sum. 256 MiB of primitives, 128 MiB of lists.
struct HeldLimits {
  std::size_t primitives = 1U << 21U;
  std::uint64_t indices = 1U << 25U;
};

class TiledFrame {
 public:
  // gains, stops: by Primitive::pass; stops may be empty (TraversalInput). All must outlive the frame.
  TiledFrame(const Frame& frame, const TiledOptions& options, const Context& context, const IrisShape& iris,
             std::span<const Gain> gains, const HeldLimits& limits = {}, std::span<const StopTransmittance> stops = {});

  // Appends primitives, in the order in which pixels sum them.
  void add(const PrimitiveBuffer& buffer);

  // Draws the primitives in the buffer onto the picture. Does nothing once the context is cancelled.
  void draw();

  [[nodiscard]] double draw_ms() const { return draw_ms_; }
  [[nodiscard]] Image take_image() { return std::move(image_); }

  // Writes counts, bytes and the times of the phases.
  void report(RenderStatistics& stats) const;

 private:
  void list();
  void traverse();
  void traverse_row(std::size_t row);

  const TiledOptions& options_;
  Context context_;
  const IrisShape& iris_;
  std::span<const Gain> gains_;
  std::span<const StopTransmittance> stops_;
  HeldLimits limits_;
  TileGrid coarse_grid_, dense_grid_;
  Image image_;
  PrimitiveBuffer held_;
  TileLists coarse_, dense_;
  std::uint64_t held_indices_ = 0, primitives_ = 0, indices_ = 0, primitive_bytes_ = 0, list_bytes_ = 0;
  double coarse_ms_ = 0, dense_ms_ = 0, traversal_ms_ = 0, draw_ms_ = 0;
};

}  // namespace contrejour::inline internal::tiled
