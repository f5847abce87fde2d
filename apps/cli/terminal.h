// The one place that asks the system about the terminal.
#pragma once

namespace contrejour::cli {

[[nodiscard]] bool error_stream_is_terminal();

}  // namespace contrejour::cli
