// SPDX-License-Identifier: Apache-2.0
// Runs this program in a new process, with memory and caches as cold as at a user's first frame.
#pragma once

#include <string>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::cli {

// Returns what the process prints on its standard output, at most a few thousand characters. Errors: Unsupported if
// this system cannot start it; Io if its exit status is not 0 (its own message is on the standard error by then).
[[nodiscard]] Result<std::string> output_of_fresh_process(const std::vector<std::string>& arguments);

}  // namespace contrejour::cli
