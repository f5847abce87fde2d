// SPDX-License-Identifier: Apache-2.0
// Checks that an OpenEXR file is large enough for the picture that its header states.
#pragma once

#include <cstdint>

#include <ImfHeader.h>
#include <ImfPixelType.h>

#include "contrejour/image_io.h"

namespace contrejour::inline internal {

// Errors: Unsupported (beyond the limits), Parse (the file is too small for it).
[[nodiscard]] Result<void> check_exr_size(const Imf::Header& header, std::uint64_t header_bytes,
                                          std::uint64_t file_bytes, const ReadLimits& limits, const std::string& name);

[[nodiscard]] SampleType sample_type_of(Imf::PixelType type);
[[nodiscard]] PixelWindow window_of(const Imath::Box2i& box);

}  // namespace contrejour::inline internal
