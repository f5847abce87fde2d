// SPDX-License-Identifier: Apache-2.0
#include "base/unnamed_file.h"

#include <cerrno>
#include <string>

#if defined(__linux__)
#include <fcntl.h>
#include <unistd.h>
#endif

namespace contrejour::inline internal {

#if defined(__linux__) && defined(O_TMPFILE)

namespace {

int open_in(const std::filesystem::path& folder) {
  return open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
}

// Names such a file without privileges, as described in open(2), O_TMPFILE.
int give_name(int descriptor, const std::filesystem::path& name) {
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  return linkat(AT_FDCWD, link.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

}  // namespace

std::FILE* open_unnamed_file(const std::filesystem::path& spare_name) {
  const int first = open_in(spare_name.parent_path());
  if (first < 0) return nullptr;
  const bool can_be_named = give_name(first, spare_name) == 0;
  if (can_be_named) unlink(spare_name.c_str());
  close(first);
  const int descriptor = can_be_named ? open_in(spare_name.parent_path()) : -1;
  std::FILE* const file = descriptor >= 0 ? fdopen(descriptor, "wb") : nullptr;
  if (file == nullptr && descriptor >= 0) close(descriptor);
  return file;
}

int name_unnamed_file(std::FILE* file, const std::filesystem::path& name) { return give_name(fileno(file), name); }

#else

std::FILE* open_unnamed_file(const std::filesystem::path& /*spare_name*/) { return nullptr; }
int name_unnamed_file(std::FILE* /*file*/, const std::filesystem::path& /*name*/) { return ENOTSUP; }

#endif

}  // namespace contrejour::inline internal
