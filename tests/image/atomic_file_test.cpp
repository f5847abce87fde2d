#include "base/atomic_file.h"

#include <csignal>

#include <sys/resource.h>

#include "test_pictures.h"

using namespace contrejour;
using namespace contrejour::test;
namespace fs = std::filesystem;

namespace {
std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A disk that is full after so many bytes, as far as this process is concerned.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : old_action_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_limit_);
    const rlimit limit{bytes, old_limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_action_);
  }

 private:
  void (*old_action_)(int);
  rlimit old_limit_{};
};
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

TEST_CASE("a disk that fills up at any moment is an error, and leaves what was there") {
  const ScratchFolder folder;
  Image image(60, 50);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<float>(i * 2654435761U % 1000003) * 1e-6F;
  const Picture picture = picture_of(image);
  REQUIRE(write_exr(folder / "whole.exr", image).has_value());
  const auto whole = static_cast<rlim_t>(fs::file_size(folder / "whole.exr"));
  for (const char* name : {"a.exr", "a.png"}) {
    write_bytes(folder / name, {std::byte{7}});
    for (rlim_t room = 0; room < whole; room += whole / 9) {
      Result<void> written;
      {
        const FullDisk full(room);
        written = write_picture(folder / name, picture);
      }
      if (written) break;  // the PNG is smaller
      CHECK(written.error().code == ErrorCode::Io);
      CHECK(bytes_of(folder / name).size() == 1);
      CHECK(folder.file_count() == (std::string(name) == "a.exr" ? 2 : 3));
    }
  }
}
