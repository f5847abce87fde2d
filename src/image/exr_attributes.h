// SPDX-License-Identifier: Apache-2.0
// Checks an OpenEXR file's header before the library reads it, since the library allocates the sizes that it states.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "contrejour/result.h"

namespace contrejour::inline internal {

struct ExrHeaderSize {
  std::size_t bytes = 0;  // of magic, version and attributes
  bool is_multi_part = false;
};

// Errors: Parse (an attribute is larger than the file or not of its type's size), Unsupported (deep and single-part,
// newer version, an attribute that the library misreads).
[[nodiscard]] Result<ExrHeaderSize> check_exr_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace contrejour::inline internal
