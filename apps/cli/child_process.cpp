// SPDX-License-Identifier: Apache-2.0
#include "cli/child_process.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#if defined(__linux__) || defined(__APPLE__)
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <utility>

extern char** environ;
#endif

namespace contrejour::cli {

#if defined(__linux__) || defined(__APPLE__)
namespace {

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

// The words as exec(3) takes them.
struct ArgumentVector {
  std::vector<std::string> words;
  std::vector<char*> argv;

  ArgumentVector(const std::string& program, const std::vector<std::string>& arguments) : words{program} {
    words.insert(words.end(), arguments.begin(), arguments.end());
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
  }
};

std::string cannot_start(int reason) {
  return fmt::format("the program cannot be started ({}); is it installed and on the PATH?",
                     std::generic_category().message(reason));
}

int exit_code_of(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

}  // namespace

Result<ChildOutput> run_child(const std::string& program, const std::vector<std::string>& arguments,
                              ChildErrors errors) {
  ArgumentVector words(program, arguments);
  Pipe output;
  if (pipe(output.ends.data()) != 0) return failure(ErrorCode::Io, "no pipe to a new process can be created");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addclose(&actions, output.ends[0]);
  posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDOUT_FILENO);
  if (errors == ChildErrors::Hidden)
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int failed = posix_spawnp(&process, program.c_str(), &actions, nullptr, words.argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  output.close_writing_end();
  if (failed != 0) return failure(ErrorCode::Io, cannot_start(failed), {program});
  ChildOutput result{read_to_end(output.ends[0]), 0};
  result.exit_code = exit_code_of(process);
  return result;
}

Error become(const std::string& program, const std::vector<std::string>& arguments) {
  ArgumentVector words(program, arguments);
  execvp(program.c_str(), words.argv.data());
  return {ErrorCode::Io, cannot_start(errno), {program}};
}

#else

Error become(const std::string& program, const std::vector<std::string>&) {
  return {ErrorCode::Unsupported, "other programs can be run on Linux and macOS only", {program}};
}

Result<ChildOutput> run_child(const std::string& program, const std::vector<std::string>&, ChildErrors) {
  return failure(ErrorCode::Unsupported, "other programs can be run on Linux and macOS only", {program});
}

#endif

Result<std::string> this_program() {
  std::error_code error;
  const auto file = std::filesystem::read_symlink("/proc/self/exe", error);  // proc(5)
  if (error) return failure(ErrorCode::Unsupported, "the file of this program is known on Linux only");
  return file.string();
}

Result<std::string> output_of_fresh_process(const std::vector<std::string>& arguments) {
  const auto program = this_program();
  if (!program) return tl::unexpected(program.error());
  auto output = run_child(*program, arguments);
  if (!output) return tl::unexpected(output.error());
  if (output->exit_code != 0)
    return failure(ErrorCode::Io, "a new process of this program failed; its message is above");
  return std::move(output->text);
}

}  // namespace contrejour::cli
