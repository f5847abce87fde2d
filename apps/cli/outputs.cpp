// SPDX-License-Identifier: Apache-2.0
#include "cli/outputs.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/interrupt.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

fs::path canonical(const OutputFile& file) {
  std::error_code error;
  return fs::weakly_canonical(file.target(), error);
}

}  // namespace

Result<OutputFile*> Outputs::add(const std::string& destination) {
  if (destination.empty()) return nullptr;
  auto file = OutputFile::create(destination);
  if (!file) return tl::unexpected(file.error());
  const bool named_twice =
      file->is_regular() && std::any_of(files_.begin(), files_.end(), [&](const OutputFile& other) {
        return other.is_regular() && canonical(other) == canonical(*file);
      });
  if (named_twice)
    return failure(ErrorCode::InvalidArgument, "the same file is given for two outputs; give each output its own file",
                   {destination});
  return &files_.emplace_back(std::move(*file));
}

Result<void> Outputs::add_all(std::span<const std::pair<const std::string&, OutputFile*&>> files) {
  for (const auto& [name, file] : files) {
    const auto added = add(name);
    if (!added) return tl::unexpected(added.error());
    file = *added;
  }
  return {};
}

Result<void> Outputs::commit() {
  if (interrupt_flag().load()) return failure(ErrorCode::Cancelled, "interrupted");
  std::vector<OutputFile*> files;
  for (OutputFile& file : files_) files.push_back(&file);
  return commit_all(files);
}

}  // namespace contrejour::cli
