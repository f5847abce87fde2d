// SPDX-License-Identifier: Apache-2.0
// The page for the laboratory: how to set up and photograph a sweep, after walch2018 3.1.
#pragma once

#include <span>
#include <string>

#include "contrejour/expert/capture_list.h"

namespace contrejour::cli {

[[nodiscard]] std::string protocol_page(const CapturePlan& plan, std::span<const PlannedCapture> captures);

}  // namespace contrejour::cli
