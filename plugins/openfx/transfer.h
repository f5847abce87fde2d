// SPDX-License-Identifier: Apache-2.0
// The curves by which a host's pixels may be coded. Light adds in scene-linear, so a source is decoded before its flare
// is added, and encoded afterwards. Thread-safety: pure functions.
#pragma once

#include <string>
#include <vector>

namespace contrejour::openfx {

// In the order of the menu.
enum class TransferCurve { Linear, Srgb, Gamma22, Gamma24, AcesCct, LogC3, LogC4, SLog3 };

[[nodiscard]] std::vector<std::string> transfer_menu();

// Curves with a power are odd, so that negative values stay what they are.
[[nodiscard]] double linear_from(double coded, TransferCurve curve);
[[nodiscard]] double coded_from(double linear, TransferCurve curve);

}  // namespace contrejour::openfx
