// SPDX-License-Identifier: Apache-2.0
// A record of how a frame's files were made, beside them: FOLDER/.contrejour/NAME.txt. It lists the settings, and the
// sizes and times of the files that were read and written, so that a later run can tell which frames are done.
// Thread-safety: pure functions, which look at files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

struct FrameFiles {
  std::string settings;  // as text; whatever its form, the same settings must give the same text
  std::vector<std::filesystem::path> inputs;
  std::vector<std::filesystem::path> outputs;  // not empty; the first gives the record its name
};

// Call it after the outputs were written. Errors: Io.
[[nodiscard]] CONTREJOUR_API Result<void> write_frame_record(const FrameFiles& files);

// True if all outputs exist and neither they, nor the inputs, nor the settings have changed since the record was
// written.
[[nodiscard]] CONTREJOUR_API bool is_frame_done(const FrameFiles& files);

}  // namespace contrejour
