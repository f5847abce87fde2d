// SPDX-License-Identifier: Apache-2.0
// The photographs of a sequence through `apply`, each as one by itself.
#pragma once

#include "cli/animation_option.h"
#include "cli/apply_frame.h"
#include "cli/sequence_options.h"

namespace contrejour::cli {

// The names in the options have a place for the number of a frame. Returns the exit code.
[[nodiscard]] Result<int> apply_to_sequence(const ApplyOptions& options, const FrameValues& values,
                                            const SequenceOptions& sequence);

}  // namespace contrejour::cli
