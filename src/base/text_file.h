#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "contrejour/result.h"

namespace contrejour {

// A whole file of at most so many bytes. if_absent: what to do where there is none. Errors: Io; Parse if it is larger.
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t max_bytes,
                                                 std::string_view if_absent);

}  // namespace contrejour
