// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/traced_figures.h"

#include <cmath>

#include "base/tasks.h"

namespace contrejour::inline internal {
namespace {

constexpr double kFigures_nm = 550.0;  // where channels together are brightest
constexpr double kCentreStep_px = 0.5;
// The square of an even box's side, with the same variance as a disc, over that of the disc's diameter.
constexpr double kBoxOfDisc = 12.0 / 16.0;

GhostFigure figure_of(const GhostMeter& meter, const Ghost& ghost, const LightSource& light, const Frame& frame) {
  const GhostMeasure measure = meter.measure(ghost, light);
  GhostFigure figure;
  figure.is_there = measure.flux_mm2 > 0.0;
  figure.middle_px = frame.pixel_from_sensor(measure.centroid_mm);
  figure.size_px = (measure.max_mm - measure.min_mm) * (1.0 / frame.pixel_pitch_mm);
  return figure;
}

// Returns how much the light's size and the pixels add to the square of a ghost's side in pictures. Rays of a point of
// light have neither, and ghosts near focus are smaller than both. The light's image in a ghost is its own image times
// the ghost's speed, which the outermost station where the ghost is says best.
std::vector<double> added_px2(const LensStations& stations, Vec2 centre_px, const SweepFigures& figures,
                              std::size_t ghosts) {
  std::vector<double> added(ghosts, 1.0);
  for (std::size_t g = 0; g < ghosts; ++g) {
    double farthest_px = 0.0, speed = 0.0;
    for (std::size_t k = 0; k < stations.pictures.lights_px.size(); ++k) {
      const GhostFigure& figure = figures[k * ghosts + g];
      const double distance_px = length(stations.pictures.lights_px[k] - centre_px);
      if (!figure.is_there || !(distance_px > farthest_px)) continue;
      farthest_px = distance_px;
      speed = length(figure.middle_px - centre_px) / distance_px;
    }
    const double diameter_px = 2.0 * stations.source_radius_px * speed;
    added[g] += kBoxOfDisc * diameter_px * diameter_px;
  }
  return added;
}

// The relative change of a side in pictures, of which the square is that of the rays and what is added to it.
double relative_change(double up_px, double down_px, double step, double added) {
  const double size = 0.5 * (up_px + down_px), by_step = (up_px - down_px) / (2.0 * step);
  return kBoxOfDisc * size * by_step / (kBoxOfDisc * size * size + added);
}

void set_column(const SweepFigures& up, const SweepFigures& down, double step, const std::vector<double>& added,
                Eigen::Index column, std::vector<Eigen::MatrixXd>& by_station) {
  const std::size_t ghosts = added.size();
  for (std::size_t k = 0; k < up.size(); ++k) {
    if (!up[k].is_there || !down[k].is_there) continue;
    Eigen::MatrixXd& matrix = by_station[k / ghosts];
    const Eigen::Index row = kFigures * static_cast<Eigen::Index>(k % ghosts);
    const Vec2 moved = (up[k].middle_px - down[k].middle_px) * (0.5 / step);
    matrix(row, column) = moved.x;
    matrix(row + 1, column) = moved.y;
    matrix(row + 2, column) = relative_change(up[k].size_px.x, down[k].size_px.x, step, added[k % ghosts]);
    matrix(row + 3, column) = relative_change(up[k].size_px.y, down[k].size_px.y, step, added[k % ghosts]);
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
  const auto lens_now = lens_of(lens, unknowns);
  if (!lens_now) return tl::unexpected(lens_now.error());
  const Vec2 centre_px = centre_of(stations, unknowns);
  const auto now = traced_figures(stations, *lens_now, centre_px, ghosts, context);
  if (!now) return tl::unexpected(now.error());
  const std::vector<double> added = added_px2(stations, centre_px, *now, ghosts.size());
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
    set_column(sides[0], sides[1], step, added, n, by_station);
  }
  return by_station;
}

}  // namespace contrejour::inline internal
