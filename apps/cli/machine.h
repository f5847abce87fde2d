// What a measurement was made on.
#pragma once

#include <string>

#include "cli/console.h"

namespace contrejour::cli {

struct Machine {
  std::string processor;  // its maker's name, where the system tells
  unsigned cores = 0;     // that this program may use
  std::string system, compiler;
};

[[nodiscard]] Machine this_machine();
[[nodiscard]] Json machine_json(const Machine& machine);

}  // namespace contrejour::cli
