// SPDX-License-Identifier: Apache-2.0
// The data of an OpenEXR file that a Picture keeps besides its samples.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <ImfHeader.h>

#include "contrejour/image_io.h"

namespace contrejour::inline internal {

// A complete file of several parts, so that those without the picture can be copied.
struct PictureParts {
  std::vector<std::byte> file;
  int part = 0;  // the picture's
};

struct PictureHeader {
  Imf::Header header;
  std::shared_ptr<const PictureParts> parts = nullptr;  // null: a file of one part
};

[[nodiscard]] Imf::Header header_of(const Picture& picture);  // a copy, or a new one's attributes

// Imf::Header::erase of OpenEXR 3.1 forgets to free the attribute.
[[nodiscard]] Imf::Header without_attribute(const Imf::Header& header, const std::string& name);

}  // namespace contrejour::inline internal
