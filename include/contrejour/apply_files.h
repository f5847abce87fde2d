// The files that `contrejour apply` writes. Each function writes into a file that the caller commits (output_file.h);
// the format is that of the destination's extension. Errors: those of write_picture, with place.file set.
// Thread-safety: pure functions, one file each.
#pragma once

#include <filesystem>

#include "contrejour/context.h"
#include "contrejour/flare_plan.h"
#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/output_file.h"
#include "contrejour/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour {

// The photograph with its flare. A PNG is to look at: it is exposed as the values say, where they say it.
[[nodiscard]] Result<void> write_photograph(OutputFile& file, const Picture& picture, const params::Values& values,
                                            const Context& context = {});

// A photograph to which no flare was added, and the file it was read from: the bytes of that file, so that not even its
// compression changes. Another format, a PNG with an exposure, and an input that cannot be read twice (a pipe) are
// written from the picture. Errors: also Io, where the input cannot be read again.
[[nodiscard]] Result<void> copy_photograph(OutputFile& file, const std::filesystem::path& input, const Picture& picture,
                                           const params::Values& values, const Context& context = {});

// An image as large as the photograph, such as its flare: a picture of its own with the photograph's windows, the
// plan's colour space and pixel aspect.
[[nodiscard]] Result<void> write_beside(OutputFile& file, const Image& image, const Picture& picture,
                                        const FlarePlan& plan, const Context& context = {});

// What counts as lights in the photograph without flare: an EXR of their pixels, or a PNG of the photograph in dim grey
// with each light in a colour of its own (detected_picture.h).
[[nodiscard]] Result<void> write_detected(OutputFile& file, const Picture& picture, const FlarePlan& plan,
                                          const Context& context = {});

}  // namespace contrejour
