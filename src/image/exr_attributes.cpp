// SPDX-License-Identifier: Apache-2.0
#include "image/exr_attributes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace contrejour::inline internal {
namespace {

// "OpenEXR File Layout" (openexr.com): version field flags.
constexpr std::uint32_t kVersionMask = 0xff, kDeepFlag = 0x800, kMultiPartFlag = 0x1000;
constexpr std::size_t kLongestName = 255;

// Attribute types of one size, "OpenEXR File Layout", Predefined Attribute Types.
constexpr std::pair<std::string_view, std::size_t> kFixedSizes[] = {{"box2f", 16},
                                                                    {"box2i", 16},
                                                                    {"chromaticities", 32},
                                                                    {"compression", 1},
                                                                    {"deepImageState", 1},
                                                                    {"double", 8},
                                                                    {"envmap", 1},
                                                                    {"float", 4},
                                                                    {"int", 4},
                                                                    {"keycode", 28},
                                                                    {"lineOrder", 1},
                                                                    {"m33d", 72},
                                                                    {"m33f", 36},
                                                                    {"m44d", 128},
                                                                    {"m44f", 64},
                                                                    {"rational", 8},
                                                                    {"tiledesc", 9},
                                                                    {"timecode", 8},
                                                                    {"v2d", 16},
                                                                    {"v2f", 8},
                                                                    {"v2i", 8},
                                                                    {"v3d", 24},
                                                                    {"v3f", 12},
                                                                    {"v3i", 12}};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }

  std::optional<std::uint32_t> u32() {  // little-endian
    if (remaining() < 4) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes_[position_ + i]) << (8 * i);
    position_ += 4;
    return value;
  }

  std::optional<std::string_view> name() {  // up to and without its NUL
    const auto* const begin = reinterpret_cast<const char*>(bytes_.data() + position_);
    const void* const end = std::memchr(begin, 0, std::min(remaining(), kLongestName + 1));
    if (end == nullptr) return std::nullopt;
    const std::string_view text(begin, static_cast<std::size_t>(static_cast<const char*>(end) - begin));
    position_ += text.size() + 1;
    return text;
  }

  std::optional<std::span<const std::byte>> take(std::size_t size) {
    if (remaining() < size) return std::nullopt;
    position_ += size;
    return bytes_.subspan(position_ - size, size);
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

bool is_channel_list(ByteReader in) {
  constexpr std::size_t kChannelSize = 16;  // type, pLinear and padding, two samplings
  while (true) {
    const auto name = in.name();
    if (!name) return false;
    if (name->empty()) return in.remaining() == 0;
    if (!in.take(kChannelSize)) return false;
  }
}

bool is_string_list(ByteReader in) {
  while (in.remaining() > 0) {
    const auto size = in.u32();
    if (!size || !in.take(*size)) return false;
  }
  return true;
}

bool is_preview(ByteReader in) {
  const auto width = in.u32(), height = in.u32();
  if (!width || !height || *width > 0xffff || *height > 0xffff) return false;
  return in.remaining() == std::size_t{4} * *width * *height;
}

// Sizes, then the level mode (0 to 2) and the rounding mode (0 or 1) in the halves of a byte.
bool is_tile_description(std::span<const std::byte> value) {
  const auto modes = std::to_integer<unsigned>(value[8]);
  return (modes & 0xf) <= 2 && (modes >> 4) <= 1;
}

// True if the library reads exactly these bytes for an attribute of this type; it copies unknown types.
bool is_value_of(std::string_view type, std::span<const std::byte> value) {
  for (const auto& [fixed_type, size] : kFixedSizes)
    if (type == fixed_type) return value.size() == size && (type != "tiledesc" || is_tile_description(value));
  if (type == "chlist") return is_channel_list(ByteReader(value));
  if (type == "stringvector") return is_string_list(ByteReader(value));
  if (type == "preview") return is_preview(ByteReader(value));
  if (type == "floatvector") return value.size() % 4 == 0;
  return true;
}

// OpenEXR 3.1 reads an attribute of this type four bytes too far and takes what follows for sizes of its own.
constexpr std::string_view kMisreadType = "idmanifest";

// Makes a hostile name safe for the terminal.
std::string printable(std::string_view text) {
  std::string shown(text.substr(0, 40));
  for (char& c : shown)
    if (c < 0x20 || c > 0x7e) c = '?';
  return shown;
}

}  // namespace

Result<ExrHeaderSize> check_exr_header(std::span<const std::byte> bytes, const std::string& name) {
  const SourcePosition position{name};
  ByteReader in(bytes);
  const auto magic = in.u32(), version = in.u32();
  if (!magic || !version) return failure(ErrorCode::Parse, "the OpenEXR file ends within its header", position);
  if ((*version & kVersionMask) != 2)
    return failure(ErrorCode::Unsupported, fmt::format("OpenEXR version {} is not known", *version & kVersionMask),
                   position);
  const bool is_multi_part = (*version & kMultiPartFlag) != 0;
  if ((*version & kDeepFlag) != 0 && !is_multi_part)
    return failure(ErrorCode::Unsupported, "deep OpenEXR pictures are not read; flatten it first", position);
  bool is_first = true;  // first attribute of its part: an empty name ends a part, and an empty part ends the header
  while (true) {
    const auto attribute = in.name();
    if (!attribute) return failure(ErrorCode::Parse, "the OpenEXR header is damaged or cut off", position);
    if (attribute->empty()) {
      if (!is_multi_part || is_first) return ExrHeaderSize{in.position(), is_multi_part};
      is_first = true;
      continue;
    }
    is_first = false;
    const auto type = in.name();
    if (type == kMisreadType)
      return failure(ErrorCode::Unsupported,
                     fmt::format("attribute '{}' is a manifest of identifiers, which OpenEXR 3.1 cannot read; save the "
                                 "picture without it",
                                 printable(*attribute)),
                     position);
    const auto size = type ? in.u32() : std::nullopt;
    const auto value = size ? in.take(*size) : std::nullopt;
    if (!value || !is_value_of(*type, *value))
      return failure(ErrorCode::Parse,
                     fmt::format("the OpenEXR header is damaged at attribute '{}'", printable(*attribute)), position);
  }
}

}  // namespace contrejour::inline internal
