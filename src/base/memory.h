#pragma once

#include <cstddef>
#include <cstdint>

namespace contrejour {

// Largest resident size of this process so far; 0 where the system does not tell.
[[nodiscard]] std::uint64_t peak_memory_bytes();

// Memory that is not cleared, from a line of the cache on, in large pages where it is worth it and the system has them.
// Throws std::bad_alloc.
[[nodiscard]] void* allocate_large(std::size_t bytes);
void free_large(void* memory) noexcept;

}  // namespace contrejour
