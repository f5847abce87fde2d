// SPDX-License-Identifier: Apache-2.0
// A chart (SVG) of a light's positions about the optical axis: green where flare is small, up to red.
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/flare_prediction.h"

namespace contrejour::cli {

struct LightChart {
  std::string title;
  const LightMap* map = nullptr;
  Estimator estimator = Estimator::MeanTransmission;
  double safe = 0.1;             // of the range: up to there a position is safe
  Vec2 half_field;               // of the picture, tangents
  std::vector<Light> lights;     // marked by their numbers
};

[[nodiscard]] std::string light_chart(const LightChart& chart);

}  // namespace contrejour::cli
