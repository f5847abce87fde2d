// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/ghost_energies.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/tasks.h"
#include "measure/prescription/nonnegative.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kSurveyed = 7;  // stations that rank ghosts
constexpr double kHaloDeviation = 0.05;  // of a station's halo from that of all, relative
constexpr double kHaloHarmonic = 0.1;    // of a halo that is not round, likewise

Context on_one_thread(const Context& context) { return {1, context.cancel, {}}; }

Result<StationMatrix> energies_at(const DrawnSweep& drawn, std::size_t k, const Context& context) {
  const LensStations& stations = *drawn.stations;
  const FitStation& station = stations.pictures.stations[k];
  const Frame frame = frame_of(stations, stations.centre_px);
  const auto patches = ghost_patches(stations, k, drawn.lens, frame, drawn.ghosts, context);
  if (!patches) return tl::unexpected(patches.error());
  const HaloColumns halo(stations.pictures.lights_px[k], stations.centre_px, masked_px(stations), frame.width,
                         frame.height);
  WeightSettings settings;
  settings.model_error = drawn.model_error;
  const Image weights = station_weights(station, *patches, halo, settings);
  return station_matrix(station, weights, *patches, halo);
}

// Columns of a station's matrix: ghosts, all other ghosts, and the halo's, of which `round` are round.
struct Layout {
  Eigen::Index ghosts = 0, round = 0, columns = 0;
  [[nodiscard]] Eigen::Index halo() const { return ghosts + 1; }
};

Layout layout_of(const ChannelMatrix& matrix, Eigen::Index ghosts) {
  return {ghosts, (matrix.b.size() - ghosts - 2) / 3, matrix.b.size()};
}

// The round halo's levels if it is the same at all stations.
Eigen::VectorXd common_halo(const std::vector<StationMatrix>& stations, std::size_t channel, Eigen::Index ghosts) {
  ChannelMatrix all = stations.front()[channel];
  for (std::size_t k = 1; k < stations.size(); ++k) {
    all.a += stations[k][channel].a;
    all.b += stations[k][channel].b;
  }
  const Layout layout = layout_of(all, ghosts);
  ColumnIndices at;
  append_columns(at, 0, layout.halo() + layout.round);
  at.push_back(layout.columns - 1);
  all = chosen_columns(all, at);
  const ChannelMatrix kept = eliminated(all, ghosts + 1);
  return others_given(all, nonnegative_least_squares(kept.a, kept.b).x).head(layout.round);
}

// Ghosts and common halo, with the station's own deviations from that, and all other ghosts, at their best. The level
// that is the same everywhere is the station's own.
ChannelMatrix with_deviations(const ChannelMatrix& of, const Eigen::VectorXd& halo, Eigen::Index ghosts) {
  const Layout layout = layout_of(of, ghosts);
  ColumnIndices at;
  append_columns(at, 0, ghosts);
  append_columns(at, layout.halo(), layout.round);  // of all stations
  at.push_back(ghosts);                     // all other ghosts
  at.push_back(layout.columns - 1);         // the level that is the same everywhere
  append_columns(at, layout.halo(), 3 * layout.round);
  Eigen::VectorXd prior = Eigen::VectorXd::Zero(3 * layout.round + 2);
  for (Eigen::Index k = 0; k < 3 * layout.round; ++k) {
    const double deviation = k < layout.round ? kHaloDeviation : kHaloHarmonic;
    const double error = deviation * std::abs(halo[k % layout.round]);
    prior[k + 2] = error > 0.0 ? 1.0 / (error * error) : 1e30;
  }
  return eliminated(chosen_columns(of, at), ghosts + layout.round, prior);
}

}  // namespace

EnergyEquations SweepEnergies::sum(std::size_t channel, std::ptrdiff_t without) const {
  ChannelMatrix sum;
  const Eigen::Index count = by_station.front()[channel].b.size();
  sum.a.setZero(count, count);
  sum.b.setZero(count);
  for (std::size_t k = 0; k < by_station.size(); ++k) {
    if (static_cast<std::ptrdiff_t>(k) == without) continue;
    sum.a += by_station[k][channel].a;
    sum.b += by_station[k][channel].b;
    sum.yy += by_station[k][channel].yy;
  }
  const ChannelMatrix kept = eliminated(sum, ghosts);
  return {kept.a, kept.b, kept.yy};
}

double SweepEnergies::pixels(std::size_t channel) const {
  double sum = 0.0;
  for (const StationMatrix& station : by_station) sum += station[channel].pixels;
  return sum;
}

Result<SweepEnergies> sweep_energies(const DrawnSweep& drawn, const Context& context) {
  std::vector<StationMatrix> stations;
  std::optional<Error> error;
  const Context one = on_one_thread(context);
  const bool done = ordered_pipeline(
      drawn.stations->pictures.stations.size(), context, [&](std::size_t k) { return energies_at(drawn, k, one); },
      [&](std::size_t, Result<StationMatrix>& matrix) {
        if (!matrix && !error) error = matrix.error();
        if (matrix) stations.push_back(std::move(*matrix));
      });
  if (error) return tl::unexpected(*error);
  if (!done) return interrupted();
  SweepEnergies energies{std::move(stations), static_cast<Eigen::Index>(drawn.ghosts.size())};
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::VectorXd halo = common_halo(energies.by_station, c, energies.ghosts);
    for (StationMatrix& station : energies.by_station) station[c] = with_deviations(station[c], halo, energies.ghosts);
  }
  return energies;
}

Result<std::vector<Ghost>> visible_ghosts(const LensStations& stations, const LensState& lens, int most,
                                          const Context& context) {
  FrameSettings settings;
  settings.frame = frame_of(stations, stations.centre_px);
  const std::size_t count = stations.pictures.stations.size();
  std::vector<Light> lights;
  for (std::size_t n = 0; n < std::min(kSurveyed, count); ++n)
    lights.push_back(light_of(stations, n * (count - 1) / std::max<std::size_t>(std::min(kSurveyed, count) - 1, 1),
                              lens, settings.frame));
  LayerOptions options;
  options.by = LayersBy::Ghost;
  options.ghost_count = most;
  return brightest_ghosts(lens, lights, settings, options, {context.threads, context.cancel, {}});
}

}  // namespace contrejour::inline internal
