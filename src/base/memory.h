#pragma once

#include <cstdint>

namespace contrejour {

// Largest resident size of this process so far; 0 where the system does not tell.
[[nodiscard]] std::uint64_t peak_memory_bytes();

}  // namespace contrejour
