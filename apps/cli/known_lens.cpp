// SPDX-License-Identifier: Apache-2.0
#include "cli/known_lens.h"

#include <CLI/CLI.hpp>

#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {

void add_known_lens(CLI::App& command, KnownLensOptions& options) {
  add_lens_argument(command, options.lens);
  command.add_option("FOLDER", options.folder, "the folder of merged stations")->required()->option_text(" ");
  add_output(command, "-o,--output", options.output, {".toml"}, "the lens with what was learnt")->required();
  add_lens_parameters(command, options.values);
  command.add_option("--source-size", options.source_size_deg, "the light's diameter in degrees (default: 0.5)")
      ->check(CLI::Range(0.0, 20.0))
      ->option_text("DEG");
  command
      .add_option(
          "--pixel", options.pixel_um,
          "a merged pixel's side in micrometres, two of the sensor's (default: pictures span the lens's sensor)")
      ->check(CLI::Range(0.1, 1000.0))
      ->option_text("UM");
  add_number(command, "--threads", options.threads, 0, 1024, "threads; 0: one for each core");
  command.add_flag("--json", options.json, "print JSON");
}

Result<KnownLens> open_known_lens(const KnownLensOptions& options) {
  KnownLens known;
  auto lens = prescription_of(options.lens);
  if (!lens) return tl::unexpected(lens.error());
  const auto settings = params::lens_settings(options.values);
  if (!settings) return tl::unexpected(settings.error());
  const auto state = params::lens_of(*lens, options.values);
  if (!state) return tl::unexpected(state.error());
  print_warnings(state->warnings);
  lens->sensor_width_mm = state->sensor_width_mm;  // of --sensor
  lens->sensor_height_mm = state->sensor_height_mm;
  auto merged = open_merged(options.folder);
  if (!merged) return tl::unexpected(merged.error());
  const auto geometry = geometry_of(*merged, options.folder);
  if (!geometry) return tl::unexpected(geometry.error());
  print_warnings(merged->warnings);
  known.merged = std::move(*merged);
  known.photographs.lens = std::move(*lens);
  known.photographs.settings = *settings;
  known.photographs.sweep = known.merged.sweep();
  known.photographs.geometry = *geometry;
  known.photographs.source_radius_rad = 0.5 * options.source_size_deg * params::kDegree_rad;
  known.photographs.pixel_pitch_mm = 1e-3 * options.pixel_um;
  return known;
}

Result<void> write_learnt_lens(const std::string& file, const Prescription& lens) {
  Outputs outputs;
  const auto output = outputs.add(file);
  if (!output) return tl::unexpected(output.error());
  if (auto ok = (*output)->write(write_lens_toml(lens)); !ok) return ok;
  return outputs.commit();
}

}  // namespace contrejour::cli
