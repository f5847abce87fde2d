// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace contrejour::inline internal {

// Largest resident size of this process so far; 0 if the system does not report it.
[[nodiscard]] std::uint64_t peak_memory_bytes();

// Allocates memory that is not cleared, aligned to a cache line, in large pages for large sizes where the system has
// them. Throws std::bad_alloc.
[[nodiscard]] void* allocate_large(std::size_t bytes);
void free_large(void* memory) noexcept;

}  // namespace contrejour::inline internal
