// SPDX-License-Identifier: Apache-2.0
// Photographs in the formats and colour spaces of cameras and film: besides OpenEXR and PNG (image_io.h) DPX, TIFF,
// JPEG and Radiance HDR by OpenImageIO, and the spaces of an OpenColorIO configuration (docs/formats/images.md).
// A plate becomes a scene-linear Picture, and is written back without a change of the samples whose light did not
// change. OpenImageIO and OpenColorIO are modules that are loaded when they are needed first.
// Errors: those of read_picture and write_picture; Unsupported where a module is not installed; InvalidArgument for a
// colour space that the configuration has not. Thread-safety: pure functions.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "contrejour/context.h"
#include "contrejour/export.h"
#include "contrejour/image_io.h"
#include "contrejour/result.h"

namespace contrejour {

class OutputFile;

struct PlateColour {
  // The space of the file's values. Empty: as its format says (linear for floats, sRGB for integers).
  std::string input_space;
  // The space to write. Empty: the file's own where the format is the same; else as the format says.
  std::string output_space;
  // The OpenColorIO configuration: a file. Empty: $OCIO; if that is not set, a configuration of the ACES spaces, camera
  // logs and displays that OpenColorIO has built in.
  std::string config;
};

inline namespace internal {
struct PlateSource;  // how the file codes the picture
}

struct Plate {
  Picture picture;  // scene-linear, Rec.709 or ACEScg (colour_space_of)
  std::shared_ptr<const PlateSource> source;  // null: a picture of read_picture without an input space
};

[[nodiscard]] CONTREJOUR_API Result<Plate> read_plate(const std::filesystem::path& file, const ReadOptions& options,
                                                      const PlateColour& colour = {});

// `picture`: that of the plate, with more light. Writes by the extension: one of is_plate_name.
[[nodiscard]] CONTREJOUR_API Result<void> write_plate(OutputFile& file, const Picture& picture,
                                                      const std::shared_ptr<const PlateSource>& source,
                                                      const PlateColour& colour, const Context& context = {});

// True for .exr, .png, .dpx, .tif, .tiff, .jpg, .jpeg, .hdr, in any case.
[[nodiscard]] CONTREJOUR_API bool is_plate_name(const std::filesystem::path& file);

// The configuration in use: colour.config, or $OCIO; empty for the one of OpenColorIO's own spaces.
[[nodiscard]] CONTREJOUR_API std::string colour_config(const PlateColour& colour);

}  // namespace contrejour
