// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <Eigen/LU>

#include "contrejour/expert/learn_lens.h"
#include "measure/prescription/channel_coating.h"
#include "measure/prescription/ghost_energies.h"
#include "measure/prescription/nonnegative.h"
#include "measure/prescription/open_surfaces.h"
#include "measure/prescription/reflectance_fit.h"

namespace contrejour {
namespace {

constexpr int kBands = 16;             // of the spectrum, for means over channels
constexpr double kUnsettled = 0.25;    // of a logarithm, in the last round
constexpr double kSettled = 0.01;      // of a logarithm, between two rounds
constexpr int kNeutralRounds = 2;
constexpr double kAlike = 0.95;        // correlation of two energies
constexpr double kLeastError = 0.02;   // of an energy, relative: what drawing and the light's flux leave uncertain
constexpr double kLeastReflectance = 1e-5;
constexpr double kKnownCentre_px = 0.1;  // an error of the optical centre that does no harm
constexpr int kCentreWidth = 160, kCentreGhosts = 10, kCentreIterations = 4;  // with which it is found
constexpr std::array<const char*, 3> kChannels{"red", "green", "blue"};

// The inputs that stay the same in all rounds.
struct CoatingTask {
  const LensPhotographs& photographs;
  const CoatingFitOptions& options;
  LensStations stations;
  std::vector<Ghost> ghosts;
  std::vector<GhostSurfaces> unknowns_of;  // of each ghost
  std::vector<int> surfaces;               // 1-based, of each unknown
  std::vector<SpectralBand> bands;
};

// The state of one channel after a round.
struct ChannelFit {
  NonnegativeSolution energies;
  ReflectanceFit fit;
};
using RoundFit = std::array<ChannelFit, 3>;

// Logarithms of each surface, for the three channels.
using Logarithms = std::array<Eigen::VectorXd, 3>;

bool is_coatable(const SurfaceState& surface) {
  return surface.kind == SurfaceKind::Refracting && is_air(surface.before) != is_air(surface.after);
}

Result<CoatingTask> prepare(const LensPhotographs& photographs, const CoatingFitOptions& options,
                            const Context& context) {
  const auto lens = configure_lens(photographs.lens, photographs.settings);
  if (!lens) return tl::unexpected(lens.error());
  auto stations = lens_stations(photographs, *lens, options.max_width, context);
  if (!stations) return tl::unexpected(stations.error());
  auto ghosts = visible_ghosts(*stations, *lens, options.max_ghosts, context);
  if (!ghosts) return tl::unexpected(ghosts.error());
  if (ghosts->empty()) return invalid_argument("no ghost of this lens reaches the pictures");
  CoatingTask task{photographs, options, in_acescg(std::move(*stations)), std::move(*ghosts), {}, {}, {}};
  task.bands = spectral_bands(kBands, photographs.spectrum, task.stations.space);
  std::vector<int> unknown_of(lens->surfaces.size(), -1);
  for (std::size_t k = 0; k < photographs.lens.surfaces.size(); ++k) {
    if (!is_coatable(lens->surfaces[k])) continue;
    unknown_of[k] = static_cast<int>(task.surfaces.size());
    task.surfaces.push_back(static_cast<int>(k) + 1);
  }
  for (const Ghost& ghost : task.ghosts)
    task.unknowns_of.push_back(
        {{unknown_of[static_cast<std::size_t>(ghost.i - 1)], unknown_of[static_cast<std::size_t>(ghost.j - 1)]}});
  return task;
}

// In units of the residuals' own spread, if that is larger than the noise's.
EnergyEquations scaled(EnergyEquations energies, const Eigen::VectorXd& ratio, double pixels) {
  const double chi2 =
      (energies.yy - 2.0 * energies.b.dot(ratio) + ratio.dot(energies.a * ratio)) / std::max(pixels, 1.0);
  const double scale = 1.0 / std::max(chi2, 1.0);
  energies.a *= scale;
  energies.b *= scale;
  energies.yy *= scale;
  return energies;
}

// The variance of what all stations give, from what they give without each of them (Quenouille 1956, Tukey 1958).
Eigen::VectorXd jackknife_variance(const std::vector<Eigen::VectorXd>& without) {
  const auto count = static_cast<double>(without.size());
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(without.front().size()), variance = mean;
  for (const Eigen::VectorXd& one : without) mean += one / count;
  for (const Eigen::VectorXd& one : without) variance += (one - mean).cwiseAbs2() * (count - 1.0) / count;
  return variance;
}

// The variance of the ratios that a sum over pixels does not know: of errors that are alike in all pixels of a station.
Eigen::VectorXd scatter_of(const SweepEnergies& energies, std::size_t channel) {
  std::vector<Eigen::VectorXd> without;
  for (std::size_t k = 0; k < energies.by_station.size(); ++k) {
    const EnergyEquations of = energies.sum(channel, static_cast<std::ptrdiff_t>(k));
    without.push_back(nonnegative_least_squares(of.a, of.b).x);
  }
  return jackknife_variance(without);
}

// The same equations with more variance in the ratios: A becomes (A^-1 + V)^-1, which exists for a singular A, too.
EnergyEquations widened(const EnergyEquations& of, const Eigen::VectorXd& variance) {
  const Eigen::Index count = of.b.size();
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(Eigen::MatrixXd::Identity(count, count) +
                                                     of.a * variance.asDiagonal());
  EnergyEquations wide{factors.solve(of.a), factors.solve(of.b), of.yy};
  wide.a = (0.5 * (wide.a + wide.a.transpose())).eval();
  return wide;
}

ChannelFit fit_channel(const CoatingTask& task, const SweepEnergies& energies, std::size_t channel,
                       const Eigen::VectorXd& scatter, const Eigen::VectorXd& expected, std::ptrdiff_t without = -1) {
  EnergyEquations of = energies.sum(channel, without);
  const Eigen::VectorXd ratio = nonnegative_least_squares(of.a, of.b).x;
  of = widened(scaled(of, ratio, energies.pixels(channel)), scatter + kLeastError * kLeastError * ratio.cwiseAbs2());
  ChannelFit fit{nonnegative_least_squares(of.a, of.b), {}};
  fit.fit = fit_logarithms(task.unknowns_of, fit.energies.x, fit.energies.error, expected, {});
  return fit;
}

// Standard errors of the reflectances' logarithms by leaving out each station once.
Eigen::VectorXd jackknife_errors(const CoatingTask& task, const SweepEnergies& energies, std::size_t channel,
                                 const Eigen::VectorXd& expected) {
  const Eigen::VectorXd scatter = scatter_of(energies, channel);
  std::vector<Eigen::VectorXd> without;
  for (std::size_t k = 0; k < energies.by_station.size(); ++k)
    without.push_back(fit_channel(task, energies, channel, scatter, expected, static_cast<std::ptrdiff_t>(k)).fit.x);
  return jackknife_variance(without).cwiseSqrt();
}

// Reflectances of the unknowns' surfaces.
std::vector<Rgb> reflectances_of(const CoatingTask& task, const LensState& lens) {
  std::vector<Rgb> all;
  for (const int surface : task.surfaces) {
    Rgb of = channel_reflectance(lens.surfaces[static_cast<std::size_t>(surface - 1)], task.bands);
    for (double& value : of) value = std::max(value, kLeastReflectance);
    all.push_back(of);
  }
  return all;
}

// The same reflectance in all channels.
std::vector<Rgb> without_colour(std::vector<Rgb> reflectances) {
  for (Rgb& of : reflectances) of.fill(std::cbrt(of[0] * of[1] * of[2]));
  return reflectances;
}

Logarithms logarithms_of(const std::vector<Rgb>& reflectances, const std::vector<Rgb>& over) {
  Logarithms all;
  for (std::size_t c = 0; c < 3; ++c) {
    all[c].resize(static_cast<Eigen::Index>(over.size()));
    for (std::size_t k = 0; k < over.size(); ++k)
      all[c][static_cast<Eigen::Index>(k)] = std::log(reflectances[k][c] / over[k][c]);
  }
  return all;
}

// The reflectances that a round gives, from those with which the lens was drawn.
std::vector<Rgb> learnt_reflectances(const RoundFit& round, std::vector<Rgb> drawn) {
  for (std::size_t k = 0; k < drawn.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c)
      drawn[k][c] =
          std::clamp(drawn[k][c] * std::exp(round[c].fit.x[static_cast<Eigen::Index>(k)]), kLeastReflectance, 1.0);
  return drawn;
}

void set_coatings(const CoatingTask& task, const LensState& state, const std::vector<Rgb>& reflectances,
                  Prescription& lens) {
  for (std::size_t k = 0; k < task.surfaces.size(); ++k) {
    const auto at = static_cast<std::size_t>(task.surfaces[k] - 1);
    lens.surfaces[at].coating = channel_coating(state.surfaces[at], reflectances[k], task.bands);
  }
}

double largest(const Logarithms& of) {
  double most = 0.0;
  for (const Eigen::VectorXd& channel : of) most = std::max(most, channel.cwiseAbs().maxCoeff());
  return most;
}

// Errors are not below the last round's change.
void add_surfaces(const CoatingTask& task, const RoundFit& round, const std::vector<Rgb>& reflectances,
                  const Logarithms& jackknife, const Logarithms& change, LearntCoatings& learnt) {
  const ReflectanceOptions options;
  for (std::size_t k = 0; k < task.surfaces.size(); ++k) {
    LearntReflectance of{task.surfaces[k], true, reflectances[k], {}, {}};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto at = static_cast<Eigen::Index>(k);
      of.relative_error[c] = std::max({round[c].fit.error[at], jackknife[c][at], std::abs(change[c][at])});
      of.determined[c] = of.relative_error[c] <= options.most_error;
    }
    learnt.surfaces.push_back(of);
  }
  learnt.unknowns = static_cast<int>(task.surfaces.size());
  for (std::size_t c = 0; c < 3; ++c) learnt.rank[c] = round[c].fit.rank;
}

// expected: of the lens as it is written, over that which was drawn.
void add_ghosts(const CoatingTask& task, const RoundFit& round, const Logarithms& expected, LearntCoatings& learnt) {
  for (std::size_t g = 0; g < task.ghosts.size(); ++g) {
    GhostEnergy energy{task.ghosts[g], {}, {}};
    for (std::size_t c = 0; c < 3; ++c) {
      double written = 0.0;
      for (const int unknown : task.unknowns_of[g].unknown) written += unknown >= 0 ? expected[c][unknown] : 0.0;
      const auto at = static_cast<Eigen::Index>(g);
      energy.ratio[c] = std::exp(-written) * round[c].energies.x[at];
      energy.error[c] = std::exp(-written) * round[c].energies.error[at];
    }
    learnt.ghosts.push_back(energy);
    for (std::size_t h = 0; h < g; ++h) {
      const double both = round[1].energies.correlation(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(h));
      if (std::abs(both) > kAlike) learnt.alike.emplace_back(task.ghosts[h], task.ghosts[g]);
    }
  }
}

void add_warnings(const CoatingTask& task, const RoundFit& round, LearntCoatings& learnt) {
  std::vector<std::pair<std::string, std::string>> texts;  // and the channels that they hold for
  for (std::size_t c = 0; c < 3; ++c) {
    for (const std::string& text : open_surface_texts(round[c].fit.open, task.surfaces)) {
      const auto known = std::ranges::find(texts, text, &std::pair<std::string, std::string>::first);
      if (known == texts.end())
        texts.emplace_back(text, kChannels[c]);
      else
        known->second += fmt::format(", {}", kChannels[c]);
    }
  }
  for (const auto& [text, channels] : texts) learnt.warnings.push_back(fmt::format("{} ({})", text, channels));
}

// The photographs with the optical centre where ghosts have it. The light's images alone leave it uncertain by pixels
// along their path, and a ghost that is drawn beside its place gives its light to others.
Result<LensPhotographs> with_centre_by_ghosts(const LensPhotographs& photographs, const CoatingFitOptions& options,
                                              const Context& context) {
  if (length(photographs.geometry.centre_error_px) < kKnownCentre_px) return photographs;
  AdjustOptions centre_only;
  centre_only.tolerances = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  centre_only.max_width = std::min(options.max_width, kCentreWidth);
  centre_only.max_ghosts = std::min(options.max_ghosts, kCentreGhosts);
  centre_only.max_iterations = kCentreIterations;
  const auto adjusted = adjust_lens(photographs, centre_only, context);
  if (!adjusted) return tl::unexpected(adjusted.error());
  LensPhotographs centred = photographs;
  centred.geometry.centre_px = adjusted->centre_px;
  return centred;
}

// If the last round still changed reflectances by much more than their standard errors, they are not those of the lens.
void warn_if_unsettled(const CoatingTask& task, const Logarithms& last_change, LearntCoatings& learnt) {
  double most = 0.0;
  std::string names;
  for (std::size_t k = 0; k < task.surfaces.size(); ++k) {
    double change = 0.0;
    for (const Eigen::VectorXd& channel : last_change)
      change = std::max(change, std::abs(channel[static_cast<Eigen::Index>(k)]));
    most = std::max(most, change);
    if (change > kUnsettled) names += fmt::format("{}{}", names.empty() ? "" : ", ", task.surfaces[k]);
  }
  if (names.empty()) return;
  learnt.warnings.push_back(fmt::format(
      "after round {} the reflectances of surfaces {} still change by up to a factor of {:.2f}, so they are not to be "
      "trusted: the drawn ghosts do not describe the pictures",
      learnt.rounds, names, std::exp(most)));
}

// A round: the ghosts drawn with these reflectances, and what the pictures say of them.
struct Round {
  SweepEnergies energies;
  Logarithms expected;  // of the lens as it is written, over those that are drawn
  RoundFit fit;
};

Result<Round> one_round(const CoatingTask& task, const LensState& lens, Logarithms expected, const Context& context) {
  auto energies = sweep_energies({&task.stations, lens, task.ghosts, task.options.model_error}, context);
  if (!energies) return tl::unexpected(energies.error());
  Round round{std::move(*energies), std::move(expected), {}};
  for (std::size_t c = 0; c < 3; ++c)
    round.fit[c] = fit_channel(task, round.energies, c, scatter_of(round.energies, c), round.expected[c]);
  return round;
}

void finish(const CoatingTask& task, const Round& round, const std::vector<Rgb>& reflectances, const Logarithms& change,
            LearntCoatings& learnt) {
  Logarithms jackknife;
  for (std::size_t c = 0; c < 3; ++c) jackknife[c] = jackknife_errors(task, round.energies, c, round.expected[c]);
  add_surfaces(task, round.fit, reflectances, jackknife, change, learnt);
  add_ghosts(task, round.fit, round.expected, learnt);
  add_warnings(task, round.fit, learnt);
  warn_if_unsettled(task, change, learnt);
}

}  // namespace

Result<LearntCoatings> learn_coatings(const LensPhotographs& photographs, const CoatingFitOptions& options,
                                      const Context& context) {
  if (options.max_ghosts < 1 || options.max_rounds < 1 || !(options.model_error >= 0.0))
    return invalid_argument("ghosts and rounds must be 1 or more, the error of the model 0 or more");
  const auto centred = with_centre_by_ghosts(photographs, options, context);
  if (!centred) return tl::unexpected(centred.error());
  const auto task = prepare(*centred, options, context);
  if (!task) return tl::unexpected(task.error());
  auto lens = configure_lens(photographs.lens, photographs.settings);
  if (!lens) return tl::unexpected(lens.error());
  const std::vector<Rgb> written = reflectances_of(*task, *lens);
  LensSettings settings = photographs.settings;
  settings.coating.reset();  // those that are learnt count
  settings.coating_at.clear();
  LearntCoatings learnt;
  learnt.lens = photographs.lens;
  std::vector<Rgb> reflectances = written;
  while (true) {
    // A coating that is far from the lens's makes a channel's picture of a ghost from the ends of its band, at other
    // places than the ghost's, and what is learnt from it does not come near. The first rounds have no colours.
    const std::vector<Rgb> drawn = learnt.rounds < kNeutralRounds ? without_colour(reflectances) : reflectances;
    set_coatings(*task, *lens, drawn, learnt.lens);
    lens = configure_lens(learnt.lens, settings);
    if (!lens) return tl::unexpected(lens.error());
    const auto round = one_round(*task, *lens, logarithms_of(written, drawn), context);
    if (!round) return tl::unexpected(round.error());
    const std::vector<Rgb> before = std::exchange(reflectances, learnt_reflectances(round->fit, drawn));
    const Logarithms change = logarithms_of(reflectances, before);
    ++learnt.rounds;
    if (learnt.rounds == options.max_rounds || (learnt.rounds > kNeutralRounds && largest(change) < kSettled)) {
      set_coatings(*task, *lens, reflectances, learnt.lens);
      finish(*task, *round, reflectances, change, learnt);
      return learnt;
    }
  }
}

}  // namespace contrejour
