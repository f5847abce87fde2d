// OpenEXR's streams over memory and over an AtomicFile.
#pragma once

#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>

#include <ImfIO.h>

#include "base/atomic_file.h"

namespace contrejour {

class MemoryInput final : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::byte> bytes, const std::string& name)
      : Imf::IStream(name.c_str()), bytes_(bytes) {}

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

// OpenEXR's writers swallow what their destructors meet; the first error is kept here, to be asked for afterwards.
class AtomicFileOutput final : public Imf::OStream {
 public:
  explicit AtomicFileOutput(AtomicFile& file) : Imf::OStream(file.destination().string().c_str()), file_(file) {}

  void write(const char from[], int count) override {
    check(file_.write(std::string_view(from, static_cast<std::size_t>(count))));
  }
  uint64_t tellp() override {
    const Result<std::uint64_t> place = file_.position();
    if (!place) check(tl::unexpected(place.error()));
    return *place;
  }
  void seekp(uint64_t position) override { check(file_.seek(position)); }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  void check(const Result<void>& result) {
    if (result) return;
    if (!error_) error_ = result.error();
    throw std::runtime_error(result.error().message);
  }

  AtomicFile& file_;
  std::optional<Error> error_;
};

}  // namespace contrejour
