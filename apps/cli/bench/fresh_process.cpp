// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/fresh_process.h"

#if defined(__linux__)
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <utility>

extern char** environ;
#endif

namespace contrejour::cli {

#if defined(__linux__)
namespace {

constexpr const char* kThisProgram = "/proc/self/exe";  // proc(5)

struct Pipe {
  std::array<int, 2> ends{-1, -1};  // the ends to read and to write
  Pipe() = default;
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    for (const int end : ends) {
      if (end >= 0) close(end);
    }
  }
  void close_writing_end() { close(std::exchange(ends[1], -1)); }
};

std::string read_to_end(int file) {
  std::string text;
  std::array<char, 4096> part;
  for (;;) {
    const ssize_t count = read(file, part.data(), part.size());
    if (count > 0) text.append(part.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) return text;
  }
}

// The exit status as a shell reports it, or 255 if a signal ended the process.
int wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

}  // namespace

Result<std::string> output_of_fresh_process(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"contrejour"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  Pipe output;
  if (pipe(output.ends.data()) != 0) return failure(ErrorCode::Io, "no pipe to a new process can be created");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addclose(&actions, output.ends[0]);
  posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDOUT_FILENO);
  pid_t process = 0;
  const int failed = posix_spawn(&process, kThisProgram, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  output.close_writing_end();
  if (failed != 0) return failure(ErrorCode::Io, "no new process of this program can be started; use --warm-only");
  std::string text = read_to_end(output.ends[0]);
  if (wait_for(process) != 0)
    return failure(ErrorCode::Io, "a new process of this program failed; its message is above");
  return text;
}

#else

Result<std::string> output_of_fresh_process(const std::vector<std::string>&) {
  return failure(ErrorCode::Unsupported,
                 "first frames of new processes can be measured on Linux only; use --warm-only");
}

#endif

}  // namespace contrejour::cli
