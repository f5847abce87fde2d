// SPDX-License-Identifier: Apache-2.0
// Files and folders for the tests of pictures.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/image_io.h"
#include "support/scratch_folder.h"

namespace contrejour::test {

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
