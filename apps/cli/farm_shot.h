// SPDX-License-Identifier: Apache-2.0
// A command for a sequence (`apply` or `render`), divided into chunks of frames that different machines can render.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "contrejour/result.h"

namespace contrejour::cli {

struct FarmOptions {
  std::vector<std::string> command;  // as it would be given to this program on one machine
  int chunk = 10;                    // frames of a task
  std::string program;               // on the machines of the farm; empty: this program's file
};

// Adds the command after --, --chunk and --program.
void add_farm_options(CLI::App& command, FarmOptions& options);

class FarmShot {
 public:
  // Errors: InvalidArgument for a command other than `apply` and `render`; Unsupported if --program is needed.
  [[nodiscard]] static Result<FarmShot> create(const FarmOptions& options);

  // The frames that are not done, in rising order: those that the command lists itself. Errors: those of the command
  // (its own message is on the standard error by then).
  [[nodiscard]] Result<std::vector<int>> frames_left() const;

  // The frames in chunks, each as a range (frame_range.h).
  [[nodiscard]] std::vector<std::string> chunks_of(const std::vector<int>& frames) const;

  // The command line of a chunk for a POSIX shell. frames: a word of the shell. The frames that are done are left out,
  // and one that fails does not prevent the others.
  [[nodiscard]] std::string command_line(const std::string& frames) const;

  // Whether the command gives its number of threads.
  [[nodiscard]] bool has_threads() const;

 private:
  FarmShot() = default;

  std::string program_;
  std::vector<std::string> arguments_;  // without frames
  std::string frames_;  // of the command, as given; empty: none
  int chunk_ = 1;
};

// A word that a POSIX shell reads as the text, whatever it contains.
[[nodiscard]] std::string shell_quoted(const std::string& text);

}  // namespace contrejour::cli
