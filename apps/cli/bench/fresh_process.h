// Another run of this very program, whose memory and caches are as cold as a user's first frame finds them.
#pragma once

#include <string>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::cli {

// What it prints on its standard output, at most a few thousand characters. Errors: Unsupported where this system gives
// no way to start it; Io where it ends with anything but 0 (its own message is on the standard error by then).
[[nodiscard]] Result<std::string> output_of_fresh_process(const std::vector<std::string>& arguments);

}  // namespace contrejour::cli
