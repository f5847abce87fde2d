// SPDX-License-Identifier: Apache-2.0
// The files that `contrejour apply` writes. Each function writes into a file that the caller commits (output_file.h);
// the format is that of the destination's extension. Errors: those of write_picture, with position.file set.
// Thread-safety: pure functions, one file each.
#pragma once

#include <filesystem>

#include "contrejour/context.h"
#include "contrejour/expert/flare_plan.h"
#include "contrejour/expert/output_file.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/result.h"

namespace contrejour {

// Writes the photograph with its flare. A PNG is a preview, with the exposure that the values give, if any.
[[nodiscard]] CONTREJOUR_API Result<void> write_photograph(OutputFile& file, const Picture& picture,
                                                           const params::Values& values, const Context& context = {});

// Writes a photograph to which no flare was added by copying the bytes of its input file, so that not even the
// compression changes. If the format differs, a PNG has an exposure, or the input cannot be read twice (a pipe), the
// picture is written instead. Errors: also Io, if the input cannot be read again.
[[nodiscard]] CONTREJOUR_API Result<void> copy_photograph(OutputFile& file, const std::filesystem::path& input,
                                                          const Picture& picture, const params::Values& values,
                                                          const Context& context = {});

// An image of the photograph's size, such as its flare, as a picture of its own that is aligned with the photograph:
// with its windows, and the plan's colour space and pixel aspect.
[[nodiscard]] CONTREJOUR_API Picture aligned_picture(const Image& image, const Picture& picture, const FlarePlan& plan);

// Writes such a picture.
[[nodiscard]] CONTREJOUR_API Result<void> write_aligned(OutputFile& file, const Image& image, const Picture& picture,
                                                        const FlarePlan& plan, const Context& context = {});

// Writes the lights detected in the photograph without flare: an EXR of their pixels, or a PNG of the photograph in dim
// grey with each light in a colour of its own (detected_picture.h).
[[nodiscard]] CONTREJOUR_API Result<void> write_detected(OutputFile& file, const Picture& picture,
                                                         const FlarePlan& plan, const Context& context = {});

}  // namespace contrejour
