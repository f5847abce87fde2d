// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/svg.h"

namespace contrejour {

std::string markup_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\n': out += c; break;
      default: out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return out;
}

std::string data_uri(std::string_view media_type, std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string uri = "data:" + std::string(media_type) + ";base64,";
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    unsigned group = 0;
    for (std::size_t i = k; i < k + 3; ++i)
      group = group << 8U | (i < bytes.size() ? std::to_integer<unsigned>(bytes[i]) : 0U);
    for (unsigned i = 0; i < 4; ++i) uri += k + i <= bytes.size() ? kDigits[group >> (18U - 6U * i) & 63U] : '=';
  }
  return uri;
}

}  // namespace contrejour
