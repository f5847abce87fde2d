#include "base/atomic_file.h"

#include "test_pictures.h"

using namespace contrejour;
using namespace contrejour::test;
namespace fs = std::filesystem;

namespace {
std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}
}  // namespace

TEST_CASE("a file appears at commit and not before") {
  const ScratchFolder folder;
  {
    AtomicFile file = AtomicFile::create(folder / "a.txt").value();
    CHECK(file.write("hello").has_value());
    CHECK(file.seek(0).has_value());
    CHECK(file.write("J").has_value());
    CHECK_FALSE(fs::exists(folder / "a.txt"));
    CHECK(file.commit().has_value());
    CHECK_FALSE(file.write("more").has_value());
  }
  CHECK(text_of(folder / "a.txt") == "Jello");
  CHECK(folder.file_count() == 1);
}

TEST_CASE("without a commit nothing is left, and an old file stays") {
  const ScratchFolder folder;
  REQUIRE(write_text_file(folder / "a.txt", "old").has_value());
  {
    AtomicFile file = AtomicFile::create(folder / "a.txt").value();
    AtomicFile moved = std::move(file);
    CHECK(moved.write("new").has_value());
  }
  CHECK(text_of(folder / "a.txt") == "old");
  CHECK(folder.file_count() == 1);
}

TEST_CASE("permissions and symbolic links are kept") {
  const ScratchFolder folder;
  REQUIRE(write_text_file(folder / "a.txt", "old").has_value());
  fs::permissions(folder / "a.txt", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("a.txt", folder / "link.txt");
  REQUIRE(write_text_file(folder / "link.txt", "new").has_value());
  CHECK(fs::is_symlink(folder / "link.txt"));
  CHECK(text_of(folder / "a.txt") == "new");
  CHECK(fs::status(folder / "a.txt").permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE("places where no file can be are errors with the file's name") {
  const ScratchFolder folder;
  for (const fs::path& path : {folder / "absent/a.txt", folder / "", fs::path("")}) {
    const auto file = AtomicFile::create(path);
    REQUIRE_FALSE(file.has_value());
    CHECK(file.error().code == ErrorCode::Io);
    CHECK(file.error().place.file == path.string());
  }
}

TEST_CASE("a full disk is an error") {
  if (!fs::exists("/dev/full")) return;
  CHECK_FALSE(write_text_file("/dev/full", std::string(100, 'x')).has_value());
  CHECK_FALSE(write_picture("/dev/full", picture_of(Image(8, 8))).has_value());
  CHECK_FALSE(write_exr("/dev/full", Image(8, 8)).has_value());
  CHECK_FALSE(write_preview_png("/dev/full", Image(500, 500)).has_value());
  CHECK(write_text_file("/dev/null", "x").has_value());
}
