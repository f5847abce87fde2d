// SPDX-License-Identifier: Apache-2.0
// A file that appears whole or not at all, and several of them that appear together. Bytes go to an unnamed file where
// the system supports it (Linux: O_TMPFILE), else to a hidden one in the same folder; commit() gives it the
// destination's name. Destroying one that was not committed leaves nothing, and so does a process that is killed;
// hidden files that such a process left a day ago are removed by the next one that writes the same destination. A
// symbolic link stays, and its target is written, whether it exists or not. A destination that is not a regular file (a
// pipe, a device) gets all bytes at once when the file is finished, so writers that seek backwards can write to a pipe.
// Errors: Io, with the destination as position.file; after one, every later call fails too. Thread-safety: one thread
// at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

struct OutputFileSettings {
  bool may_be_unnamed = true;  // false: a hidden file even where the system has unnamed ones
};

class CONTREJOUR_API OutputFile {
 public:
  // Fails at once if the folder cannot be written to.
  [[nodiscard]] static Result<OutputFile> create(const std::filesystem::path& destination,
                                                 const OutputFileSettings& settings = {});

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  Result<void> write(std::span<const std::byte> bytes);
  Result<void> write(std::string_view text);
  Result<void> seek(std::uint64_t position);

  // Writes everything to the disk or the pipe; a full disk may report its error only here. Nothing can be written
  // afterwards.
  [[nodiscard]] Result<void> finish();
  // Finishes the file if need be, and gives it the destination's name. Call it once.
  [[nodiscard]] Result<void> commit();

  [[nodiscard]] const std::filesystem::path& destination() const;  // as it was given
  [[nodiscard]] const std::filesystem::path& target() const;  // behind symbolic links
  [[nodiscard]] bool is_regular() const;  // no pipe, no device

 private:
  struct State;
  explicit OutputFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// All are finished before the first appears, pipes and devices last: a failure leaves every old file as it was.
[[nodiscard]] CONTREJOUR_API Result<void> commit_all(std::span<OutputFile* const> files);

}  // namespace contrejour
