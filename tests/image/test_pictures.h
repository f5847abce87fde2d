// SPDX-License-Identifier: Apache-2.0
// Files and folders for the tests of pictures.
#pragma once

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/image_io.h"

namespace contrejour::test {

// A temporary folder, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    static int serial = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("contrejour-image-" + std::to_string(getpid()) + "-" + std::to_string(serial++));
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path path_;
};

inline std::vector<std::byte> bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> chars{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::byte> bytes(chars.size());
  if (!chars.empty()) std::memcpy(bytes.data(), chars.data(), chars.size());
  return bytes;
}

inline void write_bytes(const std::filesystem::path& file, const std::vector<std::byte>& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

inline Picture must_read(const std::filesystem::path& file, const ReadOptions& options = {}) {
  Result<Picture> picture = read_picture(file, options);
  REQUIRE_MESSAGE(picture.has_value(), (picture ? "" : picture.error().to_string()));
  return std::move(*picture);
}

inline void must_write(const std::filesystem::path& file, const Picture& picture) {
  const Result<void> written = write_picture(file, picture);
  REQUIRE_MESSAGE(written.has_value(), (written ? "" : written.error().to_string()));
}

inline const PictureChannel& channel(const Picture& picture, const std::string& name) {
  for (const PictureChannel& c : picture.channels)
    if (c.name == name) return c;
  FAIL("no channel ", name);
  return picture.channels.front();
}

inline void check_same_channels(const Picture& a, const Picture& b) {
  REQUIRE(a.channels.size() == b.channels.size());
  for (const PictureChannel& c : a.channels) {
    CAPTURE(c.name);
    const PictureChannel& other = channel(b, c.name);
    CHECK(c.type == other.type);
    CHECK(c.x_sampling == other.x_sampling);
    CHECK(c.y_sampling == other.y_sampling);
    CHECK(c.perceptually_linear == other.perceptually_linear);
    CHECK(c.samples == other.samples);
  }
}

}  // namespace contrejour::test
