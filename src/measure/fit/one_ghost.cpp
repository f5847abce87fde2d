// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/one_ghost.h"

#include <algorithm>
#include <array>
#include <utility>

#include "measure/fit/ghost_start.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kStationsOfOneFit = 10;  // to which a ghost is fitted alone
constexpr double kSeenMargin = 1.1;
constexpr double kLeastGainAlone = 4.0;  // of the cost for each unknown: a window has fewer pixels than a picture
// The ring about a disc that says what its surroundings are, and ends what it is fitted to: parts of the radius,
// pixels.
constexpr double kRingFrom = 1.04, kRingFrom_px = 1.0, kRingTo = 1.25, kRingTo_px = 3.0;
constexpr std::size_t kFewestInRing = 12;

// A station's pixels in and about a disc, without the middle level of the ring around it: light of ghosts that are
// still unknown is then not taken for the disc's. Stations that show too little of the ring get no weight.
FitStation disc_window(FitStation station, const FoundGhost& found) {
  const TangentFrame& frame = station.frame.pixels;
  const Vec2 along{station.frame.to_light.x, -station.frame.to_light.y};
  const double s2 = station.s * station.s, scale = frame.focal_length_px;
  const Vec2 middle = frame.centre_px + along * (station.s * (found.speed + found.bend * s2) * scale);
  const double radius = std::max(found.radius * (1.0 + found.growth * s2), 0.0) * scale;
  const double from = kRingFrom * radius + kRingFrom_px, to = kRingTo * radius + kRingTo_px;
  std::array<std::vector<float>, 3> around;
  const auto distance = [&](int x, int y) { return length(Vec2{x + 0.5, y + 0.5} - middle); };
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const double r = distance(x, y);
      for (int c = 0; c < 3; ++c) {
        if (r > to) station.weight.at(x, y, c) = 0.0F;
        if (r > from && station.weight.at(x, y, c) > 0.0F)
          around[static_cast<std::size_t>(c)].push_back(station.rate.at(x, y, c));
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& values = around[static_cast<std::size_t>(c)];
    const bool known = values.size() >= kFewestInRing;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    if (known) std::nth_element(values.begin(), at, values.end());
    for (std::size_t k = static_cast<std::size_t>(c); k < station.rate.pixels.size(); k += 3) {
      if (known) station.rate.pixels[k] -= *at;
      if (!known) station.weight.pixels[k] = 0.0F;
    }
  }
  return station;
}

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
  std::vector<FitStation> residuals =
      sampled_stations(few_stations(all_residuals, kSeenMargin * found.last), fit.sampling(2));
  for (FitStation& station : residuals) station = disc_window(std::move(station), found);
  MeasuredFlare alone = fit.flare_of({start_of_ghost(found, residuals, fit.flare().s_max)});
  const FlareProblem empty(residuals, fit.flare_of({}));
  const double before = empty.cost(Eigen::VectorXd(0));
  LevelSettings near{kNoHuber, kAloneIterations};
  near.near_start = true;
  LevelFit best = optimised(fit, residuals, alone, near);
  if (fit.result.found.empty() && fit.small.empty()) {  // the first ghost says where the optical centre is
    near.with_centre = true;
    best = optimised(fit, residuals, best.flare, near);
    near.with_centre = false;
    move_all(fit, best.centre_shift);
    for (FitStation& station : residuals) move_centre(station, best.centre_shift);
  }
  for (const double huber : {kFarHuber, fit.options.huber}) {
    near.huber = huber;
    best = optimised(fit, residuals, best.flare, near);
  }
  const auto unknowns = static_cast<double>(ParameterLayout(best.flare).size());
  if (fit.context.cancelled() || before - best.cost < kLeastGainAlone * unknowns) return std::nullopt;
  return best.flare.ghosts[0];
}

}  // namespace contrejour::inline internal
