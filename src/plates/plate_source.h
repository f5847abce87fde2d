// SPDX-License-Identifier: Apache-2.0
// How a plate's file codes its picture, for writing it back.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "contrejour/image_io.h"
#include "plates/format_module.h"

namespace contrejour::inline internal {

struct PlateSource {
  std::string format;       // "exr", "png" or OpenImageIO's name
  std::string space;        // of the file's values; empty: as the format says
  CodedImage file;          // without samples; of formats that the module reads
  // With a space: the picture's rgb as it was read and as it was converted, and the header of an OpenEXR file.
  Image as_read, as_converted;
  std::shared_ptr<const PictureHeader> header;
};

}  // namespace contrejour::inline internal
