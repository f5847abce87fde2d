// SPDX-License-Identifier: Apache-2.0
#include "base/text_file.h"

#include <fstream>

#include <doctest/doctest.h>

#include "support/scratch_folder.h"

namespace contrejour {
namespace {

std::string written(const std::filesystem::path& file, std::size_t bytes) {
  std::string text(bytes, '\0');
  for (std::size_t k = 0; k < bytes; ++k) text[k] = static_cast<char>('a' + k % 23);
  std::ofstream(file, std::ios::binary) << text;
  return text;
}

TEST_CASE("files of every size up to the limit are read whole, and larger ones are refused") {
  const test::ScratchFolder folder;
  for (const std::size_t bytes : {0UL, 1UL, 4096UL, 4097UL, 20'000UL}) {
    CAPTURE(bytes);
    const std::string text = written(folder / "text", bytes);
    const auto read = read_text_file(folder / "text", 20'000, "");
    REQUIRE(read);
    CHECK(*read == text);
  }
  written(folder / "text", 20'001);
  CHECK_FALSE(read_text_file(folder / "text", 20'000, ""));
}

TEST_CASE("a small file takes little memory, however large it may be") {
  const test::ScratchFolder folder;
  written(folder / "text", 100);
  const auto read = read_text_file(folder / "text", std::size_t{64} << 20U, "");
  REQUIRE(read);
  CHECK(read->capacity() < 100'000);
}

// The size of such files is said to be zero.
TEST_CASE("files that the system makes while they are read") {
  if (!std::filesystem::exists("/proc/self/status")) return;
  const auto read = read_text_file("/proc/self/status", 1'000'000, "");
  REQUIRE(read);
  CHECK(read->starts_with("Name:"));
}

}  // namespace
}  // namespace contrejour
