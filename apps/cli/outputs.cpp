#include "cli/outputs.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <random>
#include <system_error>

#include <fmt/format.h>

#include "cli/interrupt.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> io_failure(const fs::path& file, const std::string& what, int error_number) {
  return failure(ErrorCode::Io, what + ": " + std::generic_category().message(error_number), {file.string()});
}

// The file a symbolic link leads to, so that the link stays.
fs::path behind_links(const fs::path& file) {
  std::error_code error;
  if (!fs::is_symlink(file, error)) return file;
  const fs::path target = fs::weakly_canonical(file, error);
  return error ? file : target;
}

// Keeps the extension, by which writers choose the format.
fs::path temporary_beside(const fs::path& file) {
  static std::random_device source;
  constexpr std::size_t kLongestStem = 150;  // with the affixes, within the 255 bytes a name may have
  const std::string stem = file.stem().string().substr(0, kLongestStem);
  return file.parent_path() / fmt::format(".{}.{:08x}{}", stem, source(), file.extension().string());
}

Result<void> probe(const fs::path& temporary, const fs::path& destination) {
  std::FILE* const stream = std::fopen(temporary.string().c_str(), "wbx");
  if (stream == nullptr) return io_failure(destination, "cannot create a file in this folder", errno);
  std::fclose(stream);
  std::error_code ignored;
  fs::remove(temporary, ignored);
  return {};
}

}  // namespace

Outputs::~Outputs() {
  std::error_code ignored;
  for (const Pending& file : pending_) fs::remove(file.temporary, ignored);
}

Result<fs::path> Outputs::add(const fs::path& destination) {
  const fs::path target = behind_links(destination);
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (target.filename().empty() || fs::is_directory(status)) {
    return io_failure(destination, "cannot write here; give a file's name", EISDIR);
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) return target;
  const fs::path canonical = fs::weakly_canonical(target, error);
  if (std::find(named_.begin(), named_.end(), canonical) != named_.end()) {
    return failure(ErrorCode::InvalidArgument, "named for two outputs; give each its own file", {destination.string()});
  }
  named_.push_back(canonical);
  const fs::path temporary = temporary_beside(target);
  if (auto probed = probe(temporary, destination); !probed) return tl::unexpected(probed.error());
  pending_.push_back({target, temporary});
  return temporary;
}

Result<void> Outputs::commit() {
  if (interrupt_flag().load()) return failure(ErrorCode::Cancelled, "interrupted");
  for (const Pending& file : pending_) {
    std::error_code error;
    const fs::file_status old = fs::status(file.destination, error);
    if (fs::is_regular_file(old)) fs::permissions(file.temporary, old.permissions(), error);
    fs::rename(file.temporary, file.destination, error);
    if (error) return io_failure(file.destination, "cannot replace this file", error.value());
  }
  pending_.clear();
  return {};
}

Result<void> write_text(const fs::path& file, std::string_view text) {
  std::FILE* const stream = std::fopen(file.string().c_str(), "wb");
  if (stream == nullptr) return io_failure(file, "cannot open for writing", errno);
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const int write_error = errno;
  const bool closed = std::fclose(stream) == 0;
  if (!written || !closed) return io_failure(file, "cannot write", written ? errno : write_error);
  return {};
}

}  // namespace contrejour::cli
