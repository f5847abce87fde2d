// Ctrl-C and SIGTERM: a flag that long work looks at, so that it stops in good order and leaves no file.
#pragma once

#include <atomic>

namespace contrejour::cli {

[[nodiscard]] const std::atomic<bool>& interrupt_flag();
void catch_interrupts();  // and lets writing beyond a limit of files' sizes fail as on a full disk

}  // namespace contrejour::cli
