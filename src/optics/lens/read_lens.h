// What the readers of lens files share.
#pragma once

#include <cstddef>

namespace contrejour {

// The largest real prescriptions take a few kB; the bound keeps hostile files cheap.
inline constexpr std::size_t kMaxLensFileBytes = 1'000'000;

}  // namespace contrejour
