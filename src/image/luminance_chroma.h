// Pictures of luminance and chroma of half the size, as OpenEXR's RGBA interface has them: Y, RY = (R - Y) / Y and
// BY = (B - Y) / Y, the last two low-pass filtered and of every second pixel each way (ImfRgbaYca.h).
// Errors: OpenEXR's exceptions, for what calls to let none out.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "contrejour/image_io.h"

namespace contrejour {

[[nodiscard]] bool is_luminance_chroma(const Picture& picture);

// Whether the channels behind it have the sizes of this format.
[[nodiscard]] bool has_chroma_sizes(const Picture& picture);

// The colours of the picture's channels, as OpenEXR's own reader makes them.
[[nodiscard]] Image rgb_of_luminance_chroma(const Picture& picture);

// Samples of Y, RY and BY for picture.rgb. Where neither a pixel nor, for chroma, any within the filter's reach (13
// pixels each way) has changed, the bits that were read.
[[nodiscard]] std::array<std::vector<std::byte>, 3> luminance_chroma_to_write(const Picture& picture);

// The same picture with channels R, G, B in their place, for files that have no such format.
[[nodiscard]] Picture with_rgb_channels(const Picture& picture);

}  // namespace contrejour
