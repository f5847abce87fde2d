// SPDX-License-Identifier: Apache-2.0
#include "base/text_file.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kLeastAtOnce = 4096;  // bytes, less one

}  // namespace

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
  // The size is a guess, since the file may change meanwhile. Reading one byte more detects its end, or a file that is
  // too large.
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  const std::size_t guess = code ? 0 : static_cast<std::size_t>(std::min<std::uintmax_t>(size, max_bytes));
  const std::size_t at_once = std::max(guess, kLeastAtOnce) + 1;
  std::string text;
  while (stream && text.size() <= max_bytes) {
    const std::size_t known = text.size();
    text.resize(std::min(known + at_once, max_bytes + 1));
    stream.read(text.data() + known, static_cast<std::streamsize>(text.size() - known));
    text.resize(known + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) return failure(ErrorCode::Io, "cannot be read; check the disk and try again", {name, 0, 0});
  if (text.size() > max_bytes) {
    return failure(ErrorCode::Parse, fmt::format("larger than {} bytes; no such file is", max_bytes), {name, 0, 0});
  }
  return text;
}

}  // namespace contrejour::inline internal
