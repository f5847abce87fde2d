// SPDX-License-Identifier: Apache-2.0
#include "cli/prediction_table.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cli/csv_text.h"
#include "cli/text_table.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

using NamedValue = std::pair<const char*, double>;

std::vector<NamedValue> values_of_figures(const LightFigures& f) {
  return {{"minimum", f.flare.minimum},
          {"maximum", f.flare.maximum},
          {"sum", f.flare.sum},
          {"mean", f.flare.mean},
          {"log_average", f.flare.log_average},
          {"median", f.flare.median},
          {"percentile_99", f.flare.percentile_99},
          {"covered", f.flare.covered},
          {"mean_transmission", f.glare.mean_transmission},
          {"peak_transmission", f.glare.peak_transmission},
          {"mean_attenuation", f.glare.mean_attenuation},
          {"least_attenuation", f.glare.least_attenuation}};
}

std::vector<NamedValue> values_of_scene(const SceneFigures& s) {
  return {{"log_average_ratio", s.log_average_ratio},
          {"brightening", s.brightening},
          {"contrast_without", s.contrast_without},
          {"contrast_with", s.contrast_with},
          {"contrast_kept", s.contrast_kept}};
}

std::vector<NamedValue> values_of_row(const PredictionRow& row) {
  std::vector<NamedValue> values = values_of_figures(row.figures);
  if (row.scene)
    for (const NamedValue& value : values_of_scene(*row.scene)) values.push_back(value);
  if (row.rating) {
    values.emplace_back("rating", row.rating->in_range);
    values.emplace_back("rank", row.rating->rank);
  }
  return values;
}

std::string header_of(const std::vector<NamedValue>& values) {
  std::string line;
  for (const auto& [name, value] : values) line += fmt::format(",{}", name);
  return line + "\n";
}

std::string line_of(const std::vector<NamedValue>& values) {
  std::string line;
  for (const auto& [name, value] : values) line += fmt::format(",{:.6g}", value);
  return line + "\n";
}

}  // namespace

void rate_rows(std::vector<PredictionRow>& rows, Estimator estimator, const std::vector<double>& others) {
  for (PredictionRow& row : rows) {
    const auto rating = rating_of(value_of(row.figures, estimator), others);
    if (rating) row.rating = *rating;
  }
}

std::string rows_csv(const std::vector<PredictionRow>& rows) {
  std::string csv;
  for (const PredictionRow& row : rows) {
    const auto values = values_of_row(row);
    if (csv.empty()) csv = "subject,lights" + header_of(values);
    csv += fmt::format("{},{}{}", csv_text(row.subject), row.lights, line_of(values));
  }
  return csv;
}

std::string rows_text(const std::vector<PredictionRow>& rows) {
  std::vector<std::string> headings{"<figure"};
  for (const PredictionRow& row : rows) headings.push_back(row.subject);
  TextTable table(headings);
  if (rows.empty()) return {};
  const std::size_t lines = values_of_row(rows.front()).size();
  for (std::size_t k = 0; k < lines; ++k) {
    std::vector<std::string> cells{values_of_row(rows.front())[k].first};
    for (const PredictionRow& row : rows) cells.push_back(fmt::format("{:.4g}", values_of_row(row)[k].second));
    table.add(std::move(cells));
  }
  return table.text();
}

Json rows_json(const std::vector<PredictionRow>& rows) {
  Json all = Json::array();
  for (const PredictionRow& row : rows) {
    Json json = {{"subject", row.subject}, {"lights", row.lights}};
    for (const auto& [name, value] : values_of_row(row)) json[name] = std::isfinite(value) ? Json(value) : Json();
    all.push_back(json);
  }
  return all;
}

std::string map_csv(const LightMap& map, Estimator estimator) {
  const std::vector<double> others = values_of(map, estimator);
  std::string csv;
  for (std::size_t k = 0; k < map.points.size(); ++k) {
    const LightMapPoint& point = map.points[k];
    auto values = values_of_figures(point.figures);
    const auto rating = rating_of(others[k], others);
    values.emplace_back("rating", rating->in_range);
    values.emplace_back("rank", rating->rank);
    if (csv.empty()) csv = "angle_deg,direction_deg" + header_of(values);
    csv += fmt::format("{:.6g},{:.6g}{}", point.angle_rad / params::kDegree_rad,
                       point.direction_rad / params::kDegree_rad, line_of(values));
  }
  return csv;
}

}  // namespace contrejour::cli
