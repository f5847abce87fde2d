// SPDX-License-Identifier: Apache-2.0
// OpenEXR's streams over memory and over an OutputFile.
#pragma once

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include <ImfIO.h>

#include "contrejour/expert/output_file.h"

namespace contrejour::inline internal {

class MemoryInput final : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::byte> bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}

  bool read(char to[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (count < 0 || position_ > bytes_.size() || size > bytes_.size() - position_)
      throw std::runtime_error("the file is cut off");
    std::memcpy(to, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = static_cast<std::size_t>(position); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

// Writes to a caller's bytes, for files that are read again at once.
class MemoryOutput final : public Imf::OStream {
 public:
  explicit MemoryOutput(std::vector<std::byte>& bytes) : Imf::OStream("memory"), bytes_(bytes) {}

  void write(const char from[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    bytes_.resize(std::max(bytes_.size(), position_ + size));
    std::memcpy(bytes_.data() + position_, from, size);
    position_ += size;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = static_cast<std::size_t>(position); }

 private:
  std::vector<std::byte>& bytes_;
  std::size_t position_ = 0;
};

// Never throws: OpenEXR's writers also write in their destructors, where an exception ends the program. The first error
// is kept for the caller; after it nothing more is written.
class OutputFileStream final : public Imf::OStream {
 public:
  explicit OutputFileStream(OutputFile& file) : Imf::OStream(file.destination().string().c_str()), file_(file) {}

  void write(const char from[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (!error_) keep(file_.write(std::string_view(from, size)));
    position_ += size;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override {
    if (!error_) keep(file_.seek(position));
    position_ = position;
  }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  void keep(const Result<void>& result) {
    if (!result) error_ = result.error();
  }

  OutputFile& file_;
  std::uint64_t position_ = 0;
  std::optional<Error> error_;
};

}  // namespace contrejour::inline internal
