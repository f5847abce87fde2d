// SPDX-License-Identifier: Apache-2.0
// The only file that queries the system about the terminal and the standard streams.
#pragma once

#include <string_view>

namespace contrejour::cli {

[[nodiscard]] bool error_stream_is_terminal();

// Writes to the standard output without its buffer, so that a failure leaves nothing in the buffer.
void write_unchecked(std::string_view text);

// Opens closed standard streams (`>&-`), which stay unusable, so that no file that is opened later takes their place
// and receives printed text. Must be called before anything else is opened.
void occupy_standard_streams();

}  // namespace contrejour::cli
