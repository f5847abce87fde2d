// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/output_file.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/unnamed_file.h"

#if defined(_WIN32)
#include <process.h>
#else
#include <sys/types.h>
#include <unistd.h>
#endif

namespace contrejour {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxNameAttempts = 100;
constexpr int kMaxLinks = 40;  // in a chain, as on Linux
constexpr auto kStale = std::chrono::hours(24);  // no picture takes a day to write
constexpr std::string_view kHiddenEnding = ".contrejour-part";

int process_id() {
#if defined(_WIN32)
  return _getpid();
#else
  return static_cast<int>(getpid());
#endif
}

int seek_to(std::FILE* stream, std::uint64_t position) {
#if defined(_WIN32)
  return _fseeki64(stream, static_cast<long long>(position), SEEK_SET);
#else
  return fseeko(stream, static_cast<off_t>(position), SEEK_SET);
#endif
}

// Writes to the disk; a full disk may report its error only here.
int synchronise(std::FILE* stream) {
  if (std::fflush(stream) != 0) return errno;
#if !defined(_WIN32)
  if (fsync(fileno(stream)) != 0 && errno != EINVAL && errno != EROFS) return errno;  // EINVAL: a pipe
#endif
  return 0;
}

tl::unexpected<Error> io_failure(const fs::path& destination, const std::string& what, int error_number) {
  const std::string reason = std::generic_category().message(error_number);
  return failure(ErrorCode::Io, what + ": " + reason, {destination.string()});
}

// Prefix of a destination's hidden files. Longer names would exceed a folder's limit of 255 bytes.
std::string hidden_prefix(const fs::path& target) {
  constexpr std::size_t kLongestName = 200;
  return fmt::format(".{}.", target.filename().string().substr(0, kLongestName));
}

fs::path hidden_name(const fs::path& target) {
  static std::atomic<unsigned> serial{0};
  return target.parent_path() / fmt::format("{}{}-{}{}", hidden_prefix(target), process_id(), serial++, kHiddenEnding);
}

// Removes hidden files of this destination that killed processes left. Age decides, because in a folder that several
// machines share it is unknown which processes still run.
void remove_stale(const fs::path& target) {
  const std::string prefix = hidden_prefix(target);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(kHiddenEnding)) continue;
    std::error_code ignored;
    const fs::file_time_type written = fs::last_write_time(entry->path(), ignored);
    if (!ignored && fs::file_time_type::clock::now() - written > kStale) fs::remove(entry->path(), ignored);
  }
}

// Follows symbolic links to their target, which need not exist. Nothing if they form a cycle.
std::optional<fs::path> behind_links(fs::path file) {
  std::error_code error;
  for (int link = 0; link <= kMaxLinks; ++link) {
    if (!fs::is_symlink(file, error)) return file;
    const fs::path target = fs::read_symlink(file, error);
    if (error) return file;
    file = target.is_absolute() ? target : file.parent_path() / target;
  }
  return std::nullopt;
}

}  // namespace

struct OutputFile::State {
  fs::path destination, target;
  fs::path hidden;  // empty: unnamed, or no regular file
  std::FILE* stream = nullptr;  // of a regular file
  bool is_regular = true;
  bool failed = false, finished = false, committed = false;
  std::vector<std::byte> held;  // for a destination that is no regular file, until it is finished
  std::size_t held_position = 0;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { clean_up(); }

  void clean_up() noexcept {
    if (stream != nullptr) std::fclose(std::exchange(stream, nullptr));
    if (hidden.empty()) return;
    std::error_code ignored;
    fs::remove(hidden, ignored);
    hidden.clear();
  }

  tl::unexpected<Error> fail(const std::string& what, int error_number) {
    failed = true;
    clean_up();
    return io_failure(destination, what, error_number);
  }

  int open_hidden() {
    remove_stale(target);
    for (int attempt = 0; attempt < kMaxNameAttempts; ++attempt) {
      hidden = hidden_name(target);
      stream = std::fopen(hidden.string().c_str(), "wbx");
      if (stream != nullptr) return 0;
      if (errno != EEXIST) break;
    }
    const int error_number = errno;
    hidden.clear();
    return error_number;
  }

  void hold(std::span<const std::byte> bytes) {
    if (held_position + bytes.size() > held.size()) held.resize(held_position + bytes.size());
    std::memcpy(held.data() + held_position, bytes.data(), bytes.size());
    held_position += bytes.size();
  }

  int pour_out() {
    std::FILE* const out = std::fopen(destination.string().c_str(), "wb");
    if (out == nullptr) return errno;
    int error_number = std::fwrite(held.data(), 1, held.size(), out) == held.size() ? 0 : errno;
    if (error_number == 0) error_number = synchronise(out);
    if (std::fclose(out) != 0 && error_number == 0) error_number = errno;
    return error_number;
  }

  // If the destination exists, an unnamed file gets a hidden name first: no system replaces a file by an unnamed one
  // atomically.
  Result<void> appear() {
    std::error_code error;
    const fs::file_status old = fs::status(target, error);
    if (hidden.empty()) {
      if (!fs::exists(old) && name_unnamed_file(stream, target) == 0) return {};
      const fs::path name = hidden_name(target);
      if (const int error_number = name_unnamed_file(stream, name)) return fail("cannot write", error_number);
      hidden = name;
    }
    if (stream != nullptr && std::fclose(std::exchange(stream, nullptr)) != 0) return fail("cannot write", errno);
    if (fs::is_regular_file(old)) fs::permissions(hidden, old.permissions(), error);
    fs::rename(hidden, target, error);
    if (error) return fail("cannot replace this file", error.value());
    hidden.clear();
    return {};
  }
};

OutputFile::OutputFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
OutputFile::OutputFile(OutputFile&& other) noexcept = default;
OutputFile::~OutputFile() = default;

const fs::path& OutputFile::destination() const { return state_->destination; }
const fs::path& OutputFile::target() const { return state_->target; }
bool OutputFile::is_regular() const { return state_->is_regular; }

Result<OutputFile> OutputFile::create(const fs::path& destination, const OutputFileSettings& settings) {
  auto state = std::make_unique<State>();
  state->destination = destination;
  std::error_code error;
  const fs::file_status status = fs::status(destination, error);
  if (destination.filename().empty() || fs::is_directory(status))
    return io_failure(destination, "cannot write here; give a file's name", EISDIR);
  if (error == std::errc::filename_too_long) return io_failure(destination, "cannot write here", ENAMETOOLONG);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    state->is_regular = false;
    state->target = destination;
    return OutputFile(std::move(state));
  }
  const auto target = behind_links(destination);
  if (!target) return io_failure(destination, "cannot follow this link", ELOOP);
  state->target = *target;
  if (settings.may_be_unnamed) state->stream = open_unnamed_file(hidden_name(*target));
  if (state->stream == nullptr) {
    if (const int error_number = state->open_hidden())
      return io_failure(destination, "cannot create a file in this folder", error_number);
  }
  return OutputFile(std::move(state));
}

Result<void> OutputFile::write(std::span<const std::byte> bytes) {
  if (state_->failed || state_->finished) return state_->fail("cannot write", EIO);
  if (bytes.empty()) return {};
  if (!state_->is_regular)
    state_->hold(bytes);
  else if (std::fwrite(bytes.data(), 1, bytes.size(), state_->stream) != bytes.size())
    return state_->fail("cannot write", errno);
  return {};
}

Result<void> OutputFile::write(std::string_view text) { return write(std::as_bytes(std::span(text))); }

Result<void> OutputFile::seek(std::uint64_t position) {
  if (state_->failed || state_->finished) return state_->fail("cannot write", EIO);
  if (!state_->is_regular)
    state_->held_position = static_cast<std::size_t>(position);
  else if (seek_to(state_->stream, position) != 0)
    return state_->fail("cannot move within the file", errno);
  return {};
}

Result<void> OutputFile::finish() {
  if (state_->failed) return state_->fail("cannot write", EIO);
  if (state_->finished) return {};
  const int error_number = state_->is_regular ? synchronise(state_->stream) : state_->pour_out();
  if (error_number != 0) return state_->fail("cannot write", error_number);
  state_->finished = true;
  return {};
}

Result<void> OutputFile::commit() {
  if (state_->committed) return state_->fail("cannot write", EIO);
  if (auto done = finish(); !done) return done;
  state_->committed = true;
  return state_->is_regular ? state_->appear() : Result<void>();
}

Result<void> commit_all(std::span<OutputFile* const> files) {
  for (const bool regular : {true, false})
    for (OutputFile* const file : files)
      if (file->is_regular() == regular)
        if (auto done = file->finish(); !done) return done;
  for (OutputFile* const file : files)
    if (auto done = file->commit(); !done) return done;
  return {};
}

}  // namespace contrejour
