// SPDX-License-Identifier: Apache-2.0
// Malicious or truncated files: an answer in a short time, and no crash.
#include "optics/lens_files/sample_lens.h"

#include <chrono>
#include <random>

#include <fmt/format.h>

#include "contrejour/lens.h"

namespace contrejour::test::hostile {
namespace {

using Clock = std::chrono::steady_clock;

// Generous, for a sanitizer on a busy machine; a failure would take minutes.
constexpr double kPatience_s = 10.0;

void check_refused(const std::string& text, const std::string& words = "") {
  const auto begin = Clock::now();
  const auto lens = read_lens_toml(text, "x.toml");
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  CHECK(seconds < kPatience_s);
  REQUIRE_FALSE(lens.has_value());
  CAPTURE(lens.error().message);
  CHECK(lens.error().message.find(words) != std::string::npos);
  CHECK(lens.error().message.size() < 1000);
}

std::string repeated(const std::string& piece, std::size_t times) {
  std::string out;
  out.reserve(piece.size() * times);
  for (std::size_t k = 0; k < times; ++k) out += piece;
  return out;
}

TEST_CASE("a lens cut at each byte") {
  // Names that are in no catalogue: truncated before its own glasses, the lens would otherwise be complete.
  std::string sample = kSampleLens;
  for (int k = 0; k < 2; ++k) sample = edited("SF2", "a flint", edited("BK7", "a crown", sample));
  for (const char* name : {"a flint", "a crown"})
    sample = edited(fmt::format("{} =", name), fmt::format("\"{}\" =", name), sample);
  REQUIRE(read_lens_toml(sample, "x.toml").has_value());
  for (std::size_t size = 0; size < sample.size(); ++size) {
    CAPTURE(size);
    const auto lens = read_lens_toml(std::string_view(sample).substr(0, size), "x.toml");
    // Only the last glass's line may miss its newline.
    if (size + 1 < sample.size()) CHECK_FALSE(lens.has_value());
  }
}

TEST_CASE("nesting without end") {
  check_refused(std::string("surfaces = ") + repeated("[", 100'000), "not valid TOML");
  check_refused(std::string("surfaces = ") + repeated("{a=", 100'000), "not valid TOML");
  check_refused(std::string("surfaces = ") + repeated("[{a=", 100'000), "not valid TOML");
  check_refused(repeated("[", 100'000));
  // Keys of many parts create nested tables, whose destructor is recursive.
  check_refused(std::string("a") + repeated(".a", 450'000) + " = 1", "a key has too many parts");
  check_refused(std::string("[a") + repeated(" . \"a\"", 100'000) + "]", "a key has too many parts");
  check_refused("name = \"a.b.c.d.e.f.g.h.i.j.k\"\n# 1.2.3.4.5.6.7.8.9.10\nx = '''a.a.a.a.a.a.a.a.a.a.a\n.'''\n",
                "unknown key 'x'");
}

// Preconditions of the parser that a malformed file violates.
TEST_CASE("closing what was not opened") {
  for (const char* text : {"a = [}", "a = [ 1, } ]", "a = [{]", "a = {]", "a = ]", "a = }", "a = ,", "[[[a]]]",
                           "[[=", "[=", "a.[", "= 1", "[]", "[[]]", "a = [c\"]", "a = {,}", "a = [#", "a = [_]"}) {
    CAPTURE(text);
    check_refused(text);
  }
}

TEST_CASE("many small things") {
  check_refused(repeated("[[a]]\n", 150'000));
  check_refused(fmt::format("surfaces = [{}]", repeated("{},", 300'000)));
  check_refused(edited("surfaces = [",
                       fmt::format("surfaces = [{}", repeated("{ radius_mm = inf, thickness_mm = 1, semi_diameter_mm "
                                                              "= 1 },",
                                                              250))),
                "at most 200");
  std::string keys;
  for (int k = 0; k < 60'000; ++k) keys += fmt::format("k{} = 1\n", k);
  check_refused(keys, "unknown key");
}

TEST_CASE("long names stay out of the message") {
  check_refused(repeated("k", 500'000) + " = 1", "unknown key 'kkk");
  check_refused(edited("\"BK7\"", fmt::format("\"{}\"", repeated("é", 200'000))), "no glass is called");
}

TEST_CASE("too large") {
  check_refused(kSampleLens + repeated("# more\n", 150'000), "a lens file has at most 1000000");
  CHECK(read_lens_toml(kSampleLens + repeated("# more\n", 100'000), "x.toml").has_value());
}

TEST_CASE("no text at all") {
  check_refused(std::string(1000, '\0'));
  check_refused(std::string("name = \"a\"\n\0\n", 13));
  check_refused("name = \"\xff\xfe\"\n", "not valid TOML");
  check_refused("\xff\xfen\0a\0m\0e\0");
  check_refused("brennweite_\xc3\xa4 = 1\n", "not valid TOML");
  check_refused("a = [ \xef\xb3\xbf ]\n", "not valid TOML");
  check_refused("a = \"\"\"b\\\xef\xbb\x9f\"\"\"\n", "not valid TOML");
  check_refused("a = \"\"\"b\\\n  \xef\xbb\x9f\"\"\"\n", "unknown key");
  check_refused("name =0[[[[eam[\"\"\"!\"\xef\xb3\xbf\"!kd\n", "not valid TOML");
  check_refused("a = 7:7\"\xef\xbb\xbe\"\n", "not valid TOML");
  std::mt19937 random(7);
  for (int k = 0; k < 200; ++k) {
    std::string bytes(1 + random() % 2000, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    check_refused(bytes);
  }
}

TEST_CASE("a lens with bytes changed at random") {
  std::mt19937 random(11);
  for (int k = 0; k < 3000; ++k) {
    std::string text = zoom_sample();
    for (int n = 1 + static_cast<int>(random() % 4); n > 0; --n)
      text[random() % text.size()] = static_cast<char>(random() % 256);
    const auto lens = read_lens_toml(text, "x.toml");
    if (!lens) {
      CHECK_FALSE(lens.error().message.empty());
      continue;
    }
    // A lens that passes must be usable.
    CHECK(validate(*lens).has_value());
    (void)configure_lens(*lens);
  }
}

}  // namespace
}  // namespace contrejour::test::hostile
