// SPDX-License-Identifier: Apache-2.0
// The picture of `contrejour render`, as a file. Thread-safety: pure, but for the file.
#pragma once

#include <string>

#include "contrejour/context.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/lens.h"

namespace contrejour::studio {

// .exr: scene-linear; .png: the preview, in the values' exposure. Errors: Unsupported for another extension; those of
// render() and of writing.
[[nodiscard]] Result<void> export_picture(const params::Values& values, const LensState& lens, const std::string& file,
                                          const Context& context = {});

}  // namespace contrejour::studio
