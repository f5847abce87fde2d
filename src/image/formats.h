// One reader and one writer a format; picture.cpp chooses. Readers let no exception out; writers may throw bad_alloc.
#pragma once

#include <span>
#include <string>

#include "contrejour/image_io.h"
#include "contrejour/output_file.h"

namespace contrejour {

[[nodiscard]] Result<Picture> read_exr(std::span<const std::byte> bytes, const std::string& name,
                                       const ReadOptions& options);
[[nodiscard]] Result<Picture> read_png(std::span<const std::byte> bytes, const std::string& name,
                                       const ReadLimits& limits);
// A file that holds what write(OutputFile&) puts into it, or none.
template <class Write>
[[nodiscard]] Result<void> write_whole(const std::filesystem::path& file, const Write& write) {
  auto out = OutputFile::create(file);
  if (!out) return tl::unexpected(out.error());
  if (Result<void> written = write(*out); !written) return written;
  return out->commit();
}

[[nodiscard]] Result<void> write_picture_exr(OutputFile& file, const Picture& picture, const Context& context);
[[nodiscard]] Result<void> write_picture_png(OutputFile& file, const Picture& picture, const Context& context);

}  // namespace contrejour
