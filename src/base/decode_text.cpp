// SPDX-License-Identifier: Apache-2.0
#include "base/decode_text.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace contrejour::inline internal {
namespace {

constexpr char32_t kReplacement = 0xFFFD;
constexpr std::size_t kProbe = 64;  // bytes examined for UTF-16 without a byte order mark

std::uint8_t byte_at(std::string_view bytes, std::size_t k) { return static_cast<std::uint8_t>(bytes[k]); }

void append_utf8(std::string& out, char32_t c) {
  const auto put = [&](char32_t byte) { out.push_back(static_cast<char>(byte)); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xC0U | (c >> 6U));
    put(0x80U | (c & 0x3FU));
  } else if (c < 0x10000) {
    put(0xE0U | (c >> 12U));
    put(0x80U | ((c >> 6U) & 0x3FU));
    put(0x80U | (c & 0x3FU));
  } else {
    put(0xF0U | (c >> 18U));
    put(0x80U | ((c >> 12U) & 0x3FU));
    put(0x80U | ((c >> 6U) & 0x3FU));
    put(0x80U | (c & 0x3FU));
  }
}

std::string of_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t k) -> char32_t {
    const std::uint8_t first = byte_at(bytes, k), second = byte_at(bytes, k + 1);
    return big_endian ? (char32_t{first} << 8U) | second : (char32_t{second} << 8U) | first;
  };
  std::string out;
  out.reserve(bytes.size() / 2);
  for (std::size_t k = 0; k + 1 < bytes.size(); k += 2) {
    const char32_t c = unit(k);
    if (c < 0xD800 || c > 0xDFFF) {
      append_utf8(out, c);
      continue;
    }
    const char32_t low = c < 0xDC00 && k + 3 < bytes.size() ? unit(k + 2) : 0;
    const bool pair = low >= 0xDC00 && low <= 0xDFFF;
    append_utf8(out, pair ? 0x10000 + ((c - 0xD800) << 10U) + (low - 0xDC00) : kReplacement);
    if (pair) k += 2;
  }
  return out;
}

std::string of_latin1(std::string_view bytes) {
  std::string out;
  out.reserve(bytes.size() + bytes.size() / 16);
  for (std::size_t k = 0; k < bytes.size(); ++k) append_utf8(out, byte_at(bytes, k));
  return out;
}

// Length of the sequence that starts at k, or 0 if it is invalid: overlong forms, surrogates and values beyond
// U+10FFFF.
std::size_t utf8_length(std::string_view text, std::size_t k) {
  const std::uint8_t lead = byte_at(text, k);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || k + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte_at(text, k + i) & 0xC0U) != 0x80U) return 0;
  const std::uint8_t second = byte_at(text, k + 1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second >= 0xA0;
  const bool beyond = lead == 0xF4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

// Detects the byte order of UTF-16 without a mark: in Latin letters every other byte is 0.
std::optional<bool> unmarked_big_endian(std::string_view bytes) {
  const std::size_t size = std::min(bytes.size(), kProbe) & ~std::size_t{1};
  std::size_t zeros[2] = {0, 0};
  for (std::size_t k = 0; k < size; ++k) zeros[k % 2] += bytes[k] == '\0' ? 1 : 0;
  if (size < 4) return std::nullopt;
  if (zeros[0] == size / 2 && zeros[1] == 0) return true;
  if (zeros[1] == size / 2 && zeros[0] == 0) return false;
  return std::nullopt;
}

void unify_line_ends(std::string& text) {
  std::size_t to = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool cr = text[k] == '\r';
    if (cr && k + 1 < text.size() && text[k + 1] == '\n') continue;
    text[to++] = cr ? '\n' : text[k];
  }
  text.resize(to);
}

std::string to_utf8(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (bytes.starts_with("\xFF\xFE")) return of_utf16(bytes.substr(2), false);
  if (bytes.starts_with("\xFE\xFF")) return of_utf16(bytes.substr(2), true);
  if (const auto big_endian = unmarked_big_endian(bytes)) return of_utf16(bytes, *big_endian);
  return is_utf8(bytes) ? std::string(bytes) : of_latin1(bytes);
}

}  // namespace

bool is_utf8(std::string_view text) {
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t length = utf8_length(text, k);
    if (length == 0) return false;
    k += length;
  }
  return true;
}

std::string decode_text(std::string_view bytes) {
  std::string text = to_utf8(bytes);
  unify_line_ends(text);
  return text;
}

}  // namespace contrejour::inline internal
