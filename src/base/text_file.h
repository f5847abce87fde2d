// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "contrejour/result.h"

namespace contrejour::inline internal {

// Reads a whole file of at most max_bytes. if_absent: advice for the error if it does not exist. Errors: Io; Parse if
// it is larger.
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t max_bytes,
                                                 std::string_view if_absent);

}  // namespace contrejour::inline internal
