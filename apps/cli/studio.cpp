// SPDX-License-Identifier: Apache-2.0
// contrejour studio: starts the desktop program, contrejour-studio, which lies beside this one. It is a program of its
// own so that the command line needs no window system.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/child_process.h"
#include "cli/command.h"

namespace contrejour::cli {
namespace {

constexpr const char* kStudioProgram = "contrejour-studio";

Result<int> start_studio(const std::vector<std::string>& arguments) {
  const auto self = this_program();
  const auto beside = self ? std::filesystem::path(*self).parent_path() / kStudioProgram : kStudioProgram;
  std::error_code code;
  if (self && !std::filesystem::exists(beside, code))
    return failure(ErrorCode::Unsupported,
                   "the studio was not built: install libimgui-dev, libglfw3-dev and libgl-dev and build again "
                   "(./dev studio); the command line renders its sessions: contrejour render --session FILE",
                   {beside.string()});
  return tl::unexpected(become(beside.string(), arguments));
}

}  // namespace

void add_studio(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      app.add_subcommand("studio", "open the desktop program: drag the light, see what makes the flare");
  command->add_option("ARGUMENTS", *arguments, "a lens or a session, and options of contrejour-studio (docs/studio.md)")
      ->option_text(" ");
  command->prefix_command();
  command->callback([command, arguments, &action] {
    std::vector<std::string> all = *arguments;
    for (const std::string& word : command->remaining()) all.push_back(word);
    action = [all] { return start_studio(all); };
  });
}

}  // namespace contrejour::cli
