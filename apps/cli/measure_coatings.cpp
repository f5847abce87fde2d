// SPDX-License-Identifier: Apache-2.0
// contrejour measure coatings: merged stations of a known lens -> the lens with the reflectances that its ghosts show.
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/known_lens.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

constexpr const char* kCoatingsExamples =
    "LENS is the lens that was photographed, FOLDER what `contrejour measure merge` wrote. The energy of a ghost is "
    "the\n"
    "product of two surfaces' reflectances and of what the lens's geometry makes of it. Surfaces that the ghosts do "
    "not\n"
    "tell apart are named in warnings; they are open in the table.\n\n"
    "Examples:\n"
    "  contrejour measure coatings tessar merged -o learnt.toml\n"
    "  contrejour measure coatings mine.zmx merged -f 2.8 -o learnt.toml --max-ghosts 60 --json";

struct CoatingsOptions {
  KnownLensOptions known;
  CoatingFitOptions fit;
};

std::string percent_text(double value) { return fmt::format("{:.2f}", 100.0 * value); }

std::string coatings_text(const LearntCoatings& learnt) {
  TextTable table({"surface", "red %", "+-", "green %", "+-", "blue %", "+-", "<"});
  for (const LearntReflectance& of : learnt.surfaces) {
    std::vector<std::string> cells{std::to_string(of.surface)};
    std::string open;
    for (std::size_t c = 0; c < 3; ++c) {
      cells.push_back(percent_text(of.reflectance[c]));
      cells.push_back(percent_text(of.reflectance[c] * of.relative_error[c]));
      if (!of.determined[c]) open += std::string(open.empty() ? "open in " : ", ") + "rgb"[c];
    }
    cells.push_back(open);
    table.add(std::move(cells));
  }
  return table.text() +
         fmt::format("\n{} ghosts; {}, {} and {} of {} reflectances are determined in red, green, blue\n",
                     learnt.ghosts.size(), learnt.rank[0], learnt.rank[1], learnt.rank[2], learnt.unknowns);
}

Json rgb_json(const Rgb& rgb) { return Json::array({rgb[0], rgb[1], rgb[2]}); }

Json coatings_json(const LearntCoatings& learnt) {
  Json surfaces = Json::array(), ghosts = Json::array(), alike = Json::array();
  for (const LearntReflectance& of : learnt.surfaces) {
    surfaces.push_back({{"surface", of.surface},
                        {"reflectance", rgb_json(of.reflectance)},
                        {"relative_error", rgb_json(of.relative_error)},
                        {"determined", Json::array({of.determined[0], of.determined[1], of.determined[2]})}});
  }
  for (const GhostEnergy& of : learnt.ghosts)
    ghosts.push_back({{"ghost", ghost_name(of.ghost)}, {"ratio", rgb_json(of.ratio)}, {"error", rgb_json(of.error)}});
  for (const auto& [a, b] : learnt.alike) alike.push_back(Json::array({ghost_name(a), ghost_name(b)}));
  return {{"surfaces", surfaces},
          {"unknowns", learnt.unknowns},
          {"rank", Json::array({learnt.rank[0], learnt.rank[1], learnt.rank[2]})},
          {"ghosts", ghosts},
          {"alike", alike},
          {"rounds", learnt.rounds},
          {"warnings", learnt.warnings}};
}

Result<int> run_coatings(const CoatingsOptions& options) {
  const auto known = open_known_lens(options.known);
  if (!known) return tl::unexpected(known.error());
  const LongTask task("measuring ghosts", options.known.threads);
  const auto learnt = learn_coatings(known->photographs, options.fit, task.context());
  if (!learnt) return tl::unexpected(learnt.error());
  if (auto ok = write_learnt_lens(options.known.output, learnt->lens); !ok) return tl::unexpected(ok.error());
  print_warnings(learnt->warnings);
  if (options.known.json)
    print_json(coatings_json(*learnt));
  else
    print(coatings_text(*learnt));
  return kDone;
}

}  // namespace

void add_measure_coatings(CLI::App& measure, Action& action) {
  const auto options = std::make_shared<CoatingsOptions>();
  CLI::App* command = measure.add_subcommand("coatings", "learn a known lens's coatings from its ghosts");
  add_known_lens(*command, options->known);
  add_number(*command, "--max-ghosts", options->fit.max_ghosts, 1, 1000, "ghosts to measure, the brightest");
  add_number(*command, "--width", options->fit.max_width, 32, 2000, "pixels that pictures are reduced to");
  add_number(*command, "--rounds", options->fit.max_rounds, 1, 20, "drawings of all ghosts with what was learnt");
  command->footer(kCoatingsExamples);
  command->callback([options, &action] { action = [options] { return run_coatings(*options); }; });
}

}  // namespace contrejour::cli
