// SPDX-License-Identifier: Apache-2.0
// contrejour glass list and closest: print many glasses, one on each line.
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/glass_choice.h"
#include "cli/options.h"
#include "cli/text_table.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::cli {
namespace {

struct GlassListOptions {
  std::vector<std::string> catalogues, makers;
  bool json = false;
  // For `closest` only.
  double n_d = 0, v_d = 0;
  int count = 5;
  bool obsolete = false;
};

Json summary_json(const GlassSummary& glass) {
  const auto or_null = [](double value) { return value == 0.0 ? Json() : Json(value); };
  return {{"name", glass.name}, {"maker", glass.maker},      {"status", status_name(glass.status)},
          {"code", glass.code}, {"n_d", or_null(glass.n_d)}, {"v_d", or_null(glass.v_d)}};
}

std::vector<std::string> summary_cells(const GlassSummary& glass) {
  const auto number = [](double value, int digits) {
    return value == 0.0 ? "" : fmt::format("{:.{}f}", value, digits);
  };
  return {glass.maker,          glass.name, number(glass.n_d, 6),
          number(glass.v_d, 3), glass.code, std::string(status_name(glass.status))};
}

// A number within a range; CLI::Range accepts NaN.
CLI::Validator within(double low, double high) {
  const auto problem = [low, high](const std::string& text) {
    const auto value = params::parse_real(text);
    if (value && *value >= low && *value <= high) return std::string();
    return fmt::format("{} is out of range; give a number from {} to {}", text, low, high);
  };
  return {problem, "", "range"};
}

void add_common_options(CLI::App& command, GlassListOptions& options) {
  command.add_option("--maker", options.makers, "list only glasses of this maker; may be repeated")
      ->option_text("MAKER");
  add_catalogue_option(command, options.catalogues);
  command.add_flag("--json", options.json, "print JSON");
}

// A maker that is in no catalogue is an error.
Result<void> check_makers(const GlassCatalogue& glasses, const std::vector<std::string>& makers) {
  for (const std::string& maker : makers) {
    bool known = false;
    for (std::size_t k = 0; k < glasses.size() && !known; ++k)
      known = glasses.is_of(k, std::vector<std::string>{maker});
    if (known) continue;
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("no catalogue has glasses of the maker \"{}\"; give one of {}", maker,
                               fmt::join(glasses.makers(), ", ")));
  }
  return {};
}

Result<int> run_glass_list(const GlassListOptions& options) {
  const auto glasses = all_glasses(options.catalogues);
  if (!glasses) return tl::unexpected(glasses.error());
  if (const auto known = check_makers(*glasses, options.makers); !known) return tl::unexpected(known.error());
  Json list = Json::array();
  TextTable table({"<maker", "<glass", "n_d", "V_d", "<code", "<status"});
  for (std::size_t k = 0; k < glasses->size(); ++k) {
    if (!glasses->is_of(k, options.makers)) continue;
    const GlassSummary glass = glasses->summary(k);
    if (options.json) {
      list.push_back(summary_json(glass));
    } else {
      table.add(summary_cells(glass));
    }
  }
  if (options.json) {
    print_json({{"glasses", list}});
  } else {
    print(table.text());
  }
  return kDone;
}

Result<int> run_closest(const GlassListOptions& options) {
  const auto glasses = all_glasses(options.catalogues);
  if (!glasses) return tl::unexpected(glasses.error());
  if (const auto known = check_makers(*glasses, options.makers); !known) return tl::unexpected(known.error());
  const auto close = glasses->closest(options.n_d, options.v_d, static_cast<std::size_t>(options.count), options.makers,
                                      options.obsolete);
  Json list = Json::array();
  TextTable table({"distance", "<maker", "<glass", "n_d", "V_d", "<code", "<status"});
  for (const CloseGlass& one : close) {
    Json row = summary_json(one.glass);
    row["distance"] = one.distance;
    list.push_back(std::move(row));
    std::vector<std::string> cells = summary_cells(one.glass);
    cells.insert(cells.begin(), fmt::format("{:.3f}", one.distance));
    table.add(std::move(cells));
  }
  if (options.json) {
    print_json({{"n_d", options.n_d}, {"v_d", options.v_d}, {"glasses", list}});
  } else {
    print(table.text());
  }
  return kDone;
}

}  // namespace

void add_glass_list(CLI::App& glass, Action& action) {
  const auto options = std::make_shared<GlassListOptions>();
  CLI::App* command = glass.add_subcommand("list", "list all glasses, one on each line");
  add_common_options(*command, *options);
  command->footer(
      "Examples:\n  contrejour glass list --maker SCHOTT --maker OHARA\n  contrejour glass list --catalogue mine.agf "
      "--json");
  command->callback([options, &action] { action = [options] { return run_glass_list(*options); }; });
}

void add_glass_closest(CLI::App& glass, Action& action) {
  const auto options = std::make_shared<GlassListOptions>();
  CLI::App* command = glass.add_subcommand("closest", "find the glasses closest to an index and an Abbe number");
  command->add_option("N_D", options->n_d, "refractive index at 587.56 nm")
      ->required()
      ->check(within(1.0, 5.0))
      ->option_text(" ");
  command->add_option("V_D", options->v_d, "Abbe number")->required()->check(within(5.0, 200.0))->option_text(" ");
  add_number(*command, "--count", options->count, 1, 10000, "number of glasses");
  command->add_flag("--obsolete", options->obsolete, "include glasses that are no longer made");
  add_common_options(*command, *options);
  command->footer(
      "A distance of 1 is a difference of 0.001 in n_d or of 0.8 in V_d, about that between melts of one glass.\n\n"
      "Examples:\n  contrejour glass closest 1.62004 36.37\n  contrejour glass closest 1.5168 64.2 --maker HOYA "
      "--count 1 --json");
  command->callback([options, &action] { action = [options] { return run_closest(*options); }; });
}

}  // namespace contrejour::cli
