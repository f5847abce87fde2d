// SPDX-License-Identifier: Apache-2.0
// The patterns of a few wavelengths on a common grid as one texture of an atlas: one look-up serves all that are drawn
// together.
// Units: stop radii. Thread-safety: constant after construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "render/polygons/pattern_atlas.h"
#include "render/stop_patterns/pattern_texture.h"

namespace contrejour::inline internal::stop_patterns {

// parts: 1 to TextureTable::kWavelengths.
[[nodiscard]] raster::TextureTable texture_table(std::span<const PatternTexture* const> parts);

class BandTexture {
 public:
  // Adds the table to the atlas, which must outlive this object.
  BandTexture(raster::TextureTable table, raster::PatternAtlas& atlas);

  [[nodiscard]] std::uint32_t index() const { return index_; }  // in the atlas
  [[nodiscard]] bool of_one() const { return table_.of_one(); }  // wavelength
  // The index of the level whose samples, interpolated bilinearly, are means over about that width.
  [[nodiscard]] std::uint32_t level_for(double width) const;
  // The largest sample about `middle`, at the level whose samples are `distance` apart; if there is none, the largest
  // of the last level.
  [[nodiscard]] float brightest(Vec2 middle, double distance) const;

 private:
  std::uint32_t index_;
  const raster::TextureTable& table_;
};

}  // namespace contrejour::inline internal::stop_patterns
