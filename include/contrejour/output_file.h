// A file that appears whole or not at all, and several of them that appear together.
// What is written goes to a file without a name, where the system has such (Linux: O_TMPFILE), else to a hidden one in
// the same folder; commit() gives it the destination's name. Destroying one that was not committed leaves nothing, and
// so does a process that is killed; hidden files that such a process left a day ago are removed by the next one that
// writes the same destination. A symbolic link stays, and what it leads to is written, whether it exists or not. A
// destination that is no regular file (a pipe, a device) gets its bytes in one go, when the file is finished: writers
// that go back in a file can write to a pipe.
// Errors: Io, with the destination as place.file; after one, every later call fails too. Not for sharing by threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "contrejour/result.h"

namespace contrejour {

struct OutputFileSettings {
  bool may_be_unnamed = true;  // false: a hidden file even where the system has unnamed ones
};

class OutputFile {
 public:
  // Finds out at once whether the folder can be written to.
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

  // Everything on the disk, or in the pipe; a full disk may say so only now. Nothing can be written after it.
  [[nodiscard]] Result<void> finish();
  // Finishes what is not yet finished, and gives it the destination's name. Once only.
  [[nodiscard]] Result<void> commit();

  [[nodiscard]] const std::filesystem::path& destination() const;  // as it was given
  [[nodiscard]] const std::filesystem::path& target() const;  // behind symbolic links
  [[nodiscard]] bool is_regular() const;                      // no pipe, no device

 private:
  struct State;
  explicit OutputFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// All are finished before the first appears, pipes and devices last: a failure leaves every old file as it was.
[[nodiscard]] Result<void> commit_all(std::span<OutputFile* const> files);

}  // namespace contrejour
