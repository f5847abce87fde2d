// SPDX-License-Identifier: Apache-2.0
// Pictures of luminance and chroma of half the size, as in OpenEXR's RGBA interface: Y, RY = (R - Y) / Y and
// BY = (B - Y) / Y, the last two low-pass filtered and of every second pixel each way (ImfRgbaYca.h).
// Errors: OpenEXR's exceptions, which callers must catch.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "contrejour/image_io.h"

namespace contrejour::inline internal {

[[nodiscard]] bool is_luminance_chroma(const Picture& picture);

// True if the channels have the sizes of this format.
[[nodiscard]] bool has_chroma_sizes(const Picture& picture);

// The colours of the picture's channels, as OpenEXR's own reader computes them.
[[nodiscard]] Image rgb_of_luminance_chroma(const Picture& picture);

// Samples of Y, RY and BY for picture.rgb. Samples keep the bits that were read unless their pixel, or for chroma any
// pixel within the filter's radius (13 pixels), has changed.
[[nodiscard]] std::array<std::vector<std::byte>, 3> luminance_chroma_to_write(const Picture& picture);

// The same picture with channels R, G, B in their place, for files without this format.
[[nodiscard]] Picture with_rgb_channels(const Picture& picture);

}  // namespace contrejour::inline internal
