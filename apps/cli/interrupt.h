// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM set a flag that long tasks check, so that they stop in an orderly way and leave no file.
#pragma once

#include <atomic>

namespace contrejour::cli {

[[nodiscard]] const std::atomic<bool>& interrupt_flag();
void catch_interrupts();  // also makes writing beyond a file size limit fail as on a full disk

}  // namespace contrejour::cli
