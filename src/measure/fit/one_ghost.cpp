// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/one_ghost.h"

#include <algorithm>

#include "measure/fit/ghost_start.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kStationsOfOneFit = 10;  // to which a ghost is fitted alone
constexpr double kSeenMargin = 1.1;

}  // namespace

std::vector<FitStation> few_stations(const std::vector<FitStation>& stations, double last) {
  std::vector<FitStation> seen;
  for (const FitStation& station : stations) {
    if (station.s <= last) seen.push_back(station);
  }
  std::vector<FitStation> few;
  const std::size_t step = (seen.size() + kStationsOfOneFit - 1) / kStationsOfOneFit;
  for (std::size_t k = 0; k < seen.size(); k += std::max<std::size_t>(step, 1)) few.push_back(seen[k]);
  return few;
}

std::optional<MeasuredGhost> fitted_alone(FlareFit& fit, const std::vector<FitStation>& all_residuals,
                                          const FoundGhost& found) {
  std::vector<FitStation> residuals = sampled_stations(few_stations(all_residuals, kSeenMargin * found.last), 2);
  MeasuredFlare alone = fit.flare_of({start_of_ghost(found, residuals, fit.flare().s_max)});
  const FlareProblem empty(residuals, fit.flare_of({}));
  const double before = empty.cost(Eigen::VectorXd(0));
  LevelFit best = optimised(fit, residuals, alone, {kNoHuber, kAloneIterations});
  if (fit.result.found.empty() && fit.small.empty()) {  // the first ghost says where the optical centre is
    best = optimised(fit, residuals, best.flare, {kFarHuber, kAloneIterations, true});
    move_all(fit, best.centre_shift);
    for (FitStation& station : residuals) move_centre(station, best.centre_shift);
  }
  for (const double huber : {kFarHuber, fit.options.huber})
    best = optimised(fit, residuals, best.flare, {huber, kAloneIterations});
  const auto unknowns = static_cast<double>(ParameterLayout(best.flare).size());
  if (fit.context.cancelled() || before - best.cost < kLeastGain * unknowns) return std::nullopt;
  return best.flare.ghosts[0];
}

}  // namespace contrejour::inline internal
