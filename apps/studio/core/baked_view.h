// SPDX-License-Identifier: Apache-2.0
// A view of OpenColorIO as a table of its codes, for pictures that change while one looks at them: ACES takes 220 ns a
// pixel, the table 26. Scene-linear values are spaced by their logarithms, four for each stop, and linearly near black;
// codes between them are interpolated, but where the view bends too sharply for that, as at the edge of the display's
// gamut. There, and for values above 1024, each pixel takes the view's own time.
// Errors: those of the view. Accuracy: 3 of 255 codes, 0.15 on average, rounding included (test_view_codes.cpp);
// negative values are taken as black. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/expert/colour_view.h"

namespace contrejour::studio {

class BakedView {
 public:
  using Entry = std::array<float, 4>;  // R, G, B, 0 to 255, and whether the cell that begins here is not interpolated

  // From scene-linear values of the space.
  [[nodiscard]] static Result<BakedView> bake(ColourView view, ColourSpace space);

  // rgb: triples of values, each times `gain`; as many codes (bytes R, G, B, A in memory).
  [[nodiscard]] Result<void> codes(std::span<const float> rgb, float gain, std::span<std::uint32_t> codes) const;

 private:
  [[nodiscard]] Result<void> exact_codes(std::span<const float> rgb, float gain, std::span<const std::size_t> pixels,
                                         std::span<std::uint32_t> codes) const;

  ColourView view_;
  ColourSpace space_ = ColourSpace::Rec709;
  std::vector<Entry> table_;  // red changes fastest
};

}  // namespace contrejour::studio
