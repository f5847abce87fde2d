// SPDX-License-Identifier: Apache-2.0
// Renders and compares bodonyi2023's systems with one light or two, or variants of them.
#pragma once

#include <string>
#include <vector>

#include "cli/bench/rows.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct BenchScene {
  const PaperSystem* system = nullptr;
  SceneVariant variant;
  LensState lens;
  std::vector<Light> lights;
  FrameSettings settings;
  params::Values values;   // methods' options are read from these
  std::string coating{};  // as requested; empty: the lens's own
};

// The first two lights are where the paper's are; further lights are spread over the frame, always at the same
// positions.
[[nodiscard]] Result<BenchScene> bench_scene(const PaperSystem& system, int light_count, const SceneVariant& variant,
                                             const params::Values& values);

// The ghosts that the paper counts: all on one side of the stop, except those that reflect at the last surface
// (docs/physics/tiled.md).
[[nodiscard]] SelectList papers_ghosts(const BenchScene& scene);

struct BenchRunning {
  int runs = 1, threads = 0;
  bool paper_ghosts = false;  // papers_ghosts() only
  bool reference = false;     // also compare the paper's scenes with the reference renderer
  std::string cache;       // folder of the reference's pictures; may be empty
};

// The picture of `reference`, from the cache's folder if it has it, else drawn and kept there.
[[nodiscard]] Result<Image> reference_picture(const BenchScene& scene, const BenchRunning& running);

// Adds a row for each request that belongs to this scene. Rows are compared with the pictures of bundle and of unmerged
// tiles if these are among the requests.
[[nodiscard]] Result<void> measure_scene(const BenchScene& scene, const std::vector<BenchRequest>& requests,
                                         const BenchRunning& running, BenchRows& rows);

// Measures those rows again that took milliseconds, except requests to be run once: slow periods of a machine last
// longer than such a row.
[[nodiscard]] Result<void> measure_again(const BenchScene& scene, const std::vector<BenchRequest>& requests,
                                         const BenchRunning& running, BenchRows& rows);

}  // namespace contrejour::cli
