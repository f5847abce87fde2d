// SPDX-License-Identifier: Apache-2.0
#include "cli/farm_shot.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "cli/child_process.h"
#include "cli/options.h"
#include "contrejour/expert/frame_range.h"

namespace contrejour::cli {
namespace {

constexpr std::string_view kFrames = "--frames";

bool is_option(const std::string& word, std::string_view name) {
  return word == name || word.starts_with(fmt::format("{}=", name));
}

bool gives(const std::vector<std::string>& words, std::string_view option) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return is_option(word, option); });
}

bool has_layers_by_ghost(const std::vector<std::string>& words) {
  const auto at = std::find(words.begin(), words.end(), "--layers");
  return gives(words, "--layers=ghost") || (at != words.end() && at + 1 != words.end() && at[1] == "ghost");
}

}  // namespace

void add_farm_options(CLI::App& command, FarmOptions& options) {
  command
      .add_option("COMMAND", options.command,
                  "after --: `apply` or `render` with its arguments, as on one machine, for a sequence")
      ->required()
      ->option_text("-- COMMAND ...");
  add_number(command, "--chunk", options.chunk, 1, 1000000, "frames that one task renders");
  command
      .add_option("--program", options.program,
                  "the program's file on the machines that render (default: the file that runs here)")
      ->option_text("FILE");
}

Result<FarmShot> FarmShot::create(const FarmOptions& options) {
  const std::vector<std::string>& words = options.command;
  if (words.front() != "apply" && words.front() != "render")
    return invalid_argument(
        fmt::format("a farm runs `apply` and `render`, not `{}`; give the command after --", words.front()));
  if (has_layers_by_ghost(words) && !gives(words, "--layer-ghosts"))
    return invalid_argument(
        "with --layers ghost, each chunk would choose ghosts of its own; give --layer-ghosts LIST, as the command "
        "prints "
        "it on one machine");
  FarmShot shot;
  shot.chunk_ = options.chunk;
  shot.program_ = options.program;
  if (shot.program_.empty()) {
    auto program = this_program();
    if (!program) return failure(ErrorCode::Unsupported, "give the program's file on the farm: --program FILE");
    shot.program_ = std::move(*program);
  }
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == kFrames && k + 1 < words.size()) {
      shot.frames_ = words[++k];
    } else if (is_option(words[k], kFrames)) {
      shot.frames_ = words[k].substr(std::min(words[k].size(), kFrames.size() + 1));
    } else if (words[k] != "--resume" && words[k] != "--keep-going") {  // both are added to every chunk
      shot.arguments_.push_back(words[k]);
    }
  }
  return shot;
}

Result<std::vector<int>> FarmShot::frames_left() const {
  std::vector<std::string> arguments = arguments_;
  if (!frames_.empty()) arguments.push_back(fmt::format("{}={}", kFrames, frames_));
  arguments.insert(arguments.end(), {"--resume", "--list-frames"});
  auto program = this_program();
  if (!program) return tl::unexpected(program.error());
  const auto listed = run_child(*program, arguments);
  if (!listed) return tl::unexpected(listed.error());
  if (listed->exit_code != 0)
    return failure(ErrorCode::InvalidArgument, "the command cannot list its frames; its message is above");
  if (listed->text.empty()) return std::vector<int>{};
  return parse_frame_range(std::string_view(listed->text).substr(0, listed->text.find('\n')));
}

std::vector<std::string> FarmShot::chunks_of(const std::vector<int>& frames) const {
  std::vector<std::string> chunks;
  for (auto first = frames.begin(); first != frames.end();) {
    const auto last = first + std::min<std::ptrdiff_t>(chunk_, frames.end() - first);
    chunks.push_back(frame_range_text({first, last}));
    first = last;
  }
  return chunks;
}

std::string FarmShot::command_line(const std::string& frames) const {
  std::string line = shell_quoted(program_);
  for (const std::string& word : arguments_) line += " " + shell_quoted(word);
  return line + fmt::format(" {}={} --resume --keep-going", kFrames, frames);
}

bool FarmShot::has_threads() const { return gives(arguments_, "--threads"); }

std::string shell_quoted(const std::string& text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+,:@%=";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char letter : text) quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return quoted + "'";
}

}  // namespace contrejour::cli
