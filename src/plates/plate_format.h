// SPDX-License-Identifier: Apache-2.0
// The formats of plates: by a file's first bytes, and by its name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "contrejour/image_io.h"
#include "plates/format_module.h"

namespace contrejour::inline internal {

// "dpx", "tiff", "jpeg" or "hdr", OpenImageIO's names; empty for OpenEXR, PNG and anything else.
[[nodiscard]] std::string module_format_of(std::span<const std::byte> first_bytes);
// The same by a name's extension; "exr" and "png" too.
[[nodiscard]] std::string format_of_name(const std::filesystem::path& file);

// The module that reads and writes these formats.
[[nodiscard]] Result<const FormatModule*> format_module();

// True if the format would hold the picture's colours as integers, which its writer codes as sRGB.
[[nodiscard]] bool stored_as_integers(const Picture& picture, const std::string& format);

// The file's picture: integers are coded as sRGB, as in a PNG.
[[nodiscard]] Picture picture_of_coded(const CodedImage& image);
// The picture as `format` holds it. from: the file of this format that it came from, or null.
[[nodiscard]] CodedImage coded_picture(const Picture& picture, const std::string& format, const CodedImage* from);

}  // namespace contrejour::inline internal
