// SPDX-License-Identifier: Apache-2.0
// Requests and results of `bench tables`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/bench/paper_figures.h"
#include "contrejour/render.h"

namespace contrejour::cli {

// The differences of a scene from the paper's.
struct SceneVariant {
  bool full_aperture = false;
  int wavelengths = 0;  // 0: the user's number
  int scale = 1;        // factor on the frame's width and height
  friend bool operator==(const SceneVariant&, const SceneVariant&) = default;
};

// A measurement that is requested of every system.
struct BenchRequest {
  int lights = 1;
  std::string method;
  TiledOptions tiled{};  // unused by other methods; the grid is the user's
  SceneVariant variant{};
};
[[nodiscard]] bool same(const BenchRequest& a, const BenchRequest& b);

struct BenchRow {
  const PaperSystem* system = nullptr;
  BenchRequest request;
  double f_number = 0;
  MethodOptions options;
  FrameSettings settings;
  RenderStatistics statistics;  // of the fastest run
  int runs = 1;
  // PSNR against the pictures of these methods, if they were made; infinite when equal.
  std::optional<double> reference_db, bundle_db, unmerged_db;

  // Null if the scene is not one of the paper's.
  [[nodiscard]] const PaperFigures* paper_if_any() const {
    const auto lights = static_cast<std::size_t>(request.lights);
    return request.variant == SceneVariant{} && lights <= system->by_lights.size() ? &system->by_lights[lights - 1]
                                                                                   : nullptr;
  }
  [[nodiscard]] const PaperFigures& paper() const { return *paper_if_any(); }
  // Sum over the named phases.
  [[nodiscard]] double phase_ms(std::initializer_list<std::string_view> phases) const;
};

// Measurements of a system and this machine apart from pictures: bench/probe.h.
struct BenchProbe {
  const PaperSystem* system = nullptr;
  double prepare_ms = 0;
  double peak_hits_per_ms = 0;
  double frame_pass_ms = 0;
  std::uint64_t peak_memory_bytes = 0;  // 0: not measured
};

class BenchRows {
 public:
  void add(BenchRow row) { rows_.push_back(std::move(row)); }
  void add(const BenchProbe& probe) { probes_.push_back(probe); }
  // Adds a repeated measurement of an existing row; the faster of the two counts.
  void add_again(const BenchRow& row);
  [[nodiscard]] const std::vector<BenchRow>& all() const { return rows_; }

  // The row of a system for a request that was measured, and the system's probe; they must exist.
  [[nodiscard]] const BenchRow& at(const PaperSystem& system, const BenchRequest& request) const;
  [[nodiscard]] const BenchProbe& probe_of(const PaperSystem& system) const;

  // Systems measured, in the paper's order.
  [[nodiscard]] std::vector<const PaperSystem*> systems() const;

 private:
  std::vector<BenchRow> rows_;
  std::vector<BenchProbe> probes_;
};

}  // namespace contrejour::cli
