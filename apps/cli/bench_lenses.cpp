// SPDX-License-Identifier: Apache-2.0
// contrejour bench lenses: measures frames of many lens files relative to those of the bundled Canon zoom.
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
    "Each lens is rendered with one light at u,v = 0.7,0.35, at f/8 (or the maximum aperture of a slower lens) and\n"
    "at maximum aperture, with 320x180 and 1920x1080 pixels. A first frame is rendered by a new process; warm\n"
    "frames are rendered by this process after one that does not count. Times exclude the reading of the lens and\n"
    "the writing of files. The cost of a ghost is the time of the first frame over the number of ghosts, relative\n"
    "to canon-70-200 at 135 mm in the same run.\n\n"
    "Examples:\n"
    "  contrejour bench lenses my-lens.toml other.zmx\n"
    "  contrejour bench lenses --list bench/lens_files.txt --folder ~/lenses --json lenses.json";

const BenchedLens kBaselineLens{"canon-70-200", 135.0};

struct LensesOptions {
  std::vector<std::string> files;
  std::string list, folder, json;
  bool first_frame = false;  // set in a fresh process
  FrameRunning running;
  params::Values values;
};

// The names in a list, one on each line; empty lines and lines that begin with # are skipped.
Result<std::vector<std::string>> listed_files(const LensesOptions& options) {
  std::vector<std::string> files = options.files;
  if (options.list.empty()) return files;
  std::ifstream list(options.list);
  if (!list) return failure(ErrorCode::Io, "the list cannot be read", {options.list});
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

Result<LensBench> measure_lenses(const LensesOptions& options) {
  const auto files = listed_files(options);
  if (!files) return tl::unexpected(files.error());
  if (files->empty())
    return failure(ErrorCode::InvalidArgument, "there is no lens to measure; give lens files, or a --list of them");
  LensBench bench;
  auto baseline = measure_lens(kBaselineLens, options);
  if (!baseline) return tl::unexpected(baseline.error());
  bench.baseline = std::move(*baseline);
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
  const auto bench = measure_lenses(options);
  if (!bench) return tl::unexpected(bench.error());
  if (*json != nullptr) {
    if (const auto ok = (*json)->write(json_text(lens_bench_json(*bench, options.running))); !ok)
      return tl::unexpected(ok.error());
    if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  }
  print(machine_text());
  print(options.running.processor_time ? "processor time of all threads\n" : "elapsed time\n");
  print(lens_bench_text(*bench));
  return bench->refused.empty() ? kDone : kFailed;
}

}  // namespace

void add_bench_lenses(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<LensesOptions>();
  CLI::App* command =
      bench.add_subcommand("lenses", "measure many lenses: first and warm frames, and the cost of a ghost");
  command->add_option("LENS", options->files, "lens files or names")->option_text("...");
  command->add_option("--list", options->list, "a file that lists lens files, one on each line")->option_text("FILE");
  command->add_option("--folder", options->folder, "the folder of the listed files (default: that of the list)")
      ->option_text("FOLDER");
  add_output(*command, "--json", options->json, {".json"}, "write all figures to this file");
  add_number(*command, "--runs", options->running.runs, 1, 1000,
             "number of frames, of which the fastest counts; frames that take seconds are rendered once");
  command->add_flag("--warm-only", options->running.warm_only, "measure warm frames only, without new processes");
  command->add_flag(
      "--processor-time", options->running.processor_time,
      "measure the processor time of all threads in place of elapsed time, for a machine with other work");
  add_parameters(*command, options->values, {"wavelengths", "ghosts", "error", "threads"});
  // The program gives this option to its new processes only; the help omits it.
  command->add_flag("--first-frame", options->first_frame)->group("");
  add_parameters(*command, options->values, {"focal", "fnumber", "size"});
  for (const char* hidden : {"--focal", "--fnumber", "--size"}) command->get_option(hidden)->group("");
  command->footer(kBenchLensesExamples);
  command->callback([options, &action] { action = [options] { return run_lenses(*options); }; });
}

}  // namespace contrejour::cli
