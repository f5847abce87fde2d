// bodonyi2023's systems with one light or two, rendered and compared.
#pragma once

#include <string>
#include <vector>

#include "cli/bench/rows.h"
#include "contrejour/image.h"
#include "contrejour/result.h"
#include "params/values.h"

namespace contrejour::cli {

struct BenchScene {
  const PaperSystem* system = nullptr;
  int light_count = 1;
  LensState lens;
  std::vector<Light> lights;
  RenderSettings settings;
};

[[nodiscard]] Result<BenchScene> bench_scene(const PaperSystem& system, int light_count, const params::Values& values);

struct BenchRunning {
  int runs = 1, threads = 0;
  bool reference = false;  // compare with the reference renderer
  std::string cache;       // where its pictures are kept; may be empty
};

// A row for each request that has this scene's number of lights. Bundle's and the unmerged picture are compared with
// where they are among the requests.
[[nodiscard]] Result<void> measure_scene(const BenchScene& scene, const std::vector<BenchRequest>& requests,
                                         const BenchRunning& running, BenchRows& rows);

}  // namespace contrejour::cli
