// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/edge_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kStep = 1.0 / 24.0;  // in units of the finest edge
constexpr double kFadeFrom = 0.7;     // of the distance to where the light is uniform: no step must be visible there

double fade(double fraction) {
  const double t = std::clamp((1.0 - fraction) / (1.0 - kFadeFrom), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// The factors of a table by channel. The first is 0, the last 1.
std::vector<Channels> factors_of(const stop_patterns::BandStopPattern& band, const EdgeTable& table, double width) {
  std::vector<Channels> factors(table.count, Channels{});
  for (std::size_t k = 1; k + 1 < factors.size(); ++k) {
    const double distance = table.dark_beyond - static_cast<double>(k) / table.per_step;
    for (const stop_patterns::BandStopPattern::Part& part : band.parts) {
      const double exact = part.pattern->edges()->edge(distance, width);
      const double faded = distance > 0.0 ? exact * fade(distance / table.dark_beyond)
                                          : 1.0 + (exact - 1.0) * fade(-distance / table.level_within);
      for (std::size_t c = 0; c < 3; ++c) factors[k][c] += part.channel[c] * static_cast<float>(faded);
    }
  }
  factors.back().fill(1.0F);
  return factors;
}

}  // namespace

std::uint32_t add_edge_table(const stop_patterns::BandStopPattern& band, double width, PolygonList& list) {
  const IrisShape& iris = band.edges->iris();
  if (list.bounds.empty()) list.bounds = iris.bounds();
  EdgeTable table;
  table.is_monochrome = band.is_monochrome();
  table.of_outline = iris.is_picture();
  table.dark_beyond = band.dark_beyond + 0.5 * width;
  table.level_within = band.level_within + 0.5 * width;
  table.per_step = 1.0 / (kStep * band.fringe_unit);
  table.count = static_cast<std::uint32_t>((table.dark_beyond + table.level_within) * table.per_step) + 2;
  table.first = static_cast<std::uint32_t>(table.is_monochrome ? list.edge_steps.size() : list.edge_factors.size());
  const std::vector<Channels> factors = factors_of(band, table, width);
  if (table.is_monochrome) {
    for (std::size_t k = 0; k < factors.size(); ++k)
      list.edge_steps.push_back({factors[k][0], k + 1 < factors.size() ? factors[k + 1][0] - factors[k][0] : 0.0F});
  } else {
    list.edge_factors.insert(list.edge_factors.end(), factors.begin(), factors.end());
  }
  list.edge_tables.push_back(table);
  return static_cast<std::uint32_t>(list.edge_tables.size() - 1);
}

}  // namespace contrejour::inline internal::adaptive
