// SPDX-License-Identifier: Apache-2.0
// The CIE tables behind colour.h; see cie_tables.cpp for their sources.
#pragma once

#include <array>

namespace contrejour::inline internal::cie {

inline constexpr int kObserverFirstNm = 360;
inline constexpr int kObserverLastNm = 830;
inline constexpr int kObserverCount = kObserverLastNm - kObserverFirstNm + 1;
extern const std::array<std::array<double, 3>, kObserverCount> kObserver1931;

inline constexpr int kD65FirstNm = 300;
inline constexpr int kD65StepNm = 10;
inline constexpr int kD65Count = 54;
extern const std::array<double, kD65Count> kIlluminantD65;

}  // namespace contrejour::inline internal::cie
