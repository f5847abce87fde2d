// The one place that asks the system about the terminal and the standard streams.
#pragma once

#include <string_view>

namespace contrejour::cli {

[[nodiscard]] bool error_stream_is_terminal();

// To the standard output past its buffer, so that a failure leaves no trace in it.
void write_unchecked(std::string_view text);

// Closed standard streams (`>&-`) stay unusable, but are open, so that no file that is opened later takes their place
// and gets what is printed. Before anything else is opened.
void occupy_standard_streams();

}  // namespace contrejour::cli
