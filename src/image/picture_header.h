// What a Picture keeps of an OpenEXR file beside its samples.
#pragma once

#include <ImfHeader.h>

#include "contrejour/image_io.h"

namespace contrejour {

struct PictureHeader {
  Imf::Header header;
};

[[nodiscard]] Imf::Header header_of(const Picture& picture);  // a copy, or a new one's attributes

// Imf::Header::erase of OpenEXR 3.1 forgets to free the attribute.
[[nodiscard]] Imf::Header without_attribute(const Imf::Header& header, const std::string& name);

}  // namespace contrejour
