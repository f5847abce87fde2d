// SPDX-License-Identifier: Apache-2.0
// Files on disk and bundled names.
#include "optics/lens_files/sample_lens.h"

#include <fstream>

#include "contrejour/lens.h"

namespace contrejour::test::reading {
namespace {

namespace fs = std::filesystem;

// A temporary folder, removed at the end.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / "contrejour_test_lens") {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code code;
    fs::remove_all(path_, code);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void check_refused(const fs::path& file, const std::string& words) {
  const auto lens = read_lens(file);
  REQUIRE_FALSE(lens.has_value());
  CAPTURE(lens.error().to_string());
  CHECK(lens.error().position.file == file.string());
  CHECK(lens.error().message.find(words) != std::string::npos);
}

TEST_CASE("a file by its extension or by its content") {
  const Folder folder;
  CHECK(read_lens(folder.write("a.toml", kSampleLens)).has_value());
  CHECK(read_lens(folder.write("a.TOML", kSampleLens)).has_value());
  CHECK(read_lens(folder.write("lens", "\n# a comment\n" + kSampleLens)).has_value());
  CHECK(find_lens(folder.write("b.toml", kSampleLens).string()).has_value());
  const auto broken = read_lens(folder.write("c.toml", edited("50.0", "0.0")));
  REQUIRE_FALSE(broken.has_value());
  CHECK(broken.error().to_string().find("c.toml:6: surface 1: radius_mm is 0") != std::string::npos);
}

TEST_CASE("files that are no lens") {
  const Folder folder;
  check_refused(folder.path() / "none.toml", "no such file");
  check_refused(folder.path(), "this is a folder");
  check_refused(folder.write("empty.toml", ""), "the file is empty");
  check_refused(folder.write("a.bin", std::string("\x7f"
                                                  "ELF\0\0\0",
                                                  7)),
                "not a lens file that is known: it is binary");
  check_refused(folder.write("a.toml", std::string("name\0", 5)), "not a lens file that is known: it is binary");
  check_refused(folder.write("a.xml", "<?xml version=\"1.0\"?>\n<lens/>\n"), "it begins with '<?xml version=");
  check_refused(folder.write("a.txt", "once upon a time\n"), "not a lens file that is known: it begins with 'once");
  check_refused(folder.write("big.toml", std::string(1'000'001, '#')), "larger than 1000000 bytes");
#ifndef _WIN32
  check_refused("/dev/zero", "not an ordinary file");
#endif
}

TEST_CASE("bundled names, and what was meant") {
  CHECK(find_lens("heliar").has_value());
  const auto typo = find_lens("helair");
  REQUIRE_FALSE(typo.has_value());
  CHECK(typo.error().to_string() ==
        "no lens and no file is called 'helair'; did you mean 'heliar'? `contrejour lens list` shows all");
  const auto unknown = find_lens("zzzzzz");
  REQUIRE_FALSE(unknown.has_value());
  CHECK(unknown.error().message.find("bundled are angenieux-double-gauss, canon-70-200") != std::string::npos);
  CHECK(find_lens("canon").error().message.find("did you mean 'canon-70-200'?") != std::string::npos);
  CHECK(find_lens("nowhere/x.toml").error().message.find("no such file") != std::string::npos);
  CHECK_FALSE(find_lens("").has_value());
}

}  // namespace
}  // namespace contrejour::test::reading
