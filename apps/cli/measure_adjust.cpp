// SPDX-License-Identifier: Apache-2.0
// contrejour measure adjust: merged stations of a known lens -> the lens with the focus, stop, air spaces, tilts and
// decentres that its ghosts show.
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/known_lens.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/text_table.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kAdjustExamples =
    "LENS is the lens that was photographed, FOLDER what `contrejour measure merge` wrote. Tolerances say how far the\n"
    "lens may be from its file (standard errors); 0 keeps a number as it is. A number about which the pictures say\n"
    "little beyond its tolerance is marked open.\n\n"
    "Examples:\n"
    "  contrejour measure adjust tessar merged -o adjusted.toml\n"
    "  contrejour measure adjust tessar merged -o adjusted.toml --tilt-tolerance 0.05 --gap-tolerance 0 --json";

struct AdjustCommand {
  KnownLensOptions known;
  AdjustOptions fit;
  double tilt_deg = 0.1;
};

bool is_tilt(const LearntNumber& number) {
  return number.kind == LearntKind::TiltX || number.kind == LearntKind::TiltY;
}

// In the units that people read.
struct Shown {
  double scale = 1.0;
  const char* unit = "mm";
};
Shown shown(const LearntNumber& number) {
  if (is_tilt(number)) return {1.0 / params::kDegree_rad, "degrees"};
  if (number.kind == LearntKind::StopRadius) return {100.0, "%"};
  return {};
}

std::string adjust_text(const AdjustedLens& adjusted) {
  TextTable table({"<number", "change", "+-", "tolerance", "<", "<"});
  for (const LearntNumber& number : adjusted.numbers) {
    const auto [scale, unit] = shown(number);
    table.add({learnt_name(number), fmt::format("{:+.4f}", scale * number.value),
               fmt::format("{:.4f}", scale * number.error), fmt::format("{:.4g}", scale * number.tolerance), unit,
               number.determined ? "" : "open"});
  }
  return table.text() + fmt::format("\n{} ghosts, off by {:.2f} pixels before and {:.2f} after (RMS); {} drawings\n",
                                    adjusted.ghosts.size(), adjusted.rms_before_px, adjusted.rms_after_px,
                                    adjusted.drawings);
}

Json adjust_json(const AdjustedLens& adjusted) {
  Json numbers = Json::array(), ghosts = Json::array();
  for (const LearntNumber& number : adjusted.numbers) {
    const auto [scale, unit] = shown(number);
    numbers.push_back({{"name", learnt_name(number)},
                       {"first", number.first},
                       {"last", number.last},
                       {"unit", unit},
                       {"change", scale * number.value},
                       {"error", scale * number.error},
                       {"tolerance", scale * number.tolerance},
                       {"determined", number.determined}});
  }
  for (const Ghost& ghost : adjusted.ghosts) ghosts.push_back(ghost_name(ghost));
  return {{"numbers", numbers},
          {"ghosts", ghosts},
          {"rms_before_px", adjusted.rms_before_px},
          {"rms_after_px", adjusted.rms_after_px},
          {"centre_px", Json::array({adjusted.centre_px.x, adjusted.centre_px.y})},
          {"drawings", adjusted.drawings},
          {"warnings", adjusted.warnings}};
}

Result<int> run_adjust(const AdjustCommand& options) {
  const auto known = open_known_lens(options.known);
  if (!known) return tl::unexpected(known.error());
  AdjustOptions fit = options.fit;
  fit.tolerances.tilt_rad = options.tilt_deg * params::kDegree_rad;
  const LongTask task("adjusting", options.known.threads);
  const auto adjusted = adjust_lens(known->photographs, fit, task.context());
  if (!adjusted) return tl::unexpected(adjusted.error());
  if (auto ok = write_learnt_lens(options.known.output, adjusted->lens); !ok) return tl::unexpected(ok.error());
  print_warnings(adjusted->warnings);
  if (options.known.json)
    print_json(adjust_json(*adjusted));
  else
    print(adjust_text(*adjusted));
  return kDone;
}

void add_tolerance(CLI::App& command, const char* flag, double& value, const char* unit, const char* help) {
  command.add_option(flag, value, fmt::format("tolerance of {} (default: {:g})", help, value))
      ->check(CLI::Range(0.0, 10.0))
      ->option_text(unit);
}

}  // namespace

void add_measure_adjust(CLI::App& measure, Action& action) {
  const auto options = std::make_shared<AdjustCommand>();
  CLI::App* command = measure.add_subcommand("adjust", "learn a known lens's tilts, spaces and focus from its ghosts");
  add_known_lens(*command, options->known);
  LensTolerances& of = options->fit.tolerances;
  add_tolerance(*command, "--tilt-tolerance", options->tilt_deg, "DEG", "each element's tilt");
  add_tolerance(*command, "--decentre-tolerance", of.decentre_mm, "MM", "each element's decentre");
  add_tolerance(*command, "--gap-tolerance", of.gap_mm, "MM", "each air space");
  add_tolerance(*command, "--focus-tolerance", of.focus_mm, "MM", "the sensor's distance");
  add_tolerance(*command, "--stop-radius-tolerance", of.stop_radius, "PART", "the stop's radius, relative");
  add_tolerance(*command, "--stop-shift-tolerance", of.stop_position_mm, "MM", "the stop's position");
  add_number(*command, "--max-ghosts", options->fit.max_ghosts, 1, 200, "ghosts to measure, the brightest");
  add_number(*command, "--width", options->fit.max_width, 32, 2000, "pixels that pictures are reduced to");
  add_number(*command, "--iterations", options->fit.max_iterations, 1, 100, "in each of the resolutions");
  command->footer(kAdjustExamples);
  command->callback([options, &action] { action = [options] { return run_adjust(*options); }; });
}

}  // namespace contrejour::cli
