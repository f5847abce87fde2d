// SPDX-License-Identifier: Apache-2.0
// Whether the tests are built with sanitizers, which take 5 to 20 times as long.
#pragma once

namespace contrejour::test {

#ifdef CONTREJOUR_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace contrejour::test
