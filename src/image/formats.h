// SPDX-License-Identifier: Apache-2.0
// One reader and one writer for each format; picture.cpp selects them. No exception leaves a reader; writers may throw
// bad_alloc.
#pragma once

#include <span>
#include <string>

#include "contrejour/expert/output_file.h"
#include "contrejour/image_io.h"

namespace contrejour::inline internal {

[[nodiscard]] Result<Picture> read_exr(std::span<const std::byte> bytes, const std::string& name,
                                       const ReadOptions& options);
[[nodiscard]] Result<Picture> read_png(std::span<const std::byte> bytes, const std::string& name,
                                       const ReadLimits& limits);
// Creates a file with what write(OutputFile&) writes, or none if it fails.
template <class Write>
[[nodiscard]] Result<void> write_whole(const std::filesystem::path& file, const Write& write) {
  auto out = OutputFile::create(file);
  if (!out) return tl::unexpected(out.error());
  if (Result<void> written = write(*out); !written) return written;
  return out->commit();
}

[[nodiscard]] Result<void> write_picture_exr(OutputFile& file, const Picture& picture, const Context& context);
[[nodiscard]] Result<void> write_picture_png(OutputFile& file, const Picture& picture, const Context& context);

}  // namespace contrejour::inline internal
