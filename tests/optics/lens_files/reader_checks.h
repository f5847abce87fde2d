// SPDX-License-Identifier: Apache-2.0
// Checks that apply to every reader of other programs' files.
#pragma once

#include <string>

#include <doctest/doctest.h>

#include "base/decode_text.h"
#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"

namespace contrejour::test {

using ReadText = Result<Prescription> (*)(const LensText& in);

inline Prescription read_or_fail(ReadText read, const std::string& text) {
  const std::string decoded = decode_text(text);
  const auto lens = read({decoded, "a file"});
  REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
  return *lens;
}

inline void check_refused_by(ReadText read, const std::string& text, int line, const std::string& words) {
  const std::string decoded = decode_text(text);
  const auto lens = read({decoded, "a file"});
  CAPTURE(words);
  REQUIRE_FALSE(lens.has_value());
  CAPTURE(lens.error().to_string());
  CHECK(lens.error().message.find(words) != std::string::npos);
  CHECK(lens.error().position.line == line);
}

inline void check_warns(const Prescription& lens, const std::string& words) {
  CAPTURE(words);
  bool found = false;
  for (const std::string& warning : lens.warnings) found = found || warning.find(words) != std::string::npos;
  CHECK(found);
}

// A lens that is written in our own format and read again is the same: the same text is written once more.
inline void check_round_trip(const Prescription& lens) {
  const std::string written = write_lens_toml(lens);
  const auto again = read_lens_toml(written, "again.toml");
  REQUIRE_MESSAGE(again.has_value(), (again ? "" : again.error().to_string()));
  CHECK(write_lens_toml(*again) == written);
}

// The text with one piece replaced; the piece must be there.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  CAPTURE(std::string(from));
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace contrejour::test
