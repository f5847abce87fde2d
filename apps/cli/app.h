// The program: reads the command line, runs the sub-command it names, turns its result into an exit code.
#pragma once

#include <string>
#include <vector>

namespace contrejour::cli {

// Arguments without the program's name. 0 done, 1 failed, 2 usage, 130 interrupted.
int run(std::vector<std::string> arguments);

}  // namespace contrejour::cli
