// SPDX-License-Identifier: Apache-2.0
#include "cli/app.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <memory>
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

bool is_list_of_numbers(const std::string& word) {
  const bool starts = !word.empty() && std::string("+-.0123456789").find(word[0]) != std::string::npos;
  return starts && word.find(',') != std::string::npos &&
         std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

// `--light 1,2 3,4` means `--light 1,2 --light 3,4`; the parser could not distinguish the second value from LENS.
std::vector<std::string> repeat_light_flags(const std::vector<std::string>& arguments) {
  std::vector<std::string> expanded;
  std::string flag;
  bool expects_value = false;
  for (const std::string& word : arguments) {
    if (word == "--light" || word == "--light-at") {
      flag = word;
      expects_value = true;
    } else if (!expects_value && !flag.empty() && is_list_of_numbers(word)) {
      expanded.push_back(flag);
    } else {
      if (!expects_value) flag.clear();
      expects_value = false;
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

std::vector<std::string> names_in(const CLI::App* command) {
  std::vector<std::string> words;
  for (const CLI::App* sub : command->get_subcommands([](const CLI::App*) { return true; }))
    words.push_back(sub->get_name());
  for (const CLI::Option* option : command->get_options()) {
    if (option->get_group().empty()) continue;  // the help does not show it
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  }
  return words;
}

std::string suggestion(const CLI::App* command) {
  const std::vector<std::string> words = names_in(command);
  const std::vector<std::string_view> known(words.begin(), words.end());
  for (const std::string& word : command->remaining(true)) {
    const std::string nearest = nearest_name(word.substr(0, word.find('=')), known);
    if (!nearest.empty()) return fmt::format("; did you mean {}?", nearest);
  }
  return "";
}

int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = deepest_command(&app);
  std::string message = error.what();
  if (message.ends_with("A subcommand is required"))
    message = "a sub-command is missing; give one of those that --help lists";
  print_error(fmt::format("{}{} (see {} --help)", message, suggestion(command), full_name(command)));
  return kUsage;
}

int finish(const Result<int>& result) {
  if (result) {
    if (flush_output()) return *result;
    print_error("the standard output cannot be written to; check that its device has space");
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

// Names a switch and its negative form as "--x,--no-x"; CLI11 adds "{false}".
struct HelpFormatter : CLI::Formatter {
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    std::string name = CLI::Formatter::make_option_name(option, is_positional);
    constexpr std::string_view kNegation = "{false}";
    for (std::size_t at = name.find(kNegation); at != std::string::npos; at = name.find(kNegation))
      name.erase(at, kNegation.size());
    return name;
  }
};

// Sub-commands take over the formatter and the help flag, so these are set first.
void set_up(CLI::App& app, Action& action) {
  app.name("contrejour");
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version", "contrejour " CONTREJOUR_VERSION, "print the version");
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  contrejour render heliar -f 16 --light-at 0.7,0.33 -o flare.exr --preview flare.png\n"
      "  contrejour apply canon-70-200 --focal 135 plate.exr -o out.exr\n"
      "  contrejour lens list\n\n"
      "Exit codes: 0 success, 1 failure, 2 wrong usage, 130 interrupted.");
  add_render(app, action);
  add_apply(app, action);
  add_lights(app, action);
  add_farm(app, action);
  add_devices(app, action);
  add_studio(app, action);
  add_lens(app, action);
  add_glass(app, action);
  add_ghosts(app, action);
  add_compare(app, action);
  add_preset(app, action);
  add_coating(app, action);
  add_measure(app, action);
  add_polynomial(app, action);
  add_bench(app, action);
}

int run_checked(std::vector<std::string> arguments) {
  CLI::App app("Computes the lens flare that a real lens produces.");
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
    print_error("the memory is exhausted; give a smaller --size or fewer --threads");
  } catch (const std::exception& error) {
    print_error(error.what());
  }
  return kFailed;
}

}  // namespace contrejour::cli
