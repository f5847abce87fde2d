// SPDX-License-Identifier: Apache-2.0
// Sparse polynomials with few terms that zones of the field share, as in the code of Bodonyi, Csoba and Kunkli 2025.
// Differs: each zone is solved by QR, not by normal equations, and coefficients have no bounds (the study of that code
// found that its bounds raise coefficients below 1e-6 of entrance points in mm).
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "base/tasks.h"
#include "polynomial/published/seeded_random.h"
#include "polynomial/published/stopwatch.h"
#include "polynomial/published/zone_errors.h"

namespace contrejour::inline internal::polynomial {
namespace {

using published::Exponents;
using published::ZoneOptions;

struct ZoneSearch {
  const ZoneErrors& errors;
  const ZoneOptions& options;
  const Context& context;
  Stopwatch watch;
  std::vector<Exponents> terms;
  double error = std::numeric_limits<double>::infinity();
  std::vector<published::CurvePoint> curve;

  void record(int step, double at, double best) { curve.push_back({step, watch.seconds(), at, best}); }
};

bool holds(const std::vector<Exponents>& terms, const Exponents& term) {
  return std::ranges::find(terms, term) != terms.end();
}

// The terms that differ from a chosen one by at most `gap` in one exponent, and pure powers up to `gap`.
std::vector<Exponents> candidates(const ZoneSearch& search, int gap) {
  std::vector<Exponents> found;
  const auto add = [&](Exponents term, std::size_t axis, int exponent) {
    if (exponent < 0 || exponent > search.options.largest_exponent) return;
    term[axis] = static_cast<std::uint8_t>(exponent);
    if (!holds(search.terms, term) && !holds(found, term)) found.push_back(term);
  };
  for (std::size_t axis = 0; axis < 4; ++axis) {
    for (int step = 1; step <= gap; ++step) {
      add({}, axis, step);
      for (const Exponents& term : search.terms) {
        add(term, axis, term[axis] + step);
        add(term, axis, term[axis] - step);
      }
    }
    for (const Exponents& term : search.terms) add(term, axis, 0);
  }
  return found;
}

struct Change {
  std::size_t place = 0;  // the number of terms: one more
  Exponents term{};
  double error = 0.0;
};

// The best of all candidates at the places from `first` on.
std::optional<Change> best_change(const ZoneSearch& search, int gap, std::size_t first, std::size_t last) {
  std::optional<Change> best;
  const std::vector<Exponents> others = candidates(search, gap);
  for (std::size_t place = first; place <= last; ++place) {
    for (const Exponents& other : others) {
      std::vector<Exponents> terms = search.terms;
      if (place == terms.size())
        terms.push_back(other);
      else
        terms[place] = other;
      const double error = search.errors.error(terms);
      if (error < (best ? best->error : search.error)) best = Change{place, other, error};
    }
  }
  return best;
}

bool search_gaps(ZoneSearch& search) {
  constexpr double kGain = 1.0 - 1e-6;  // a change has to lower the error by more than rounding
  const auto wanted = static_cast<std::size_t>(search.options.terms);
  search.terms = {Exponents{}};
  search.error = search.errors.error(search.terms);
  search.record(1, search.error, search.error);
  for (int gap = 1, step = 2; gap <= search.options.largest_exponent; ++step) {
    if (search.context.cancelled()) return false;
    const bool grows = search.terms.size() < wanted;
    const auto change = grows ? best_change(search, gap, search.terms.size(), search.terms.size())
                              : best_change(search, gap, 0, search.terms.size() - 1);
    if (!change || change->error >= kGain * search.error) {
      ++gap;
      continue;
    }
    if (grows)
      search.terms.push_back(change->term);
    else
      search.terms[change->place] = change->term;
    search.error = change->error;
    search.record(step, search.error, search.error);
  }
  return true;
}

Exponents random_term(SeededRandom& random, int largest) {
  Exponents term;
  for (std::uint8_t& e : term) e = static_cast<std::uint8_t>(random.below(static_cast<std::size_t>(largest) + 1));
  return term;
}

// As sabatschus2022's annealing, with t^4 terms exchanged. The best terms are kept. Errors differ by orders of
// magnitude between outputs, so an increase counts relative to the error.
bool search_annealing(ZoneSearch& search) {
  constexpr double kPower = 4.0, kFactor = 100.0;
  const ZoneOptions& options = search.options;
  SeededRandom random(options.seed);
  std::vector<Exponents> terms{Exponents{}};
  while (static_cast<int>(terms.size()) < options.terms) {
    const Exponents term = random_term(random, options.largest_exponent);
    if (!holds(terms, term)) terms.push_back(term);
  }
  double error = search.errors.error(terms);
  search.terms = terms;
  search.error = error;
  const int stride = std::max(1, options.iterations / 400);
  for (int k = 0; k < options.iterations; ++k) {
    if (search.context.cancelled()) return false;
    const double temperature = static_cast<double>(options.iterations - k) / options.iterations;
    std::vector<Exponents> changed = terms;
    const auto swaps = std::max(1, static_cast<int>(std::pow(temperature, kPower) * options.terms));
    for (int swap = 0; swap < swaps; ++swap) {
      const Exponents term = random_term(random, options.largest_exponent);
      if (!holds(changed, term)) changed[random.below(changed.size())] = term;
    }
    const double next = search.errors.error(changed);
    const double increase = std::isfinite(error) ? next / error - 1.0 : -1.0;
    if (next < error || random.unit() < std::exp(-increase * kFactor / temperature)) {
      terms = std::move(changed);
      error = next;
    }
    if (error < search.error) {
      search.terms = terms;
      search.error = error;
    }
    if (k % stride == 0 || k + 1 == options.iterations) search.record(k + 1, error, search.error);
  }
  return true;
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour::published {
namespace {

Result<void> check_zones(std::span<const ZoneSamples> zones, const ZoneOptions& options) {
  const auto refuse = [](const char* why) { return failure(ErrorCode::InvalidArgument, why); };
  if (options.largest_exponent < 1 || options.largest_exponent > kLargestDegree)
    return refuse("zones take exponents of 1 to 16");
  if (options.terms < 1 || options.terms > 64 || options.iterations < 1)
    return refuse("zones take 1 to 64 terms, and at least one iteration");
  if (std::pow(options.largest_exponent + 1.0, 4.0) < 2.0 * options.terms)
    return refuse("exponents this small do not give twice the requested number of terms");
  if (zones.empty()) return refuse("a fit needs at least one zone");
  for (const ZoneSamples& zone : zones)
    if (zone.inputs.size() != zone.values.size() || zone.values.size() < static_cast<std::size_t>(options.terms))
      return refuse("each zone needs as many samples as terms, and one value for each");
  return {};
}

}  // namespace

Result<ZoneFit> fit_sparse_zones(std::span<const ZoneSamples> zones, const ZoneOptions& options,
                                 const Context& context) {
  if (const auto good = check_zones(zones, options); !good) return tl::unexpected(good.error());
  const polynomial::ZoneErrors errors(zones, options.largest_exponent);
  polynomial::ZoneSearch search{errors, options, context, {}, {}, std::numeric_limits<double>::infinity(), {}};
  const bool done = options.search == ZoneOptions::Search::Gaps ? polynomial::search_gaps(search)
                                                                : polynomial::search_annealing(search);
  if (!done) return interrupted();
  ZoneFit fit;
  fit.seconds = search.watch.seconds();
  fit.terms = search.terms;
  fit.error = search.error;
  fit.curve = std::move(search.curve);
  for (std::size_t k = 0; k < errors.zones(); ++k) {
    const auto fitted = errors.fit(k, fit.terms);
    fit.coefficients.emplace_back(fitted.coefficients.begin(), fitted.coefficients.end());
    fit.zone_errors.push_back(fitted.error);
  }
  return fit;
}

}  // namespace contrejour::published
