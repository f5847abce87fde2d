// SPDX-License-Identifier: Apache-2.0
#include "base/text_file.h"

#include <fstream>
#include <system_error>

#include <fmt/format.h>

namespace contrejour::inline internal {

Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t max_bytes,
                                   std::string_view if_absent) {
  const std::string name = file.string();
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (!std::filesystem::exists(status)) {
    return failure(ErrorCode::Io, fmt::format("no such file; check the path, or {}", if_absent), {name, 0, 0});
  }
  if (std::filesystem::is_directory(status)) {
    return failure(ErrorCode::Io, "this is a folder; name a file in it", {name, 0, 0});
  }
  // Pipes and devices may never end.
  if (!std::filesystem::is_regular_file(status)) {
    return failure(ErrorCode::Io, "not an ordinary file; copy what it gives into one", {name, 0, 0});
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return failure(ErrorCode::Io, "cannot be opened; check its permissions", {name, 0, 0});
  // Reading one byte more than the limit detects a file that is too large, even one that grows meanwhile.
  std::string text(max_bytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) return failure(ErrorCode::Io, "cannot be read; check the disk and try again", {name, 0, 0});
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > max_bytes) {
    return failure(ErrorCode::Parse, fmt::format("larger than {} bytes; no such file is", max_bytes), {name, 0, 0});
  }
  return text;
}

}  // namespace contrejour::inline internal
