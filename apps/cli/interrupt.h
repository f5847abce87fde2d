// Ctrl-C and SIGTERM: a flag that long work looks at, so that it stops in good order and leaves no file.
#pragma once

#include <atomic>

namespace contrejour::cli {

[[nodiscard]] const std::atomic<bool>& interrupt_flag();
void catch_interrupts();

}  // namespace contrejour::cli
