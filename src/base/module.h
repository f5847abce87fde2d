// SPDX-License-Identifier: Apache-2.0
// Parts of the library in files of their own, which are loaded when they are needed first: what they link is large, and
// most programs never use it.
#pragma once

#include <string>

#include "contrejour/result.h"

namespace contrejour::inline internal {

// The address of a function in contrejour-NAME.so, which lies beside the program or library that this code is in, or
// in the folder where modules are installed. A module stays loaded. Errors: Unsupported, if there is no such module or
// it cannot be loaded, with the reason. Thread-safe.
[[nodiscard]] Result<void*> module_function(const std::string& name, const std::string& function);

}  // namespace contrejour::inline internal
