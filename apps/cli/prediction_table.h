// SPDX-License-Identifier: Apache-2.0
// Figures of flares as columns of a table: text, CSV, JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "contrejour/expert/flare_prediction.h"

namespace contrejour::cli {

// One rated case: a light, a view of a panorama, a frame.
struct PredictionRow {
  std::string subject;
  std::size_t lights = 0;
  LightFigures figures;
  std::optional<SceneFigures> scene;
  std::optional<Rating> rating;
};

// Rates each row's estimator among `others`.
void rate_rows(std::vector<PredictionRow>& rows, Estimator estimator, const std::vector<double>& others);

[[nodiscard]] std::string rows_csv(const std::vector<PredictionRow>& rows);
[[nodiscard]] std::string rows_text(const std::vector<PredictionRow>& rows);
[[nodiscard]] Json rows_json(const std::vector<PredictionRow>& rows);

// One row for each position of a map, rated among them.
[[nodiscard]] std::string map_csv(const LightMap& map, Estimator estimator);

}  // namespace contrejour::cli
