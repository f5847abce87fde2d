// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"
#include "contrejour/image.h"

namespace contrejour::detail {

void* allocate_pixels(std::size_t bytes) { return allocate_large(bytes); }

void free_pixels(void* pixels) noexcept { free_large(pixels); }

}  // namespace contrejour::detail
