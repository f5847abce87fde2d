// SPDX-License-Identifier: Apache-2.0
// The frames of a shot through `render`, each as one by itself; what changes from frame to frame is in --lights FILE.
#pragma once

#include "cli/animation_option.h"
#include "cli/render_frame.h"
#include "cli/sequence_options.h"

namespace contrejour::cli {

// The names of the outputs have a place for the number of a frame. Returns the exit code.
[[nodiscard]] Result<int> render_sequence(const RenderOptions& options, const FrameValues& values,
                                          const SequenceOptions& sequence);

}  // namespace contrejour::cli
