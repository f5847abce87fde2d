// What a Picture keeps of an OpenEXR file beside its samples.
#pragma once

#include <ImfHeader.h>

#include "contrejour/image_io.h"

namespace contrejour {

struct PictureHeader {
  Imf::Header header;
};

[[nodiscard]] Imf::Header header_of(const Picture& picture);  // a copy, or a new one's attributes

}  // namespace contrejour
