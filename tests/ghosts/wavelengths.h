// SPDX-License-Identifier: Apache-2.0
// Wavelengths that the tests of ghosts use.
#pragma once

namespace contrejour::test {

inline constexpr double kGreen_nm = 550.0;

}  // namespace contrejour::test
