// A look at an OpenEXR file's header before the library reads it: the library allocates what sizes in it say.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "contrejour/result.h"

namespace contrejour {

// The size of magic, version and attributes. Errors: Parse (an attribute is larger than the file or not of its type's
// size), Unsupported (multi-part, deep, newer version).
[[nodiscard]] Result<std::size_t> check_exr_header(std::span<const std::byte> bytes, const std::string& name);

}  // namespace contrejour
