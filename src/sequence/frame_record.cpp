// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/frame_record.h"

#include <optional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/text_file.h"
#include "contrejour/expert/output_file.h"

namespace contrejour {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxRecordBytes = 16U << 20;

fs::path record_of(const FrameFiles& files) {
  const fs::path& first = files.outputs.front();
  return first.parent_path() / ".contrejour" / (first.filename().string() + ".txt");
}

// A line with the state of a file; nothing if there is no such file.
std::optional<std::string> state_of(std::string_view role, const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) return std::nullopt;
  const auto time = fs::last_write_time(file, error).time_since_epoch().count();
  if (error) return std::nullopt;
  return fmt::format("{} {} bytes, written at {}: {}\n", role, size, time, file.string());
}

// The text of a record that is made now; nothing if a file is missing.
std::optional<std::string> record_text(const FrameFiles& files) {
  std::string text = files.settings + '\n';
  for (const fs::path& file : files.inputs) {
    const auto state = state_of("input", file);
    if (!state) return std::nullopt;
    text += *state;
  }
  for (const fs::path& file : files.outputs) {
    const auto state = state_of("output", file);
    if (!state) return std::nullopt;
    text += *state;
  }
  return text;
}

}  // namespace

Result<void> write_frame_record(const FrameFiles& files) {
  const fs::path record = record_of(files);
  const auto text = record_text(files);
  if (!text) return failure(ErrorCode::Io, "a file of this frame has vanished", {files.outputs.front().string()});
  std::error_code error;
  fs::create_directories(record.parent_path(), error);
  auto out = OutputFile::create(record);
  if (!out) return tl::unexpected(out.error());
  if (auto written = out->write(*text); !written) return written;
  return out->commit();
}

bool is_frame_done(const FrameFiles& files) {
  const auto now = record_text(files);
  if (!now) return false;
  const auto then = read_text_file(record_of(files), kMaxRecordBytes, "");
  return then && *then == *now;
}

}  // namespace contrejour
