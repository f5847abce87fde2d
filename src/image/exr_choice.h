// SPDX-License-Identifier: Apache-2.0
// Selects the colour channels of an OpenEXR file, and their part: docs/formats/images.md.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include <ImfHeader.h>

#include "contrejour/image_io.h"

namespace contrejour::inline internal {

// Indices of the channels for r, g and b, and of those with chroma (then all of rgb are the luminance).
struct ColourChannels {
  std::array<int, 3> rgb{-1, -1, -1};
  std::array<int, 2> chroma{-1, -1};
};

// The colour channels of a layer; without a layer, those that ReadOptions names.
[[nodiscard]] std::optional<ColourChannels> colour_channels(const Picture& picture, const std::string& layer);

// The error for a picture without that colour; it names the picture's layers and channels.
[[nodiscard]] tl::unexpected<Error> no_colour(const Picture& picture, const std::string& layer,
                                              const std::string& name);

struct ChosenPart {
  int part = 0;
  std::string layer;  // of that part
};

// Errors: Unsupported (no such part or layer, with those that there are; a deep part).
[[nodiscard]] Result<ChosenPart> choose_part(std::span<const Imf::Header* const> parts, const std::string& name,
                                             const ReadOptions& options);
// The same check for a file of one part, which is number 0 and may have a name.
[[nodiscard]] Result<void> check_only_part(const Imf::Header& header, const std::string& name,
                                           const ReadOptions& options);

}  // namespace contrejour::inline internal
