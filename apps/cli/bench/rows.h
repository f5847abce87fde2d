// Measurements of `bench tables`: what is asked for, and what came out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/bench/paper_figures.h"
#include "contrejour/render.h"

namespace contrejour::cli {

// A measurement wanted of every system.
struct BenchRequest {
  int lights = 1;
  std::string method;
  TiledOptions tiled{};  // of no meaning for other methods
};
[[nodiscard]] bool same(const BenchRequest& a, const BenchRequest& b);

struct BenchRow {
  const PaperSystem* system = nullptr;
  BenchRequest request;
  RenderSettings settings;
  RenderStatistics statistics;  // of the fastest run
  int runs = 1;
  // Against the pictures of these, where they were made; infinite when equal.
  std::optional<double> reference_db, bundle_db, unmerged_db;

  [[nodiscard]] const PaperFigures& paper() const {
    return system->by_lights[static_cast<std::size_t>(request.lights) - 1];
  }
  // Sum over the named phases.
  [[nodiscard]] double phase_ms(std::initializer_list<std::string_view> phases) const;
};

class BenchRows {
 public:
  void add(BenchRow row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] const std::vector<BenchRow>& all() const { return rows_; }

  // The row of a system for a request that was measured; it must exist.
  [[nodiscard]] const BenchRow& at(const PaperSystem& system, const BenchRequest& request) const;

  // Systems measured, in the paper's order.
  [[nodiscard]] std::vector<const PaperSystem*> systems() const;

 private:
  std::vector<BenchRow> rows_;
};

}  // namespace contrejour::cli
