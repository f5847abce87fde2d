// SPDX-License-Identifier: Apache-2.0
#include "measure/prescription/ghost_energies.h"

#include <algorithm>

#include "base/tasks.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kSurveyed = 7;  // stations that rank ghosts

Context on_one_thread(const Context& context) { return {1, context.cancel, {}}; }

Result<StationMatrix> energies_at(const DrawnSweep& drawn, std::size_t k, const Context& context) {
  const LensStations& stations = *drawn.stations;
  const FitStation& station = stations.pictures.stations[k];
  const Frame frame = frame_of(stations, stations.centre_px);
  const auto patches =
      ghost_patches(drawn.lens, light_of(stations, k, drawn.lens, frame), frame, drawn.ghosts, context);
  if (!patches) return tl::unexpected(patches.error());
  const HaloColumns halo(stations.pictures.lights_px[k], masked_px(stations), frame.width, frame.height);
  WeightSettings settings;
  settings.model_error = drawn.model_error;
  const Image weights = station_weights(station, *patches, halo, settings);
  StationMatrix all = station_matrix(station, weights, *patches, halo);
  for (ChannelMatrix& channel : all) channel = eliminated(channel, static_cast<Eigen::Index>(drawn.ghosts.size()));
  return all;
}

}  // namespace

EnergyEquations SweepEnergies::sum(std::size_t channel, std::ptrdiff_t without) const {
  EnergyEquations sum;
  const Eigen::Index count = by_station.front()[channel].b.size();
  sum.a.setZero(count, count);
  sum.b.setZero(count);
  for (std::size_t k = 0; k < by_station.size(); ++k) {
    if (static_cast<std::ptrdiff_t>(k) == without) continue;
    sum.a += by_station[k][channel].a;
    sum.b += by_station[k][channel].b;
    sum.yy += by_station[k][channel].yy;
  }
  return sum;
}

double SweepEnergies::pixels(std::size_t channel) const {
  double sum = 0.0;
  for (const StationMatrix& station : by_station) sum += station[channel].pixels;
  return sum;
}

Result<SweepEnergies> sweep_energies(const DrawnSweep& drawn, const Context& context) {
  SweepEnergies energies;
  std::optional<Error> error;
  const Context one = on_one_thread(context);
  const bool done = ordered_pipeline(
      drawn.stations->pictures.stations.size(), context, [&](std::size_t k) { return energies_at(drawn, k, one); },
      [&](std::size_t, Result<StationMatrix>& matrix) {
        if (!matrix && !error) error = matrix.error();
        if (matrix) energies.by_station.push_back(std::move(*matrix));
      });
  if (error) return tl::unexpected(*error);
  if (!done) return interrupted();
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
