// SPDX-License-Identifier: Apache-2.0
// The program: reads the command line, runs the sub-command that it names, and turns the result into an exit code.
#pragma once

#include <string>
#include <vector>

namespace contrejour::cli {

// Takes the arguments without the program's name. Returns 0 if done, 1 if failed, 2 for wrong usage, 130 if
// interrupted.
int run(std::vector<std::string> arguments);

}  // namespace contrejour::cli
