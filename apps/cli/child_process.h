// SPDX-License-Identifier: Apache-2.0
// Runs other programs, or this one anew, and reads what they print.
#pragma once

#include <string>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::cli {

enum class ChildErrors { Shown, Hidden };  // whether the user sees the standard error of the process

struct ChildOutput {
  std::string text;   // of its standard output
  int exit_code = 0;  // 255 if a signal ended it
};

// Runs a program, found on the PATH unless its name has a slash, and waits for its end. Errors: Unsupported on systems
// other than Linux and macOS; Io if the program cannot be started.
[[nodiscard]] Result<ChildOutput> run_child(const std::string& program, const std::vector<std::string>& arguments,
                                            ChildErrors errors = ChildErrors::Shown);

// Runs this program in a new process, with memory and caches as cold as at a user's first frame. Returns what it
// prints on its standard output. Errors: also Io if its exit status is not 0 (its own message is on the standard error
// by then).
[[nodiscard]] Result<std::string> output_of_fresh_process(const std::vector<std::string>& arguments);

// Becomes another program, which keeps this one's standard streams; returns only where it could not. Errors: as
// run_child().
[[nodiscard]] Error become(const std::string& program, const std::vector<std::string>& arguments);

// The file of this program. Errors: Unsupported where the system does not say.
[[nodiscard]] Result<std::string> this_program();

}  // namespace contrejour::cli
