// SPDX-License-Identifier: Apache-2.0
// Relative spectral power of lamps, 5 nm from 380 to 780; see lamp_tables.cpp for their sources.
#pragma once

#include <array>

namespace contrejour::inline internal::cie {

inline constexpr double kLampFirstNm = 380;
inline constexpr double kLampStepNm = 5;
inline constexpr int kLampCount = 81;
extern const std::array<double, kLampCount> kLedB3, kSodiumHp1, kFluorescentFl2, kFluorescentFl11;

}  // namespace contrejour::inline internal::cie
