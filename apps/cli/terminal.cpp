// SPDX-License-Identifier: Apache-2.0
#include "cli/terminal.h"

#include <cstdio>

#if defined(_WIN32)
#include <io.h>
#else
#include <cerrno>

#include <fcntl.h>
#include <unistd.h>
#endif

namespace contrejour::cli {

bool error_stream_is_terminal() {
#if defined(_WIN32)
  return _isatty(_fileno(stderr)) != 0;
#else
  return isatty(fileno(stderr)) != 0;
#endif
}

void write_unchecked(std::string_view text) {
  while (!text.empty()) {
#if defined(_WIN32)
    const int written = _write(_fileno(stdout), text.data(), static_cast<unsigned>(text.size()));
#else
    const ssize_t written = write(fileno(stdout), text.data(), text.size());
#endif
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void occupy_standard_streams() {
#if !defined(_WIN32)
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // Opens the lowest free descriptor, which is this one. Printing to it fails, since it is open for reading.
    if (open("/dev/null", O_RDONLY) < 0) return;
  }
#endif
}

}  // namespace contrejour::cli
