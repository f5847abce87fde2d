// SPDX-License-Identifier: Apache-2.0
#include "render/tiled/tiled_frame.h"

#include <algorithm>

#include "base/clock.h"
#include "base/tasks.h"

namespace contrejour::inline internal::tiled {

TiledFrame::TiledFrame(const Frame& frame, const TiledOptions& options, const Context& context, const IrisShape& iris,
                       std::span<const Gain> gains, const HeldLimits& limits, std::span<const StopTransmittance> stops)
    : options_(options), context_(context), iris_(iris), gains_(gains), stops_(stops), limits_(limits),
      coarse_grid_{frame.width, frame.height, std::max(1, options.coarse_tile)},
      dense_grid_{frame.width, frame.height, options.dense_tile}, image_(frame.width, frame.height, 3) {
  context_.progress = {};
}

void TiledFrame::add(const PrimitiveBuffer& buffer) {
  for (const Primitive& primitive : buffer.primitives) {
    const std::uint64_t indices = dense_grid_.tile_count_of(primitive.pixels);
    if (held_.primitives.size() >= limits_.primitives || held_indices_ + indices > limits_.indices) draw();
    held_.append(primitive, buffer);
    held_indices_ += indices;
  }
}

void TiledFrame::draw() {
  const auto start = Clock::now();
  if (context_.cancelled() || held_.primitives.empty()) return;
  list();
  const auto listed = Clock::now();
  if (!context_.cancelled()) traverse();
  traversal_ms_ += ms_since(listed);
  primitives_ += held_.primitives.size();
  indices_ += dense_.indices.size();
  primitive_bytes_ = std::max(primitive_bytes_, held_.bytes());
  list_bytes_ = std::max(list_bytes_, dense_.bytes());
  held_.clear();
  held_indices_ = 0;
  draw_ms_ += ms_since(start);
}

void TiledFrame::list() {
  auto start = Clock::now();
  if (options_.coarse_tile == 0) {
    list_by_tile(held_.primitives, dense_grid_, context_, dense_);
    dense_ms_ += ms_since(start);
    return;
  }
  const bool listed = list_by_tile(held_.primitives, coarse_grid_, context_, coarse_);
  coarse_ms_ += ms_since(start);
  start = Clock::now();
  if (listed) refine_lists(held_.primitives, coarse_grid_, coarse_, dense_grid_, context_, dense_);
  dense_ms_ += ms_since(start);
}

void TiledFrame::traverse() {
  parallel_for(static_cast<std::size_t>(dense_grid_.rows()), context_, [&](std::size_t row) { traverse_row(row); });
}

void TiledFrame::traverse_row(std::size_t row) {
  const TraversalInput input{held_, gains_, iris_, stops_, options_.interpolation};
  const auto columns = static_cast<std::size_t>(dense_grid_.columns());
  const int size = dense_grid_.tile;
  const int y0 = static_cast<int>(row) * size;
  const int y1 = std::min(y0 + size, dense_grid_.height) - 1;
  TilePixels pixels;
  for (std::size_t column = 0; column < columns; ++column) {
    const auto list = dense_.of(row * columns + column);
    if (list.empty() || context_.cancelled()) continue;
    const int x0 = static_cast<int>(column) * size;
    pixels.load(image_, {x0, y0, std::min(x0 + size, dense_grid_.width) - 1, y1});
    traverse_tile(input, list, pixels);
    pixels.store(image_);
  }
}

void TiledFrame::report(RenderStatistics& stats) const {
  stats.primitives_merged = primitives_;
  stats.tile_indices = indices_;
  stats.primitive_bytes = primitive_bytes_;
  stats.tile_list_bytes = list_bytes_;
  stats.time_ms.insert(stats.time_ms.end(),
                       {{"coarse tiles", coarse_ms_}, {"dense tiles", dense_ms_}, {"traversal", traversal_ms_}});
}

}  // namespace contrejour::inline internal::tiled
