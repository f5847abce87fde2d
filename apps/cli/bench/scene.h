// bodonyi2023's systems with one light or two, or varied, rendered and compared.
#pragma once

#include <string>
#include <vector>

#include "cli/bench/rows.h"
#include "contrejour/image.h"
#include "contrejour/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct BenchScene {
  const PaperSystem* system = nullptr;
  SceneVariant variant;
  LensState lens;
  std::vector<Light> lights;
  FrameSettings settings;
  params::Values values;   // that methods' options are read from
  std::string coating{};  // as it was asked for; none: the lens's own
};

// The first two lights are where the paper's are; more are spread over the frame, always in the same places.
[[nodiscard]] Result<BenchScene> bench_scene(const PaperSystem& system, int light_count, const SceneVariant& variant,
                                             const params::Values& values);

// Those that the paper counts: all of one side of the stop, but none that reflects at the last surface
// (docs/physics/tiled.md).
[[nodiscard]] SelectList papers_ghosts(const BenchScene& scene);

struct BenchRunning {
  int runs = 1, threads = 0;
  bool paper_ghosts = false;  // papers_ghosts() alone
  bool reference = false;     // compare the paper's scenes with the reference renderer
  std::string cache;       // where its pictures are kept; may be empty
};

// A row for each request that is of this scene. Bundle's and the unmerged picture are compared with
// where they are among the requests.
[[nodiscard]] Result<void> measure_scene(const BenchScene& scene, const std::vector<BenchRequest>& requests,
                                         const BenchRunning& running, BenchRows& rows);

// Its rows that took milliseconds once more, but those that are to run once: a machine's bad moments last longer than
// they do.
[[nodiscard]] Result<void> measure_again(const BenchScene& scene, const std::vector<BenchRequest>& requests,
                                         const BenchRunning& running, BenchRows& rows);

}  // namespace contrejour::cli
