#include "base/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

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

// To the disk, where a full one may say so only now.
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

std::string temporary_name(const fs::path& destination) {
  static std::atomic<unsigned> serial{0};
  // Long names would exceed a folder's limit of 255 bytes with the affixes.
  const std::string name = destination.filename().string().substr(0, 200);
  return "." + name + "." + std::to_string(process_id()) + "-" + std::to_string(serial++) + ".tmp";
}

}  // namespace

AtomicFile::AtomicFile(fs::path destination, fs::path temporary, std::FILE* stream)
    : destination_(std::move(destination)), temporary_(std::move(temporary)), stream_(stream) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : destination_(std::move(other.destination_)), temporary_(std::move(other.temporary_)),
      stream_(std::exchange(other.stream_, nullptr)), failed_(other.failed_) {
  other.temporary_.clear();
}

AtomicFile::~AtomicFile() { close_and_remove(); }

Result<AtomicFile> AtomicFile::create(const fs::path& destination) {
  std::error_code error;
  fs::path target = destination;
  if (fs::is_symlink(destination, error)) {
    const fs::path resolved = fs::weakly_canonical(destination, error);
    if (!error) target = resolved;
  }
  const fs::file_status status = fs::status(target, error);
  if (target.filename().empty() || fs::is_directory(status))
    return io_failure(destination, "cannot write here; give a file's name", EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    std::FILE* const stream = std::fopen(target.string().c_str(), "wb");
    if (stream == nullptr) return io_failure(destination, "cannot open for writing", errno);
    return AtomicFile(target, {}, stream);
  }
  for (int attempt = 0; attempt < kMaxNameAttempts; ++attempt) {
    fs::path temporary = target.parent_path() / temporary_name(target);
    std::FILE* const stream = std::fopen(temporary.string().c_str(), "wbx");
    if (stream != nullptr) return AtomicFile(target, std::move(temporary), stream);
    if (errno != EEXIST) break;
  }
  return io_failure(destination, "cannot create a file in this folder", errno);
}

tl::unexpected<Error> AtomicFile::fail(const std::string& what, int error_number) {
  failed_ = true;
  return io_failure(destination_, what, error_number);
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
  if (failed_ || stream_ == nullptr) return fail("cannot write", EIO);
  if (bytes.empty()) return {};
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) return fail("cannot write", errno);
  return {};
}

Result<void> AtomicFile::write(std::string_view text) { return write(std::as_bytes(std::span(text))); }

Result<void> AtomicFile::seek(std::uint64_t position) {
  if (failed_ || stream_ == nullptr) return fail("cannot write", EIO);
  if (seek_to(stream_, position) != 0) return fail("cannot move within the file", errno);
  return {};
}

Result<void> AtomicFile::commit() {
  if (failed_ || stream_ == nullptr) return fail("cannot write", EIO);
  const int sync_error = synchronise(stream_);
  const int close_error = std::fclose(std::exchange(stream_, nullptr)) == 0 ? 0 : errno;
  if (sync_error != 0 || close_error != 0) {
    close_and_remove();
    return fail("cannot write", sync_error != 0 ? sync_error : close_error);
  }
  if (temporary_.empty()) return {};
  std::error_code error;
  const fs::file_status old = fs::status(destination_, error);
  if (fs::is_regular_file(old)) fs::permissions(temporary_, old.permissions(), error);
  fs::rename(temporary_, destination_, error);
  if (error) {
    close_and_remove();
    return fail("cannot replace this file", error.value());
  }
  temporary_.clear();
  return {};
}

void AtomicFile::close_and_remove() noexcept {
  if (stream_ != nullptr) std::fclose(std::exchange(stream_, nullptr));
  if (temporary_.empty()) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  temporary_.clear();
}

Result<void> write_text_file(const fs::path& destination, std::string_view text) {
  Result<AtomicFile> file = AtomicFile::create(destination);
  if (!file) return tl::unexpected(file.error());
  Result<void> written = file->write(text);
  if (!written) return written;
  return file->commit();
}

}  // namespace contrejour
