// SPDX-License-Identifier: Apache-2.0
// Damaged files: a clear error that names the file, no crash, bounded memory.
#include <random>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include "base/memory.h"
#include "test_pictures.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

std::vector<std::byte> good_exr() {
  const ScratchFolder folder;
  Image image(67, 43, 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 251) * 0.37F;
  Picture picture = picture_of(image, SampleType::Half);
  set_text_attribute(picture, "comments", "a good file");
  must_write(folder / "good.exr", picture);
  return bytes_of(folder / "good.exr");
}

std::vector<std::byte> good_png() {
  const ScratchFolder folder;
  Image image(67, 43, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 251) / 251;
  must_write(folder / "good.png", picture_of(image));
  return bytes_of(folder / "good.png");
}

void check_refused(const std::vector<std::byte>& bytes) {
  const Result<Picture> picture = read_picture(bytes, "bad.file");
  REQUIRE_FALSE(picture.has_value());
  CHECK(picture.error().position.file == "bad.file");
  CHECK_FALSE(picture.error().message.empty());
}

void put_int(std::vector<std::byte>& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::byte>(value >> (8 * i));
}

// The offset of an attribute's value: after its name, its type and its size.
std::size_t value_of(const std::vector<std::byte>& bytes, const std::string& name, const std::string& type) {
  const std::string key = name + '\0' + type + '\0';
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t found = text.find(key);
  REQUIRE(found != std::string::npos);
  return found + key.size() + 4;
}

}  // namespace

TEST_CASE("truncated files are errors at every sixteenth") {
  for (const auto& good : {good_exr(), good_png()}) {
    REQUIRE(read_picture(good, "good").has_value());
    for (std::size_t i = 0; i < 16; ++i) {
      CAPTURE(i);
      check_refused({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(good.size() * i / 16)});
    }
    check_refused({good.begin(), good.end() - 1});
  }
}

TEST_CASE("a damaged byte anywhere is an error or a picture, never a crash") {
  std::mt19937 random(3);
  for (const auto& good : {good_exr(), good_png()})
    for (int i = 0; i < 3000; ++i) {
      std::vector<std::byte> bytes = good;
      // Half of the changes are in the header, where they do most damage.
      const std::size_t range = i % 2 == 0 ? std::min<std::size_t>(400, bytes.size()) : bytes.size();
      bytes[random() % range] = static_cast<std::byte>(random());
      ReadOptions options;
      options.limits.max_bytes = 64 << 20;
      const Result<Picture> picture = read_picture(bytes, "damaged", options);
      if (!picture) CHECK_FALSE(picture.error().message.empty());
    }
}

TEST_CASE("random bytes after a good start are errors") {
  std::mt19937 random(11);
  for (const auto& start : {good_exr(), good_png()})
    for (int i = 0; i < 200; ++i) {
      std::vector<std::byte> bytes(start.begin(), start.begin() + 8);
      for (int k = 0; k < 500; ++k) bytes.push_back(static_cast<std::byte>(random()));
      check_refused(bytes);
    }
  check_refused({});
  std::vector<std::byte> noise(4096);
  for (std::byte& b : noise) b = static_cast<std::byte>(random());
  check_refused(noise);
}

TEST_CASE("absurd dimensions are refused before anything is allocated") {
  const std::uint64_t before = peak_memory_bytes();
  const std::vector<std::byte> good = good_exr();
  for (const auto& [right, bottom] :
       std::initializer_list<std::pair<std::uint32_t, std::uint32_t>>{{0x7fffffff, 0x7fffffff},
                                                                      {0x3ffffffe, 0},
                                                                      {0, 0x3ffffffe},
                                                                      {65535, 65535},
                                                                      {30000, 8000},
                                                                      {0xfffffff0, 10},
                                                                      {67 * 100, 43 * 100}}) {
    CAPTURE(right);
    CAPTURE(bottom);
    std::vector<std::byte> bytes = good;
    const std::size_t window = value_of(bytes, "dataWindow", "box2i");
    put_int(bytes, window + 8, right);
    put_int(bytes, window + 12, bottom);
    check_refused(bytes);
  }
  std::vector<std::byte> png = good_png();
  put_int(png, 16, 0x00ff7f);  // big-endian there: 2139095040 pixels wide; the checksum is wrong too
  check_refused(png);
  CHECK(peak_memory_bytes() < before + (64 << 20));
}

// The library would read four bytes too many, and then take any bytes for the size of what follows.
TEST_CASE("a manifest of identifiers is refused by its name") {
  std::vector<std::byte> bytes = good_exr();
  const std::string names = std::string("cryptomatte") + '\0' + "idmanifest" + '\0';
  std::vector<std::byte> attribute(names.size() + 4 + 16);
  std::memcpy(attribute.data(), names.data(), names.size());
  put_int(attribute, names.size(), 16);
  bytes.insert(bytes.begin() + 8, attribute.begin(), attribute.end());
  const Result<Picture> picture = read_picture(bytes, "bad.file");
  REQUIRE_FALSE(picture.has_value());
  CHECK(picture.error().code == ErrorCode::Unsupported);
  CHECK(picture.error().message.find("cryptomatte") != std::string::npos);
}

TEST_CASE("attributes that claim more than the file holds are refused") {
  const std::uint64_t before = peak_memory_bytes();
  const std::vector<std::byte> good = good_exr();
  for (const std::uint32_t size : {0x7ffffff0U, 0xffffffffU, 0x10000000U, 1000000U}) {
    std::vector<std::byte> bytes = good;
    put_int(bytes, value_of(bytes, "comments", "string") - 4, size);
    check_refused(bytes);
  }
  // A preview of 65535 x 65535, and an integer of a kilobyte that would misalign the library's parser.
  for (const auto& [type, size] : std::initializer_list<std::pair<std::string, std::uint32_t>>{
           {"preview", 8}, {"int", 1000}, {"stringvector", 8}, {"tiledesc", 8}}) {
    CAPTURE(type);
    const std::string names = std::string("bad") + '\0' + type + '\0';
    std::vector<std::byte> attribute(names.size() + 4 + size);
    std::memcpy(attribute.data(), names.data(), names.size());
    put_int(attribute, names.size(), size);
    put_int(attribute, names.size() + 4, 65535);
    put_int(attribute, names.size() + 8, 65535);
    std::vector<std::byte> bytes = good;
    bytes.insert(bytes.begin() + 8, attribute.begin(), attribute.end());
    const Result<Picture> picture = read_picture(bytes, "bad.exr");
    REQUIRE_FALSE(picture.has_value());
    CHECK(picture.error().message.find("'bad'") != std::string::npos);
  }
  CHECK(peak_memory_bytes() < before + (64 << 20));
}

TEST_CASE("limits are the caller's") {
  ReadOptions options;
  options.limits.max_pixels = 67 * 43 - 1;
  CHECK_FALSE(read_picture(good_exr(), "good", options).has_value());
  CHECK_FALSE(read_picture(good_png(), "good", options).has_value());
  options.limits.max_pixels = 67 * 43;
  CHECK(read_picture(good_exr(), "good", options).has_value());
  CHECK(read_picture(good_png(), "good", options).has_value());
  options.limits.max_bytes = 1000;
  CHECK_FALSE(read_picture(good_exr(), "good", options).has_value());
}

TEST_CASE("files that cannot be opened say so") {
  const ScratchFolder folder;
  for (const std::filesystem::path& path : {folder / "absent.exr", std::filesystem::path("/"), folder / ""}) {
    const auto picture = read_picture(path);
    REQUIRE_FALSE(picture.has_value());
    CHECK(picture.error().code == ErrorCode::Io);
    CHECK(picture.error().position.file == path.string());
  }
  if (std::filesystem::exists("/dev/zero")) {
    ReadOptions options;
    options.limits.max_bytes = 8 << 20;
    CHECK_FALSE(read_picture("/dev/zero", options).has_value());
  }
}
