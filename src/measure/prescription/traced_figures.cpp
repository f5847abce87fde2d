// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/traced_figures.h"

#include <cmath>

#include "base/tasks.h"

namespace contrejour::inline internal {
namespace {

constexpr double kFigures_nm = 550.0;  // where channels together are brightest
constexpr double kCentreStep_px = 0.5;
constexpr double kLeastSize_px = 0.5;  // of a ghost whose size counts

GhostFigure figure_of(const GhostMeter& meter, const Ghost& ghost, const LightSource& light, const Frame& frame) {
  const GhostMeasure measure = meter.measure(ghost, light);
  GhostFigure figure;
  figure.is_there = measure.flux_mm2 > 0.0;
  figure.middle_px = frame.pixel_from_sensor(measure.centroid_mm);
  figure.size_px = (measure.max_mm - measure.min_mm) * (1.0 / frame.pixel_pitch_mm);
  return figure;
}

void set_column(const SweepFigures& up, const SweepFigures& down, double step, std::size_t ghosts, Eigen::Index column,
                std::vector<Eigen::MatrixXd>& by_station) {
  for (std::size_t k = 0; k < up.size(); ++k) {
    if (!up[k].is_there || !down[k].is_there) continue;
    Eigen::MatrixXd& matrix = by_station[k / ghosts];
    const Eigen::Index row = kFigures * static_cast<Eigen::Index>(k % ghosts);
    const Vec2 moved = (up[k].middle_px - down[k].middle_px) * (0.5 / step);
    matrix(row, column) = moved.x;
    matrix(row + 1, column) = moved.y;
    const Vec2 size = (up[k].size_px + down[k].size_px) * 0.5, grown = up[k].size_px - down[k].size_px;
    if (size.x > kLeastSize_px) matrix(row + 2, column) = grown.x / (2.0 * step * size.x);
    if (size.y > kLeastSize_px) matrix(row + 3, column) = grown.y / (2.0 * step * size.y);
  }
}

}  // namespace

Vec2 centre_of(const LensStations& stations, const Eigen::VectorXd& unknowns) {
  return stations.centre_px + Vec2{unknowns[unknowns.size() - 2], unknowns[unknowns.size() - 1]};
}

Result<LensState> lens_of(const AdjustableLens& lens, const Eigen::VectorXd& unknowns) {
  return lens.state(unknowns.head(unknowns.size() - 2));
}

Result<SweepFigures> traced_figures(const LensStations& stations, const LensState& lens, Vec2 centre_px,
                                    const std::vector<Ghost>& ghosts, const Context& context) {
  const GhostMeter meter(lens, kFigures_nm);
  const Frame frame = frame_of(stations, centre_px);
  const std::size_t count = stations.pictures.stations.size();
  SweepFigures figures(count * ghosts.size());
  const bool done = parallel_for(count, {context.threads, context.cancel, {}}, [&](std::size_t k) {
    const LightSource light = light_of(stations, k, lens, frame).source();
    for (std::size_t g = 0; g < ghosts.size(); ++g)
      figures[k * ghosts.size() + g] = figure_of(meter, ghosts[g], light, frame);
  });
  if (!done) return interrupted();
  return figures;
}

Result<std::vector<Eigen::MatrixXd>> figure_derivatives(const LensStations& stations, const AdjustableLens& lens,
                                                        const Eigen::VectorXd& unknowns,
                                                        const std::vector<Ghost>& ghosts, const Context& context) {
  const auto rows = kFigures * static_cast<Eigen::Index>(ghosts.size());
  std::vector<Eigen::MatrixXd> by_station(stations.pictures.stations.size(),
                                          Eigen::MatrixXd::Zero(rows, unknowns.size()));
  for (Eigen::Index n = 0; n < unknowns.size(); ++n) {
    const bool is_centre = n >= unknowns.size() - 2;
    const double step = is_centre ? kCentreStep_px : difference_step(lens.numbers[static_cast<std::size_t>(n)]);
    std::array<SweepFigures, 2> sides;
    for (std::size_t side = 0; side < 2; ++side) {
      Eigen::VectorXd at = unknowns;
      at[n] += side == 0 ? step : -step;
      const auto state = lens_of(lens, at);
      if (!state) return tl::unexpected(state.error());
      auto figures = traced_figures(stations, *state, centre_of(stations, at), ghosts, context);
      if (!figures) return tl::unexpected(figures.error());
      sides[side] = std::move(*figures);
    }
    set_column(sides[0], sides[1], step, ghosts.size(), n, by_station);
  }
  return by_station;
}

}  // namespace contrejour::inline internal
