// SPDX-License-Identifier: Apache-2.0
// Jobs of the Slurm workload manager (22.05 and later): an array of tasks, of which each renders a chunk of frames.
// Source: https://slurm.schedmd.com/sbatch.html, squeue.html and job_array.html
#pragma once

#include <string>
#include <vector>

#include "cli/farm_shot.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct SlurmSettings {
  std::string name = "contrejour";    // of the job
  std::string logs = "farm-logs";     // the folder of the job's script and of what its tasks print
  int cpus = 0;                       // of a task; 0: as the cluster decides
  int at_once = 0;                    // tasks that run at the same time at most; 0: as the cluster decides
  std::vector<std::string> options;   // further ones of sbatch, e.g. --partition=night
};

// The job's script: a task of the array for each chunk. A task whose machine fails is queued again.
[[nodiscard]] std::string slurm_script(const FarmShot& shot, const std::vector<std::string>& chunks,
                                       const std::string& folder, const SlurmSettings& settings);

// Writes the script into the folder of logs, and submits it. Returns the job's number. Errors: Io (sbatch's own message
// is on the standard error by then).
[[nodiscard]] Result<std::string> submit_slurm(const std::string& script, const SlurmSettings& settings);

struct SlurmTasks {
  int running = 0, waiting = 0;
};

// The tasks of a job that have not ended. Errors: Io if the controller does not answer.
[[nodiscard]] Result<SlurmTasks> slurm_tasks(const std::string& job);

}  // namespace contrejour::cli
