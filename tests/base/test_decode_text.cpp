// SPDX-License-Identifier: Apache-2.0
#include "base/decode_text.h"

#include <doctest/doctest.h>

namespace contrejour {
namespace {

using namespace std::string_literals;

TEST_CASE("the same words in every encoding") {
  const std::string words = "caf\u00e9 20 \u00b0C \u20ac\n";
  CHECK(decode_text(words) == words);
  CHECK(decode_text("\xEF\xBB\xBF" + words) == words);
  const std::string little = "c\0a\0f\0\xE9\0 \0002\0000\0 \0\xB0\0C\0 \0\xAC\x20\n\0"s;
  CHECK(decode_text("\xFF\xFE" + little) == words);
  std::string big = little;
  for (std::size_t k = 0; k + 1 < big.size(); k += 2) std::swap(big[k], big[k + 1]);
  CHECK(decode_text("\xFE\xFF" + big) == words);
  CHECK(decode_text("caf\xE9 20 \xB0"s + "C\n") == "caf\u00e9 20 \u00b0C\n");
}

TEST_CASE("UTF-16 without a mark is known by its zeros") {
  CHECK(decode_text("N\0M\0 \0A\0"s) == "NM A");
  CHECK(decode_text("\0N\0M\0 \0A"s) == "NM A");
  CHECK(decode_text("NM\0A"s) == "NM\0A"s);  // a stray zero does not make it UTF-16
}

TEST_CASE("line ends") {
  CHECK(decode_text("a\r\nb\rc\nd\r\r\ne") == "a\nb\nc\nd\n\ne");
  CHECK(decode_text("\r") == "\n");
  CHECK(decode_text("") == "");
}

TEST_CASE("pairs and halves of surrogates") {
  CHECK(decode_text("\xFF\xFE\x3D\xD8\x00\xDE"s) == "\U0001F600");
  CHECK(decode_text("\xFF\xFE\x3D\xD8 \0"s) == "\uFFFD ");
  CHECK(decode_text("\xFF\xFE\x00\xDE"s) == "\uFFFD");
  CHECK(decode_text("\xFF\xFE\x3D\xD8"s) == "\uFFFD");
  CHECK(decode_text("\xFF\xFE"s + "a\0b"s) == "a");  // an odd last byte
}

TEST_CASE("what is not UTF-8") {
  for (const char* bytes : {"\x80", "\xC0\xAF", "\xC3", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE0\x80\x80",
                            "\xF0\x80\x80\x80", "\xFE", "a\xE9z"}) {
    CAPTURE(bytes);
    CHECK_FALSE(is_utf8(bytes));
    CHECK(is_utf8(decode_text(bytes)));
  }
  CHECK(is_utf8("\U0010FFFF \u0800 \u0080"));
}

}  // namespace
}  // namespace contrejour
