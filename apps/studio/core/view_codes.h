// SPDX-License-Identifier: Apache-2.0
// From scene-linear values to the 8 bits of a window. Thread-safety: displayed() is pure; ViewPainter one thread at a
// time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/colour_view.h"
#include "contrejour/image.h"
#include "studio/core/baked_view.h"

namespace contrejour::studio {

enum class ViewTransform {
  Preview,      // sRGB with highlights rolled off; that of the command line's --preview
  Clipped,      // sRGB
  FalseColour,  // stops of luminance above and below mid grey
  Colour,       // a view of the OpenColorIO configuration: $OCIO, or the built-in one
};

// image values times 2^stops. One row after another; as many as the image has; bytes R, G, B, A in memory. `Colour` is
// ViewPainter's, and shown as a preview here.
[[nodiscard]] std::vector<std::uint32_t> displayed(const Image& rgb, double stops, ViewTransform transform);

// All of them, of pictures in any space; views of OpenColorIO by a table (baked_view.h), which takes a moment for each
// new view or space. Keeps the last one.
class ViewPainter {
 public:
  struct Codes {
    std::vector<std::uint32_t> rgba;
    std::string error;  // why a view cannot be used: the codes are then a preview's
  };
  [[nodiscard]] Codes codes(const Image& image, ColourSpace space, double stops, ViewTransform transform,
                            const ColourViewName& colour);

 private:
  [[nodiscard]] Result<std::vector<std::uint32_t>> by_colour_view(const Image& image, ColourSpace space, double stops,
                                                                  const ColourViewName& name);

  std::optional<BakedView> baked_;
  ColourViewName baked_name_;
  ColourSpace baked_space_ = ColourSpace::Rec709;
};

}  // namespace contrejour::studio
