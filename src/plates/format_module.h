// SPDX-License-Identifier: Apache-2.0
// The functions of the module for formats other than OpenEXR and PNG (plate_modules/openimageio.cpp).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contrejour/image_io.h"

namespace contrejour::inline internal {

// A picture as its file codes it.
struct CodedImage {
  int width = 0, height = 0, channels = 0;
  SampleType type = SampleType::UInt8;
  int bits = 8;                           // of an integer sample; fewer than its type has are the highest ones
  bool is_film_log = false;               // the file says that it codes printing density
  std::vector<std::byte> samples;         // interleaved, native-endian, rows from the top
  std::shared_ptr<const void> header;     // the module's own: all that the file states besides; null for a new file
};

struct FormatModule {
  const char* version;  // of this interface; another one is refused
  // format: "dpx", "tiff", "jpeg" or "hdr". Errors: Parse, Unsupported, without the file's name.
  Result<CodedImage> (*read)(std::span<const std::byte> bytes, const std::string& format, const ReadLimits& limits);
  Result<std::vector<std::byte>> (*write)(const CodedImage& image, const std::string& format);
};

inline constexpr const char* kFormatModuleVersion = "1";
inline constexpr const char* kFormatModuleName = "openimageio";
inline constexpr const char* kFormatModuleFunction = "contrejour_format_module";

}  // namespace contrejour::inline internal
