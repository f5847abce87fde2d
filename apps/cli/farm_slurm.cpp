// SPDX-License-Identifier: Apache-2.0
// contrejour farm slurm: a sequence as an array job of Slurm.
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/farm_shot.h"
#include "cli/interrupt.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/slurm.h"
#include "contrejour/expert/frame_range.h"

namespace contrejour::cli {
namespace {

constexpr int kMaxSilentPolls = 30;  // of a controller that is being restarted

struct FarmSlurmOptions {
  FarmOptions farm;
  SlurmSettings slurm;
  bool submit = false, wait = false, json = false;
  int attempts = 3, poll_s = 5;
};

// The outcome, for the report.
struct FarmRun {
  std::size_t frames = 0;  // that were left at the start
  std::vector<std::string> jobs;
  std::vector<int> failed;  // after the last attempt
};

// Returns false if the user interrupted.
bool sleep_for(int seconds) {
  for (int tenth = 0; tenth < 10 * seconds; ++tenth) {
    if (interrupt_flag().load()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return !interrupt_flag().load();
}

// Waits until no task of the job is left.
Result<void> wait_for_job(const std::string& job, const FarmShot& shot, std::size_t frame_count,
                          const FarmSlurmOptions& options) {
  const LongTask bar("rendering", 0);
  for (int silent = 0; silent < kMaxSilentPolls;) {
    if (!sleep_for(options.poll_s)) {
      print_warnings({fmt::format("job {} goes on; `scancel {}` ends it", job, job)});
      return failure(ErrorCode::Cancelled, "interrupted");
    }
    const auto tasks = slurm_tasks(job);
    if (!tasks) {
      if (++silent == kMaxSilentPolls) return tl::unexpected(tasks.error());
      continue;
    }
    silent = 0;
    if (tasks->running + tasks->waiting == 0) return {};
    if (!bar.context().progress) continue;
    // Ctrl-C ends the listing command as well; the bar then keeps its position.
    if (const auto left = shot.frames_left(); left)
      bar.context().progress(1.0 - static_cast<double>(left->size()) / static_cast<double>(frame_count));
  }
  return {};
}

// Submits what is left, until nothing is, or for all attempts.
Result<FarmRun> run_on_farm(const FarmShot& shot, std::vector<int> left, const std::string& folder,
                            const FarmSlurmOptions& options) {
  FarmRun run{left.size(), {}, {}};
  for (int attempt = 0; attempt < options.attempts && !left.empty(); ++attempt) {
    if (attempt > 0) print_warnings({fmt::format("frames {} are submitted again", frame_range_text(left))});
    const auto job = submit_slurm(slurm_script(shot, shot.chunks_of(left), folder, options.slurm), options.slurm);
    if (!job) return tl::unexpected(job.error());
    run.jobs.push_back(*job);
    if (!options.wait) return run;
    if (auto ok = wait_for_job(*job, shot, run.frames, options); !ok) return tl::unexpected(ok.error());
    auto again = shot.frames_left();
    if (!again) return tl::unexpected(again.error());
    left = std::move(*again);
  }
  run.failed = std::move(left);
  return run;
}

void report(const FarmRun& run, const FarmSlurmOptions& options) {
  if (options.json) {
    print_json({{"frames", run.frames},
                {"jobs", run.jobs},
                {"failed", run.failed.empty() ? std::string() : frame_range_text(run.failed)}});
    return;
  }
  if (run.jobs.empty()) return print_summary("all frames are done\n");
  if (!options.wait) return print_summary(fmt::format("{} frames submitted as job {}\n", run.frames, run.jobs.back()));
  print_summary(fmt::format("{} of {} frames rendered\n", run.frames - run.failed.size(), run.frames));
}

Result<int> run_farm_slurm(FarmSlurmOptions options) {
  const auto shot = FarmShot::create(options.farm);
  if (!shot) return tl::unexpected(shot.error());
  const std::string folder = std::filesystem::current_path().string();
  auto left = shot->frames_left();
  if (!left) return tl::unexpected(left.error());
  if (!options.submit && !options.wait) {
    if (left->empty()) print_warnings({"all frames are done; there is nothing to submit"});
    if (!left->empty()) print(slurm_script(*shot, shot->chunks_of(*left), folder, options.slurm));
    return kDone;
  }
  const auto run = run_on_farm(*shot, std::move(*left), folder, options);
  if (!run) return tl::unexpected(run.error());
  report(*run, options);
  if (run->failed.empty()) return kDone;
  print_error(fmt::format("frames {} failed; the logs of their tasks are in {}", frame_range_text(run->failed),
                          options.slurm.logs));
  return kFailed;
}

void add_slurm_options(CLI::App& command, SlurmSettings& slurm) {
  command.add_option("--name", slurm.name, "name of the job (default: contrejour)")->option_text("NAME");
  command.add_option("--logs", slurm.logs, "folder for the job's script and what its tasks print (default: farm-logs)")
      ->option_text("FOLDER");
  add_number(command, "--cpus", slurm.cpus, 0, 4096, "processors of a task (0: as the cluster decides)");
  add_number(command, "--at-once", slurm.at_once, 0, 1000000,
             "tasks that run at the same time at most (0: any number)");
  command
      .add_option("--sbatch", slurm.options,
                  "a further option of sbatch, e.g. --sbatch=--partition=night; may be repeated")
      ->option_text("OPTION")
      ->expected(1)
      ->take_all();
}

}  // namespace

void add_farm_slurm(CLI::App& farm, Action& action) {
  const auto options = std::make_shared<FarmSlurmOptions>();
  CLI::App* command = farm.add_subcommand("slurm", "an array job of Slurm: print its script, or submit it");
  add_farm_options(*command, options->farm);
  command->add_flag("--submit", options->submit, "submit the job, instead of printing its script");
  command->add_flag("--wait", options->wait,
                    "submit, show the progress, submit frames that failed again, and end when the job does");
  add_number(*command, "--attempts", options->attempts, 1, 100, "with --wait: how often a frame is submitted at most");
  add_number(*command, "--poll", options->poll_s, 1, 3600, "with --wait: seconds between two looks at the queue");
  add_slurm_options(*command, options->slurm);
  command->add_flag("--json", options->json, "print the report as JSON");
  command->footer(
      "Frames that are done are left out, so the same command continues a shot. A task whose machine fails is queued\n"
      "again by Slurm. --wait may be interrupted; the job goes on.\n\n"
      "Examples:\n"
      "  contrejour farm slurm --chunk 10 -- apply heliar plate.####.exr -o out.####.exr --frames 1001-1240\n"
      "  contrejour farm slurm --wait --cpus 8 --sbatch=--partition=night -- apply heliar plate.####.exr -o "
      "out.####.exr");
  command->callback([options, &action] { action = [options] { return run_farm_slurm(*options); }; });
}

}  // namespace contrejour::cli
