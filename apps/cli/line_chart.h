// SPDX-License-Identifier: Apache-2.0
// A chart (SVG) of curves over one axis. Thread-safety: pure functions.
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::cli {

struct ChartCurve {
  std::string name;  // in the legend; empty: not listed
  std::vector<Vec2> points;
  bool marks = false;  // circles in place of a line
};

struct LineChart {
  std::string title, x_label, y_label;
  std::vector<ChartCurve> curves;  // points that are not finite are left out, on a logarithmic axis those below 0, too
  bool log_x = false, log_y = false;
};

// Without any point, an empty pair of axes.
[[nodiscard]] std::string line_chart(const LineChart& chart);

}  // namespace contrejour::cli
