// SPDX-License-Identifier: Apache-2.0
// contrejour bench lenses: the costs of frames of many lens files, compared with the bundled Canon zoom's.
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/bench/lens_frames.h"
#include "cli/bench/lens_report.h"
#include "cli/bench/report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/outputs.h"

namespace contrejour::cli {
namespace {

constexpr const char* kBenchLensesExamples =
    "One light at u,v = 0.7,0.35, at f/8 (a slower lens: its widest) and wide open, 320x180 and 1920x1080 pixels. A\n"
    "first frame is one of a fresh process of this program; warm ones are rendered here, after one that does not\n"
    "count. Times are those of rendering: reading the lens and writing a file are not in them. A ghost's cost is the\n"
    "first frame's time over the number of ghosts, beside canon-70-200 at 135 mm, measured in the same run.\n\n"
    "Examples:\n"
    "  contrejour bench lenses my-lens.toml other.zmx\n"
    "  contrejour bench lenses --list bench/lens_files.txt --folder ~/lenses --json lenses.json";

const BenchedLens kYardstick{"canon-70-200", 135.0};

struct LensesOptions {
  std::vector<std::string> files;
  std::string list, folder, json;
  bool first_frame = false;  // set in a fresh process
  FrameRunning running;
  params::Values values;
};

// The names in a list, one a line; empty lines and lines that begin with # are skipped.
Result<std::vector<std::string>> files_of(const LensesOptions& options) {
  std::vector<std::string> files = options.files;
  if (options.list.empty()) return files;
  std::ifstream list(options.list);
  if (!list) return failure(ErrorCode::Io, "cannot be read", {options.list});
  const std::filesystem::path folder = options.folder.empty() ? std::filesystem::path(options.list).parent_path()
                                                              : std::filesystem::path(options.folder);
  for (std::string line; std::getline(list, line);) {
    if (!line.empty() && line.front() != '#') files.push_back((folder / line).string());
  }
  return files;
}

Result<BenchedFrames> measure_lens(const BenchedLens& lens, const LensesOptions& options) {
  BenchedFrames measured{std::filesystem::path(lens.file).filename().string(), {}};
  for (const FrameCase& frame_case : frame_cases()) {
    const auto cost = frame_cost(lens, frame_case, options.values, options.running);
    if (!cost) return tl::unexpected(cost.error());
    measured.frames.push_back(*cost);
  }
  return measured;
}

Result<LensBench> measure_all(const LensesOptions& options) {
  const auto files = files_of(options);
  if (!files) return tl::unexpected(files.error());
  if (files->empty()) return failure(ErrorCode::InvalidArgument, "no lens to measure; name files, or a --list of them");
  LensBench bench;
  auto yardstick = measure_lens(kYardstick, options);
  if (!yardstick) return tl::unexpected(yardstick.error());
  bench.yardstick = std::move(*yardstick);
  for (const std::string& file : *files) {
    auto measured = measure_lens({file}, options);
    if (measured) {
      bench.lenses.push_back(std::move(*measured));
    } else if (measured.error().code == ErrorCode::Cancelled) {
      return tl::unexpected(measured.error());
    } else {
      bench.refused.push_back(measured.error().to_string());
    }
  }
  return bench;
}

Result<int> run_first_frame(const LensesOptions& options) {
  const auto ms = frame_ms(options.files.front(), options.values, options.running);
  if (!ms) return tl::unexpected(ms.error());
  print(fmt::format("{}\n", *ms));
  return kDone;
}

Result<int> run_lenses(const LensesOptions& options) {
  if (options.first_frame && options.files.size() == 1) return run_first_frame(options);
  Outputs outputs;
  const auto json = outputs.add(options.json);
  if (!json) return tl::unexpected(json.error());
  const auto bench = measure_all(options);
  if (!bench) return tl::unexpected(bench.error());
  if (*json != nullptr) {
    if (const auto ok = (*json)->write(json_text(lens_bench_json(*bench, options.running))); !ok)
      return tl::unexpected(ok.error());
    if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  }
  print(machine_text());
  print(options.running.processor_time ? "processor time of all threads\n" : "time by the clock\n");
  print(lens_bench_text(*bench));
  return bench->refused.empty() ? kDone : kFailed;
}

}  // namespace

void add_bench_lenses(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<LensesOptions>();
  CLI::App* command = bench.add_subcommand("lenses", "many lens files: first and warm frames, and a ghost's cost");
  command->add_option("LENS", options->files, "lens files or names")->option_text("...");
  command->add_option("--list", options->list, "a file that names lens files, one a line")->option_text("FILE");
  command->add_option("--folder", options->folder, "where the files of the list are (default: beside the list)")
      ->option_text("FOLDER");
  add_output(*command, "--json", options->json, {".json"}, "write all figures to this file");
  command->add_option("--runs", options->running.runs, "of so many frames of milliseconds the fastest counts")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_flag("--warm-only", options->running.warm_only, "start no fresh processes");
  command->add_flag("--processor-time", options->running.processor_time,
                    "times of all threads together instead of the clock's, for a machine that has other work");
  add_parameters(*command, options->values, {"wavelengths", "ghosts", "error", "threads"});
  // Only fresh processes are started with this option, so that the help omits it.
  command->add_flag("--first-frame", options->first_frame)->group("");
  add_parameters(*command, options->values, {"focal", "fnumber", "size"});
  for (const char* hidden : {"--focal", "--fnumber", "--size"}) command->get_option(hidden)->group("");
  command->footer(kBenchLensesExamples);
  command->callback([options, &action] { action = [options] { return run_lenses(*options); }; });
}

}  // namespace contrejour::cli
