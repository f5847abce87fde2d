// SPDX-License-Identifier: Apache-2.0
// Converts a sample of a file to a scene-linear float and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "contrejour/image_io.h"

namespace contrejour::inline internal {

// IEC 61966-2-1:1999 (sRGB), 0..1 to 0..1; encoding clips, and NaN becomes 0.
[[nodiscard]] float srgb_decode(double coded);
[[nodiscard]] float srgb_encode(float linear);

// Colour samples of 8 and 16 bits are sRGB, `linear` ones (alpha) are not; the other types are linear as they are.
enum class Coding { Colour, Linear };

[[nodiscard]] std::vector<float> decode_samples(const PictureChannel& channel, Coding coding);

// Finite values beyond the type's range become its largest value; integers are rounded, with 0 for NaN.
void encode_sample(SampleType type, Coding coding, float value, std::byte* out);

// Sample count of a channel over a window that starts at a multiple of its sampling.
[[nodiscard]] std::size_t sample_count(const PixelWindow& window, int x_sampling, int y_sampling);

// The samples of channel k to write: the bits that were read where rgb is unchanged, elsewhere rgb encoded as `type`. A
// type other than the channel's own encodes all samples anew. Rows are from the top. A PNG's alpha is raised to the
// brightest of a pixel's colours, which are divided by it for writing: light that was added in transparent areas is
// kept.
[[nodiscard]] std::vector<std::byte> samples_to_write(const Picture& picture, std::size_t k, SampleType type);

// The component of rgb (0..2) that comes from channel k, 3 for all of them (grey), -1 for none.
[[nodiscard]] int rgb_component(const Picture& picture, std::size_t k);

[[nodiscard]] bool is_alpha(const PictureChannel& channel);  // "A", with a sample for each pixel
// The samples of the picture's alpha, empty if there is none. Colours are multiplied by it in memory and
// in OpenEXR, not in PNG.
[[nodiscard]] std::vector<float> alpha_of(const Picture& picture);

}  // namespace contrejour::inline internal
