// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/output_file.h"

#include <chrono>
#include <csignal>
#include <string>
#include <string_view>
#include <thread>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test_pictures.h"

using namespace contrejour;
using namespace contrejour::test;
namespace fs = std::filesystem;

namespace {
std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

Result<void> write_text_file(const fs::path& destination, std::string_view text,
                             const OutputFileSettings& settings = {}) {
  auto file = OutputFile::create(destination, settings);
  if (!file) return tl::unexpected(file.error());
  if (auto written = file->write(text); !written) return written;
  return file->commit();
}

// Simulates for this process a disk that is full after some number of bytes.
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
    OutputFile file = OutputFile::create(folder / "a.txt").value();
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
    OutputFile file = OutputFile::create(folder / "a.txt").value();
    OutputFile moved = std::move(file);
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

TEST_CASE("positions where no file can be are errors with the file's name") {
  const ScratchFolder folder;
  for (const fs::path& path : {folder / "absent/a.txt", folder / "", fs::path("")}) {
    const auto file = OutputFile::create(path);
    REQUIRE_FALSE(file.has_value());
    CHECK(file.error().code == ErrorCode::Io);
    CHECK(file.error().position.file == path.string());
  }
}

TEST_CASE("a link that leads to nothing yet stays, and what it leads to is written") {
  const ScratchFolder folder;
  fs::create_directory(folder / "far");
  fs::create_symlink("second.txt", folder / "first.txt");
  fs::create_symlink("far/a.txt", folder / "second.txt");
  REQUIRE(write_text_file(folder / "first.txt", "new").has_value());
  CHECK(fs::is_symlink(folder / "first.txt"));
  CHECK(fs::is_symlink(folder / "second.txt"));
  CHECK(text_of(folder / "far/a.txt") == "new");
  fs::create_symlink("round.txt", folder / "round.txt");
  const auto round = write_text_file(folder / "round.txt", "new");
  REQUIRE_FALSE(round.has_value());
  CHECK(round.error().position.file == (folder / "round.txt").string());
}

TEST_CASE("a killed process leaves nothing, or what the next one removes when it is old") {
  const ScratchFolder folder;
  for (const bool may_be_unnamed : {true, false}) {
    CAPTURE(may_be_unnamed);
    const pid_t child = fork();
    if (child == 0) {
      auto file = OutputFile::create(folder / "a.txt", {may_be_unnamed});
      (void)file->write(std::string(100000, 'x'));
      raise(SIGKILL);
    }
    REQUIRE(child > 0);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(WIFSIGNALED(status));
    CHECK(folder.file_count() == (may_be_unnamed ? 0 : 1));
  }
  // A file of another destination, and one of today, are kept.
  write_bytes(folder / ".b.txt.1-0.contrejour-part", {std::byte{7}});
  REQUIRE(write_text_file(folder / "a.txt", "new", {.may_be_unnamed = false}).has_value());
  CHECK(folder.file_count() == 3);
  for (const auto& entry : fs::directory_iterator(folder / ""))
    fs::last_write_time(entry, fs::file_time_type::clock::now() - std::chrono::hours(25));
  REQUIRE(write_text_file(folder / "a.txt", "newer", {.may_be_unnamed = false}).has_value());
  CHECK(folder.file_count() == 2);
  CHECK(text_of(folder / "a.txt") == "newer");
}

TEST_CASE("files appear together or not at all") {
  const ScratchFolder folder;
  std::vector<OutputFile> files;
  files.push_back(OutputFile::create(folder / "a.txt").value());
  files.push_back(OutputFile::create(folder / "b.txt", {.may_be_unnamed = false}).value());
  for (OutputFile& file : files) REQUIRE(file.write("new").has_value());
  CHECK_FALSE(fs::exists(folder / "a.txt"));
  OutputFile* const both[] = {&files[0], &files[1]};
  CHECK(commit_all(both).has_value());
  CHECK(text_of(folder / "b.txt") == "new");
  CHECK(folder.file_count() == 2);
  if (!fs::exists("/dev/full")) return;
  std::vector<OutputFile> doomed;
  doomed.push_back(OutputFile::create(folder / "a.txt").value());
  doomed.push_back(OutputFile::create("/dev/full").value());
  for (OutputFile& file : doomed) REQUIRE(file.write("newer").has_value());
  OutputFile* const doomed_too[] = {&doomed[0], &doomed[1]};
  CHECK_FALSE(commit_all(doomed_too).has_value());
  doomed.clear();
  CHECK(text_of(folder / "a.txt") == "new");
  CHECK(folder.file_count() == 2);
}

TEST_CASE("a picture can go into a pipe") {
  const ScratchFolder folder;
  Image image(30, 20);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
  for (const char* name : {"a.exr", "a.png"}) {
    REQUIRE(mkfifo((folder / name).c_str(), 0600) == 0);
    std::vector<std::byte> through;
    std::thread reader([&] { through = bytes_of(folder / name); });
    const auto written = write_picture(folder / name, picture_of(image));
    reader.join();
    REQUIRE(written.has_value());
    fs::remove(folder / name);
    REQUIRE(write_picture(folder / name, picture_of(image)).has_value());
    CHECK(through == bytes_of(folder / name));
  }
}

TEST_CASE("a full disk is an error") {
  if (!fs::exists("/dev/full")) return;
  CHECK_FALSE(write_text_file("/dev/full", std::string(100, 'x')).has_value());
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
