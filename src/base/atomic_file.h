// A file that appears whole or not at all: written under a temporary name in the same folder, then renamed.
// Destroying one that was not committed removes the temporary, so a failed or cancelled write leaves nothing.
// A destination that is no regular file (a pipe, /dev/null) is written directly; a symbolic link's target is replaced.
// Errors: Io, with the destination as place.file; after one, every later call fails too. Not for sharing by threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "contrejour/result.h"

namespace contrejour {

class AtomicFile {
 public:
  [[nodiscard]] static Result<AtomicFile> create(const std::filesystem::path& destination);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  Result<void> write(std::span<const std::byte> bytes);
  Result<void> write(std::string_view text);
  Result<void> seek(std::uint64_t position);

  // Everything on the disk, under the destination's name. Once only.
  [[nodiscard]] Result<void> commit();

  [[nodiscard]] const std::filesystem::path& destination() const { return destination_; }

 private:
  AtomicFile(std::filesystem::path destination, std::filesystem::path temporary, std::FILE* stream);
  tl::unexpected<Error> fail(const std::string& what, int error_number);
  void close_and_remove() noexcept;

  std::filesystem::path destination_;
  std::filesystem::path temporary_;  // empty: written directly
  std::FILE* stream_ = nullptr;
  bool failed_ = false;
};

// A whole text (SVG, JSON, TOML) as one file.
Result<void> write_text_file(const std::filesystem::path& destination, std::string_view text);

}  // namespace contrejour
