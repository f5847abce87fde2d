// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/fit_comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "measure/fit/amplitudes.h"
#include "measure/fit/ghost_start.h"
#include "measure/fit/halo.h"
#include "measure/fit/stations.h"
#include "measure/fit/walch_fit.h"

namespace contrejour {
namespace {

constexpr double kComparedHalo = 0.35;   // the quantile that is taken for the halo
constexpr double kQuadratic = 1e9;       // Huber's loss far beyond any residual: the paper's cost has none
constexpr int kComparedDegrees = 3;      // the fewest coefficients, then one and two more
constexpr double kComparedDecrease = 1e-4;

// The stations to one side of the axis, neighbours of one another, about the middle of the range: the descent goes from
// neighbour to neighbour, and needs small steps between them.
std::vector<std::size_t> neighbours(const FlareSweep& sweep, const SweepGeometry& geometry, int most) {
  std::vector<std::pair<double, std::size_t>> aside;
  double largest = 0.0;
  for (const double angle : sweep.angles_rad) largest = std::max(largest, angle - geometry.zero_rad);
  for (std::size_t k = 0; k < sweep.angles_rad.size(); ++k) {
    const double angle = sweep.angles_rad[k] - geometry.zero_rad;
    if (angle > 0.0) aside.emplace_back(std::abs(angle - 0.5 * largest), k);
  }
  std::ranges::sort(aside);
  aside.resize(std::min(aside.size(), static_cast<std::size_t>(most)));
  std::vector<std::size_t> chosen;
  for (const auto& [off, k] : aside) chosen.push_back(k);
  std::ranges::sort(chosen);
  return chosen;
}

FlareSweep part_of(const FlareSweep& sweep, const std::vector<std::size_t>& chosen) {
  FlareSweep part;
  part.light = sweep.light;
  for (const std::size_t k : chosen) {
    part.angles_rad.push_back(sweep.angles_rad[k]);
    if (!sweep.direct.empty()) part.direct.push_back(sweep.direct[k]);
  }
  part.picture = [&sweep, chosen](std::size_t k) { return sweep.picture(chosen[k]); };
  return part;
}

// One weight for all pixels, as the paper's mean of squares has: that of a usual pixel.
void make_uniform(std::vector<FitStation>& stations) {
  std::vector<float> weights;
  for (const FitStation& station : stations)
    for (const float w : station.weight.pixels)
      if (w > 0.0F) weights.push_back(w);
  if (weights.empty()) return;
  const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2);
  std::ranges::nth_element(weights, middle);
  for (FitStation& station : stations)
    for (float& w : station.weight.pixels)
      if (w > 0.0F) w = *middle;
}

MeasuredFlare start_of(std::span<const FoundGhost> found, const std::vector<FitStation>& stations) {
  MeasuredFlare flare;
  for (const FitStation& station : stations) flare.s_max = std::max(flare.s_max, station.s);
  for (const FoundGhost& ghost : found) flare.ghosts.push_back(start_of_ghost(ghost, stations, flare.s_max));
  return flare;
}

WalchCost costs_of(const MeasuredFlare& flare, const FitStation& station) {
  return walch_costs(grey_picture(station), grey_model(grey_ghosts(flare, station.s), station),
                     WalchSettings{}.smoothing_px);
}

CostProgress mean_of(const std::vector<WalchCost>& costs, double evaluations) {
  CostProgress mean{evaluations, 0.0, 0.0, 0.0};
  for (const WalchCost& cost : costs) {
    mean.mse += cost.mse / static_cast<double>(costs.size());
    mean.edges += cost.edges / static_cast<double>(costs.size());
  }
  mean.cost = WalchSettings{}.mse_weight * mean.mse + WalchSettings{}.edge_weight * mean.edges;
  return mean;
}

std::vector<WalchCost> all_costs(const MeasuredFlare& flare, const std::vector<FitStation>& stations) {
  std::vector<WalchCost> costs;
  for (const FitStation& station : stations) costs.push_back(costs_of(flare, station));
  return costs;
}

// The levels that the pictures say, for the outlines as they are: ghosts that overlap were each given all of the light
// that is there. The descent changes levels one by one.
MeasuredFlare with_shared_light(const std::vector<FitStation>& stations, const MeasuredFlare& flare,
                                const Context& context) {
  AmplitudeSettings settings;
  settings.profile_coefficients = 0;
  settings.huber = kQuadratic;
  MeasuredFlare shared = with_best_amplitudes(stations, flare, settings, context);
  return check_flare(shared) ? shared : flare;
}

// The joint fit, with the paper's cost wherever it has a new estimate. That cost's own pictures are not counted.
std::vector<CostProgress> our_progress(const std::vector<FitStation>& stations, MeasuredFlare flare,
                                       const ComparisonSettings& settings, const Context& context) {
  std::vector<CostProgress> progress{mean_of(all_costs(flare, stations), 0.0)};
  double evaluations = 0.0;
  for (int degree = 0; degree < kComparedDegrees; ++degree) {
    for (MeasuredGhost& ghost : flare.ghosts) ghost = with_degree(ghost, degree);
    flare = with_shared_light(stations, flare, context);
    evaluations += AmplitudeSettings{}.rounds * static_cast<double>(stations.size());
    FlareProblem problem(stations, flare);
    problem.huber = kQuadratic;
    problem.context = context;
    const auto counted = [&] { evaluations += static_cast<double>(stations.size()); };
    const LeastSquaresProblem squares{
        [&](const Eigen::VectorXd& p) {
          counted();
          progress.push_back(mean_of(all_costs(problem.layout.unpack(flare, p), stations), evaluations));
          return problem.equations(p);
        },
        [&](const Eigen::VectorXd& p) {
          counted();
          return problem.cost(p);
        },
        problem.layout.lower(), problem.layout.upper()};
    const LeastSquaresResult best =
        least_squares(squares, problem.layout.pack(flare), {settings.our_iterations, kComparedDecrease});
    flare = problem.layout.unpack(flare, best.parameters);
    progress.push_back(mean_of(all_costs(flare, stations), evaluations));
  }
  return progress;
}

std::vector<CostProgress> walch_progress(const std::vector<FitStation>& stations, const MeasuredFlare& start,
                                         const ComparisonSettings& settings, const Context& context) {
  WalchSettings walch;
  walch.iterations = settings.walch_iterations;
  std::vector<WalchCost> costs = all_costs(start, stations);
  std::vector<CostProgress> progress{mean_of(costs, 0.0)};
  for (const WalchStep& step : walch_fit(stations, start, walch, context).steps) {
    costs[step.station] = step.cost;
    progress.push_back(mean_of(costs, step.image_evaluations));
  }
  return progress;
}

}  // namespace

Result<FitComparison> compare_with_walch(const FlareSweep& sweep, const SweepGeometry& geometry,
                                         std::span<const FoundGhost> start, Vec2 centre_px,
                                         const ComparisonSettings& settings, const Context& context) {
  if (start.empty() || settings.max_stations < 5)
    return invalid_argument("a comparison needs a ghost to start from, and five stations");
  SweepGeometry moved = geometry;
  moved.centre_px = centre_px;
  FlareFitOptions options;
  options.max_width = settings.max_width;
  Context quiet = context;
  quiet.progress = nullptr;
  auto reduced =
      reduced_stations(part_of(sweep, neighbours(sweep, geometry, settings.max_stations)), moved, options, quiet);
  if (!reduced) return tl::unexpected(reduced.error());
  const HaloProfile halo = halo_of(reduced->stations, reduced->lights_px, {reduced->masked_px, kComparedHalo});
  std::vector<FitStation> stations = stations_without(*reduced, halo, options.model_error);
  make_uniform(stations);
  const MeasuredFlare flare = start_of(start.first(std::min(start.size(), settings.max_ghosts)), stations);
  FitComparison comparison{our_progress(stations, flare, settings, quiet),
                           walch_progress(stations, flare, settings, quiet), std::nullopt};
  if (context.cancelled()) return interrupted();
  for (const CostProgress& p : comparison.ours) {
    if (p.cost > comparison.walch.back().cost) continue;
    comparison.ours_to_walch_cost = p.image_evaluations;
    break;
  }
  return comparison;
}

}  // namespace contrejour
