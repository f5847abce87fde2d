// SPDX-License-Identifier: Apache-2.0
// hullin2011's figures 15, 17 and 19 and its coarse grids (7.1), measured with `bundle`, the paper's method.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/console.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct HullinRow {
  std::string figure;  // "15"
  std::string lens;    // the bundled lens
  double f_number = 0;
  std::string what;  // what is rendered: "high quality"
  int ghosts = 0;    // number of rendered ghosts
  double ms = 0;
  std::optional<double> psnr_db = std::nullopt;  // against the picture that the note names
  double paper_ms = 0;                           // 0: unknown
  std::string note{};
};

struct HullinRunning {
  int runs = 1, threads = 0;
  // Is called for every picture of a figure, with a name for it: "17-nikon-80-200-high-quality".
  std::function<Result<void>(const std::string& name, const Image& image)> show;
};

// One lens of a figure.
struct HullinSystem {
  std::string_view lens;
  double focal_length_mm = 0;  // 0: a prime
};

struct HullinFigure {
  std::string_view key;    // "15"
  std::string_view title;
  std::span<const HullinSystem> systems;
  // Measures the rows of one of its systems.
  Result<std::vector<HullinRow>> (*measure)(const HullinSystem& system, const params::Values& values,
                                            const HullinRunning& running);
};
[[nodiscard]] std::span<const HullinFigure> hullin_figures();

[[nodiscard]] std::string hullin_text(const HullinFigure& figure, const std::vector<HullinRow>& rows);
[[nodiscard]] Json hullin_json(const std::vector<HullinRow>& rows);

}  // namespace contrejour::cli
