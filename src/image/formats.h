// One reader and one writer a format; picture.cpp chooses. Readers let no exception out; writers may throw bad_alloc.
#pragma once

#include <span>
#include <string>

#include "contrejour/image_io.h"

namespace contrejour {

[[nodiscard]] Result<Picture> read_exr(std::span<const std::byte> bytes, const std::string& name,
                                       const ReadOptions& options);
[[nodiscard]] Result<Picture> read_png(std::span<const std::byte> bytes, const std::string& name,
                                       const ReadLimits& limits);
[[nodiscard]] Result<void> write_picture_exr(const std::filesystem::path& file, const Picture& picture,
                                             const Context& context);
[[nodiscard]] Result<void> write_picture_png(const std::filesystem::path& file, const Picture& picture,
                                             const Context& context);

}  // namespace contrejour
