// SPDX-License-Identifier: Apache-2.0
#include "cli/app.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/terminal.h"
#include "contrejour/expert/nearest_name.h"

namespace contrejour::cli {
namespace {

bool reads_as_numbers(const std::string& word) {
  const bool starts = !word.empty() && std::string("+-.0123456789").find(word[0]) != std::string::npos;
  return starts && word.find(',') != std::string::npos &&
         std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

// `--light 1,2 3,4` means `--light 1,2 --light 3,4`; the parser could not distinguish the second value from LENS.
std::vector<std::string> repeat_light_flags(const std::vector<std::string>& arguments) {
  std::vector<std::string> expanded;
  std::string flag;
  bool fresh = false;
  for (const std::string& word : arguments) {
    if (word == "--light" || word == "--light-at") {
      flag = word;
      fresh = true;
    } else if (!fresh && !flag.empty() && reads_as_numbers(word)) {
      expanded.push_back(flag);
    } else {
      if (!fresh) flag.clear();
      fresh = false;
    }
    expanded.push_back(word);
  }
  return expanded;
}

const CLI::App* deepest_command(const CLI::App* app) {
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  return app;
}

// The whole name of a command: "contrejour lens info".
std::string full_name(const CLI::App* app) {
  return app->get_parent() == nullptr ? app->get_name() : full_name(app->get_parent()) + " " + app->get_name();
}

std::vector<std::string> words_of(const CLI::App* command) {
  std::vector<std::string> words;
  for (const CLI::App* sub : command->get_subcommands([](const CLI::App*) { return true; }))
    words.push_back(sub->get_name());
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  }
  return words;
}

std::string suggestion(const CLI::App* command) {
  const std::vector<std::string> words = words_of(command);
  const std::vector<std::string_view> known(words.begin(), words.end());
  for (const std::string& word : command->remaining(true)) {
    const std::string near = nearest_name(word.substr(0, word.find('=')), known);
    if (!near.empty()) return fmt::format("; did you mean {}?", near);
  }
  return "";
}

int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = deepest_command(&app);
  std::string message = error.what();
  if (message.ends_with("A subcommand is required")) message = "say what to do: a sub-command is missing";
  print_error(fmt::format("{}{} (see {} --help)", message, suggestion(command), full_name(command)));
  return kUsage;
}

int finish(const Result<int>& result) {
  if (result) {
    if (flush_output()) return *result;
    print_error("cannot write to the standard output");
    return kFailed;
  }
  flush_output();
  if (result.error().code == ErrorCode::Cancelled || interrupt_flag().load()) {
    print_error("interrupted");
    return kInterrupted;
  }
  print_error(result.error().to_string());
  return kFailed;
}

void set_up(CLI::App& app, Action& action) {
  app.name("contrejour");
  app.set_version_flag("--version", "contrejour " CONTREJOUR_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  contrejour render heliar -f 16 --light-at 0.7,0.33 -o flare.exr --preview flare.png\n"
      "  contrejour apply canon-70-200 --focal 135 plate.exr -o out.exr\n"
      "  contrejour lens list\n\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage, 130 interrupted.");
  add_render(app, action);
  add_apply(app, action);
  add_lens(app, action);
  add_glass(app, action);
  add_ghosts(app, action);
  add_compare(app, action);
  add_look(app, action);
  add_coating(app, action);
  add_bench(app, action);
}

int run_checked(std::vector<std::string> arguments) {
  CLI::App app("The flare that a real lens gives.");
  Action action;
  set_up(app, action);
  try {
    arguments = repeat_light_flags(arguments);
    std::reverse(arguments.begin(), arguments.end());  // in the order that CLI11 expects
    app.parse(std::move(arguments));
  } catch (const CLI::Success& success) {  // --help, --version
    app.exit(success);
    return flush_output() ? kDone : kFailed;
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error);
  }
  catch_interrupts();
  return finish(action());
}

}  // namespace

int run(std::vector<std::string> arguments) {
  occupy_standard_streams();
  try {
    return run_checked(std::move(arguments));
  } catch (const std::bad_alloc&) {
    print_error("out of memory; choose a smaller size or fewer threads");
  } catch (const std::exception& error) {
    print_error(error.what());
  }
  return kFailed;
}

}  // namespace contrejour::cli
