// SPDX-License-Identifier: Apache-2.0
// contrejour lens check: checks lens files, and compares computed figures with those that the files state.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/text_table.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/lens.h"

namespace contrejour::cli {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  bool json = false;
};

struct Verdict {
  std::string file;
  std::optional<Error> refused;
  Prescription lens;
  FirstOrder computed;  // at the wavelength of the stated figures, the first zoom position
  int stop_index = 0;
  std::vector<std::string> warnings;
};

// Configures the lens at every zoom position, because a lens must be valid at all of them.
Verdict check_lens(const std::string& file) {
  Verdict verdict;
  verdict.file = file;
  auto lens = prescription_of(file);
  if (!lens) {
    verdict.refused = lens.error();
    return verdict;
  }
  verdict.lens = std::move(*lens);
  LensSettings settings;
  const std::size_t positions = std::max<std::size_t>(1, verdict.lens.zoom.size());
  for (std::size_t k = 0; k < positions; ++k) {
    if (!verdict.lens.zoom.empty()) settings.focal_length_mm = verdict.lens.zoom[k].focal_length_mm;
    const auto state = configure_lens(verdict.lens, settings);
    if (!state) {
      verdict.refused = state.error();
      return verdict;
    }
    if (k > 0) continue;
    verdict.computed = first_order(*state, verdict.lens.stated.wavelength_nm);
    verdict.stop_index = state->stop_index + 1;
    verdict.warnings = state->warnings;
  }
  return verdict;
}

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json verdict_json(const Verdict& v) {
  if (v.refused) {
    return {{"file", v.file}, {"accepted", false}, {"error", v.refused->to_string()}, {"warnings", v.warnings}};
  }
  return {{"file", v.file},
          {"accepted", true},
          {"name", v.lens.name},
          {"surface_count", v.lens.surfaces.size()},
          {"stop_index", v.stop_index},
          {"focal_length_mm", v.computed.focal_length_mm},
          {"stated_focal_length_mm", optional_json(v.lens.stated.focal_length_mm)},
          {"back_focal_distance_mm", v.computed.back_focal_distance_mm},
          {"stated_back_focal_distance_mm", optional_json(v.lens.stated.back_focal_distance_mm)},
          {"warnings", v.warnings}};
}

std::string optional_text(const std::optional<double>& value) { return value ? fmt::format("{:.3f}", *value) : "-"; }

std::string verdicts_text(const std::vector<Verdict>& verdicts) {
  TextTable table({"<lens", "<verdict", "surfaces", "stop", "focal length mm", "stated", "back focal distance mm",
                   "stated", "warnings"});
  for (const Verdict& v : verdicts) {
    if (v.refused) {
      table.add({v.file, "refused"});
      continue;
    }
    table.add({v.file, "accepted", fmt::format("{}", v.lens.surfaces.size()), fmt::format("{}", v.stop_index),
               fmt::format("{:.3f}", v.computed.focal_length_mm), optional_text(v.lens.stated.focal_length_mm),
               fmt::format("{:.3f}", v.computed.back_focal_distance_mm),
               optional_text(v.lens.stated.back_focal_distance_mm), fmt::format("{}", v.warnings.size())});
  }
  return table.text();
}

Result<int> run_check(const CheckOptions& options) {
  std::vector<std::string> files = options.files;
  if (files.empty()) {
    for (const BundledLens& bundled : bundled_lenses()) files.emplace_back(bundled.name);
  }
  std::vector<Verdict> verdicts;
  Json list = Json::array();
  for (const std::string& file : files) {
    verdicts.push_back(check_lens(file));
    list.push_back(verdict_json(verdicts.back()));
  }
  if (options.json) {
    print_json({{"lenses", list}});
  } else {
    print(verdicts_text(verdicts));
  }
  int code = kDone;
  for (const Verdict& v : verdicts) {
    for (const std::string& warning : v.warnings) print_error(v.file + ": warning: " + warning);
    if (!v.refused) continue;
    print_error(v.refused->to_string());
    code = kFailed;
  }
  return code;
}

}  // namespace

void add_lens_check(CLI::App& lens, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = lens.add_subcommand("check", "check lens files, and compare computed with stated figures");
  command->add_option("FILE", options->files, "lens files or names (default: all bundled lenses)")->option_text("...");
  command->add_flag("--json", options->json, "print JSON");
  command->footer(
      "The exit code is 1 if a lens is refused.\n\n"
      "Examples:\n"
      "  contrejour lens check my-lens.toml other.toml\n"
      "  contrejour lens check");
  command->callback([options, &action] { action = [options] { return run_check(*options); }; });
}

}  // namespace contrejour::cli
