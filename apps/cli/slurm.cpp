// SPDX-License-Identifier: Apache-2.0
#include "cli/slurm.h"

#include <filesystem>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "cli/child_process.h"
#include "contrejour/expert/output_file.h"

namespace contrejour::cli {
namespace {

// The text within double quotes of an #SBATCH line. A % that is not one of sbatch's own must be doubled (sbatch,
// "filename pattern").
std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') result += '\\';
    if (letter == '%') result += '%';
    result += letter;
  }
  return result;
}

std::string header(std::size_t tasks, const SlurmSettings& settings) {
  std::string text = "#!/bin/sh\n";
  const auto add = [&](const std::string& option) { text += fmt::format("#SBATCH {}\n", option); };
  add(fmt::format("--job-name=\"{}\"", escaped(settings.name)));
  const std::string limit = settings.at_once > 0 ? fmt::format("%{}", settings.at_once) : std::string();
  add(fmt::format("--array=0-{}{}", tasks - 1, limit));
  add(fmt::format("--output=\"{}/%A-%a.txt\"", escaped(settings.logs)));
  add("--open-mode=append");
  add("--requeue");
  if (settings.cpus > 0) add(fmt::format("--cpus-per-task={}", settings.cpus));
  for (const std::string& option : settings.options) add(option);
  return text;
}

}  // namespace

std::string slurm_script(const FarmShot& shot, const std::vector<std::string>& chunks, const std::string& folder,
                         const SlurmSettings& settings) {
  std::string text = header(chunks.size(), settings);
  text += fmt::format("cd {} || exit 1\n", shell_quoted(folder));
  text += "case \"$SLURM_ARRAY_TASK_ID\" in\n";
  for (std::size_t k = 0; k < chunks.size(); ++k) text += fmt::format("{}) frames={} ;;\n", k, shell_quoted(chunks[k]));
  text += "*) exit 1 ;;\nesac\n";
  text += fmt::format("exec {}", shot.command_line("\"$frames\""));
  // A task uses the processors that it was given, not all that its machine has.
  if (!shot.has_threads()) text += " --threads=\"${SLURM_CPUS_PER_TASK:-$SLURM_CPUS_ON_NODE}\"";
  return text + "\n";
}

Result<std::string> submit_slurm(const std::string& script, const SlurmSettings& settings) {
  std::error_code error;
  std::filesystem::create_directories(settings.logs, error);
  if (error) return failure(ErrorCode::Io, "the folder of the logs cannot be created", {settings.logs});
  const std::string file = (std::filesystem::path(settings.logs) / "job.sh").string();
  auto output = OutputFile::create(file);
  if (!output) return tl::unexpected(output.error());
  if (auto ok = output->write(script); !ok) return tl::unexpected(ok.error());
  if (auto ok = output->commit(); !ok) return tl::unexpected(ok.error());
  const auto submitted = run_child("sbatch", {"--parsable", file});
  if (!submitted) return tl::unexpected(submitted.error());
  // "number" or "number;cluster"
  std::string job = submitted->text.substr(0, submitted->text.find_first_of(";\n"));
  if (submitted->exit_code != 0 || job.empty())
    return failure(ErrorCode::Io, "sbatch did not take the job; its message is above", {file});
  return job;
}

Result<SlurmTasks> slurm_tasks(const std::string& job) {
  // The list of all of the user's tasks is asked for, because a job that has ended is unknown to the controller, which
  // looks like an error.
  const auto listed = run_child("squeue", {"--noheader", "--array", "--me", "--format=%F %T"}, ChildErrors::Hidden);
  if (!listed) return tl::unexpected(listed.error());
  if (listed->exit_code != 0) return failure(ErrorCode::Io, "Slurm's controller does not answer squeue");
  SlurmTasks tasks;
  std::istringstream lines(listed->text);
  for (std::string number, state; lines >> number >> state;) {
    if (number == job) ++(state == "PENDING" ? tasks.waiting : tasks.running);
  }
  return tasks;
}

}  // namespace contrejour::cli
