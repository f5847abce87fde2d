// SPDX-License-Identifier: Apache-2.0
// contrejour farm commands: a command line for each chunk, for any scheduler that runs a list of commands.
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/farm_shot.h"

namespace contrejour::cli {
namespace {

Result<int> run_farm_commands(const FarmOptions& options) {
  const auto shot = FarmShot::create(options);
  if (!shot) return tl::unexpected(shot.error());
  const auto frames = shot->frames_left();
  if (!frames) return tl::unexpected(frames.error());
  const std::string folder = shell_quoted(std::filesystem::current_path().string());
  for (const std::string& chunk : shot->chunks_of(*frames))
    print(fmt::format("cd {} && {}\n", folder, shot->command_line(shell_quoted(chunk))));
  return kDone;
}

}  // namespace

void add_farm_commands(CLI::App& farm, Action& action) {
  const auto options = std::make_shared<FarmOptions>();
  CLI::App* command = farm.add_subcommand("commands", "print the command line of each chunk, one a line");
  add_farm_options(*command, *options);
  command->footer(
      "For OpenCue's cuecmd, GNU parallel, or any scheduler that runs a list of commands.\n\n"
      "Examples:\n"
      "  contrejour farm commands --chunk 5 -- apply heliar plate.####.exr -o out.####.exr > shot.txt\n"
      "  contrejour farm commands -- render heliar -o flare.####.exr --frames 1-48 | parallel --sshlogin a,b");
  command->callback([options, &action] { action = [options] { return run_farm_commands(*options); }; });
}

}  // namespace contrejour::cli
