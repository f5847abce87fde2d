// SPDX-License-Identifier: Apache-2.0
// Unit conversions.
#pragma once

#include <numbers>

namespace contrejour::inline internal {

constexpr double rad_from_deg(double deg) { return deg * std::numbers::pi / 180.0; }
constexpr double deg_from_rad(double rad) { return rad * 180.0 / std::numbers::pi; }
constexpr double um_from_nm(double nm) { return nm * 1e-3; }
constexpr double mm_from_nm(double nm) { return nm * 1e-6; }

}  // namespace contrejour::inline internal
