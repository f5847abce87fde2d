// SPDX-License-Identifier: Apache-2.0
// The machine that a measurement is made on.
#pragma once

#include <string>

#include "cli/console.h"

namespace contrejour::cli {

struct Machine {
  std::string processor;  // the maker's name for it, if the system provides it
  unsigned cores = 0;     // that this program may use
  std::string system, compiler;
};

[[nodiscard]] Machine this_machine();
[[nodiscard]] Json machine_json(const Machine& machine);

}  // namespace contrejour::cli
