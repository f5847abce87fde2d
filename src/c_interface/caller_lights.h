// SPDX-License-Identifier: Apache-2.0
// A C caller's lights as the library's. Thread-safety: pure functions, which may read files that a spectrum names.
#pragma once

#include <vector>

#include "c_interface/boundary.h"
#include "contrejour/light.h"

namespace contrejour::inline internal {

// An array whose elements lie the first one's struct_size apart. Errors: InvalidArgument for NULL with a count, for a
// direction of no length; those of find_spectrum().
[[nodiscard]] Result<std::vector<Light>> lights_of(const cj_light* lights, std::size_t count);

}  // namespace contrejour::inline internal
