// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/polynomial_fits.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/polynomial_zones.h"
#include "cli/bench/thesis_figures.h"
#include "cli/long_task.h"
#include "contrejour/expert/published_samples.h"

namespace contrejour::cli {
namespace {

using namespace published;

constexpr ElementPair kFirstGhost{0, 1};
constexpr std::uint64_t kUnseenSeed = 7777;
constexpr int kQuickRuns = 3, kRuns = 10, kQuickIterations = 500;

class FitsBench {
 public:
  FitsBench(const PolynomialBenchOptions& options, const Context& context)
      : options_(options), context_(without_progress(context)) {}

  Result<PolynomialFits> measure();

 private:
  [[nodiscard]] bool wanted(std::string_view table) const {
    return options_.tables.empty() || std::ranges::find(options_.tables, table) != options_.tables.end();
  }

  Result<void> measure_dense();
  Result<void> measure_more_dense(const RaySamples& grid, const RaySamples& random, const RaySamples& unseen);
  void add_overview(std::string name, const Polynomial& polynomial, bool along_x);
  void add_orthogonality();
  Result<void> start_sparse();
  Result<void> measure_algorithms();
  Result<void> measure_annealing();
  Result<void> measure_variation();
  Result<void> measure_unfitted();

  Result<Polynomial> add_dense(std::string name, const Samples& samples, const Samples& unseen, Basis basis,
                               std::optional<double> thesis_error, std::string note = {});
  Result<void> add_pursuit(std::string name, const PursuitOptions& pursuit, std::optional<thesis::Figure> figure,
                           std::string note);
  Result<SparseFit> add_annealing(const std::string& table, std::string name, const AnnealingOptions& annealing,
                                  std::optional<thesis::Figure> figure, std::string note = {});

  const PolynomialBenchOptions& options_;
  Context context_;
  PolynomialFits fits_;
  std::optional<DenseFit> dense_;  // that sparse polynomials start from
  Samples unseen_;
};

Result<Polynomial> FitsBench::add_dense(std::string name, const Samples& samples, const Samples& unseen, Basis basis,
                                        std::optional<double> thesis_error, std::string note) {
  const auto fit = DenseFit::fit(samples, thesis::kDegree, basis);
  if (!fit) return tl::unexpected(fit.error());
  fits_.rows.push_back({"dense", std::move(name), static_cast<int>(fit->polynomial().terms.size()),
                        static_cast<int>(samples.values.size()), 0, fit->error(), rms_error(fit->polynomial(), unseen),
                        fit->seconds(), thesis_error, std::nullopt, std::move(note)});
  return fit->polynomial();
}

// Figure 5.6: the error over the ray's direction along x, of the light on the axis.
void FitsBench::add_overview(std::string name, const Polynomial& polynomial, bool along_x) {
  constexpr int kPoints = 200;
  PolynomialCurve curve{"overview", std::move(name), {}, {}};
  for (int k = 0; k <= kPoints; ++k) {
    const double dx = 2.0 * k / kPoints - 1.0;
    const Inputs at{0.0, 0.0, dx, 0.3};  // y is 0 along dy = 0
    const TwoLensesRay ray = trace(TwoLenses{}, kFirstGhost, at);
    const double exact = along_x ? ray.sensor.x : ray.sensor.y;
    if (ray.arrives) curve.line.push_back({0.5 * dx, std::abs(evaluate(polynomial, at) - exact)});
  }
  fits_.curves.push_back(std::move(curve));
}

// Figure 3.3: the sum of how far the products of Legendre polynomials are from 1 and 0, as means over a grid.
void FitsBench::add_orthogonality() {
  PolynomialCurve curve{"orthogonality", "Legendre polynomials up to degree 10", {}, {}};
  for (int points = 16; points <= 4096; points *= 2) {
    double sum = 0.0;
    for (int i = 0; i <= thesis::kDegree; ++i) {
      for (int j = 0; j <= thesis::kDegree; ++j) {
        const Polynomial both{Basis::Legendre,
                              {{{static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j), 0, 0}, 1.0}}};
        double product = 0.0;
        for (int k = 0; k < points; ++k) {
          const double x = (2.0 * k + 1.0) / points - 1.0;
          product += evaluate(both, {x, x, 0.0, 0.0}) / points;
        }
        sum += std::abs(product - (i == j ? 1.0 : 0.0));
      }
    }
    curve.line.push_back({static_cast<double>(points), sum});
  }
  fits_.curves.push_back(std::move(curve));
}

// sabatschus2022 5.3.1, both coordinates, and what its tracer's fault changes.
Result<void> FitsBench::measure_dense() {
  const TwoLenses published;
  const RaySamples grid = grid_samples(published, kFirstGhost, thesis::kGridSide);
  const RaySamples random = random_samples(published, kFirstGhost, thesis::kDenseSamples, options_.seed);
  const RaySamples unseen = random_samples(published, kFirstGhost, thesis::kSamples, kUnseenSeed);
  const auto x_grid = add_dense("x, grid", grid.x(), unseen.x(), Basis::Monomials, thesis::kDenseGrid);
  if (!x_grid) return tl::unexpected(x_grid.error());
  const auto x_random = add_dense("x, random", random.x(), unseen.x(), Basis::Monomials, thesis::kDenseRandom);
  if (!x_random) return tl::unexpected(x_random.error());
  add_overview("x, grid", *x_grid, true);
  add_overview("x, random", *x_random, true);
  add_orthogonality();
  return options_.full ? measure_more_dense(grid, random, unseen) : Result<void>{};
}

Result<void> FitsBench::measure_more_dense(const RaySamples& grid, const RaySamples& random, const RaySamples& unseen) {
  const auto legendre =
      add_dense("x, random, Legendre", random.x(), unseen.x(), Basis::Legendre, {}, "the same polynomial");
  if (!legendre) return tl::unexpected(legendre.error());
  const auto y_grid = add_dense("y, grid", grid.y(), unseen.y(), Basis::Monomials, {});
  if (!y_grid) return tl::unexpected(y_grid.error());
  const auto y_random = add_dense("y, random", random.y(), unseen.y(), Basis::Monomials, {});
  if (!y_random) return tl::unexpected(y_random.error());
  add_overview("y, grid", *y_grid, false);
  add_overview("y, random", *y_random, false);
  const TwoLenses right{TwoLenses::Tracer::Spheres};
  const RaySamples rays = random_samples(right, kFirstGhost, thesis::kDenseSamples, options_.seed);
  const RaySamples others = random_samples(right, kFirstGhost, thesis::kSamples, kUnseenSeed);
  const auto spheres =
      add_dense("x, random, spheres", rays.x(), others.x(), Basis::Monomials, {}, "without the tracer's cylinders");
  if (!spheres) return tl::unexpected(spheres.error());
  return {};
}

Result<void> FitsBench::start_sparse() {
  if (dense_) return {};
  auto fit = DenseFit::fit(random_samples({}, kFirstGhost, thesis::kSamples, options_.seed).x(), thesis::kDegree);
  if (!fit) return tl::unexpected(fit.error());
  dense_.emplace(std::move(*fit));
  unseen_ = random_samples({}, kFirstGhost, thesis::kSamples, kUnseenSeed).x();
  fits_.rows.push_back({"algorithms", "dense, which the others start from",
                        static_cast<int>(dense_->polynomial().terms.size()), thesis::kSamples, 0, dense_->error(),
                        rms_error(dense_->polynomial(), unseen_), dense_->seconds(), thesis::kDenseOfSparse,
                        std::nullopt, "the others' times do not contain this one"});
  return {};
}

Result<void> FitsBench::add_pursuit(std::string name, const PursuitOptions& pursuit,
                                    std::optional<thesis::Figure> figure, std::string note) {
  const auto fit = matching_pursuit(*dense_, pursuit, context_);
  if (!fit) return tl::unexpected(fit.error());
  PolynomialRow row{"algorithms",
                    name,
                    pursuit.terms,
                    thesis::kSamples,
                    static_cast<int>(fit->curve.size()),
                    fit->error,
                    rms_error(fit->polynomial, unseen_),
                    fit->seconds};
  if (figure) row.thesis_error = figure->error, row.thesis_seconds = figure->seconds;
  row.note = std::move(note);
  fits_.rows.push_back(std::move(row));
  const std::string replaced = pursuit.replacement ? "omp, replaced" : "omp";
  const bool published = pursuit.rating == PursuitOptions::Rating::DenseCoefficient;
  fits_.curves.push_back({"convergence", published ? replaced + ", publ." : replaced, fit->curve, {}});
  return {};
}

Result<SparseFit> FitsBench::add_annealing(const std::string& table, std::string name,
                                           const AnnealingOptions& annealing, std::optional<thesis::Figure> figure,
                                           std::string note) {
  auto fit = anneal(*dense_, annealing, context_);
  if (!fit) return fit;
  PolynomialRow row{table,
                    name,
                    annealing.terms,
                    annealing.samples == 0 ? thesis::kSamples : annealing.samples,
                    annealing.iterations,
                    fit->error,
                    rms_error(fit->polynomial, unseen_),
                    fit->seconds};
  if (figure) row.thesis_error = figure->error, row.thesis_seconds = figure->seconds;
  row.note = std::move(note);
  fits_.rows.push_back(std::move(row));
  return fit;
}

// The table of 5.3.2 and figures 5.7 and 5.8.
Result<void> FitsBench::measure_algorithms() {
  using Rating = PursuitOptions::Rating;
  const std::string published = "rated as published", ours = "rated by the error after a fit";
  if (auto ok = add_pursuit("omp, published", {.terms = thesis::kTerms, .rating = Rating::DenseCoefficient},
                            thesis::kPursuit, published);
      !ok)
    return ok;
  if (auto ok = add_pursuit("omp with replacement, published",
                            {.terms = thesis::kTerms, .replacement = true, .rating = Rating::DenseCoefficient},
                            thesis::kReplacement, published);
      !ok)
    return ok;
  if (auto ok = add_pursuit("omp", {.terms = thesis::kTerms}, thesis::kPursuit, ours); !ok) return ok;
  if (auto ok = add_pursuit("omp with replacement", {.terms = thesis::kTerms, .replacement = true},
                            thesis::kReplacement, ours);
      !ok)
    return ok;
  const AnnealingOptions all{
      .terms = thesis::kTerms, .iterations = 5000, .samples = 0, .keep_best = true, .seed = options_.seed};
  const auto fit = add_annealing("algorithms", "annealing", all, thesis::kAnnealing, "all samples in each step");
  if (!fit) return tl::unexpected(fit.error());
  fits_.curves.push_back({"convergence", "annealing", fit->curve, {}});
  return {};
}

// The table of annealing's samples and iterations, and figure 5.9: as published, and with all samples through their
// sums.
Result<void> FitsBench::measure_annealing() {
  for (const thesis::AnnealingFigure& figure : thesis::kAnnealingTable) {
    const bool same = options_.full || figure.samples <= 1000;
    if (!same && figure.iterations != 30000) continue;
    AnnealingOptions options{.terms = thesis::kTerms, .samples = figure.samples, .seed = options_.seed};
    options.iterations = options_.full ? figure.iterations : kQuickIterations;
    const std::string sizes = fmt::format("{} x {}", options.samples, options.iterations);
    const bool published = options.iterations == figure.iterations;
    const auto fit =
        add_annealing("annealing", "annealing, published", options,
                      published ? std::optional(thesis::Figure{figure.error, figure.seconds}) : std::nullopt);
    if (!fit) return tl::unexpected(fit.error());
    fits_.curves.push_back({"annealing", sizes, fit->curve, {}});
    if (!options_.full) break;
  }
  for (const int iterations : {5000, 10000, 30000}) {
    std::optional<thesis::Figure> figure;
    for (const thesis::AnnealingFigure& one : thesis::kAnnealingTable)  // the lowest error with as many iterations
      if (one.iterations == iterations && (!figure || one.error < figure->error))
        figure = thesis::Figure{one.error, one.seconds};
    const AnnealingOptions options{
        .terms = thesis::kTerms, .iterations = iterations, .samples = 0, .keep_best = true, .seed = options_.seed};
    const auto fit = add_annealing("annealing", "annealing", options, figure, "all samples in each step");
    if (!fit) return tl::unexpected(fit.error());
    fits_.curves.push_back({"annealing", fmt::format("all x {}", iterations), fit->curve, {}});
  }
  return {};
}

// Figure 5.10: runs that differ in their seed.
Result<void> FitsBench::measure_variation() {
  const int runs = options_.full ? kRuns : kQuickRuns;
  double sum = 0.0, squares = 0.0, seconds = 0.0;
  PolynomialCurve curve{"variation", "runs", {}, {}};
  for (int run = 0; run < runs; ++run) {
    const AnnealingOptions options{.terms = thesis::kTerms,
                                   .iterations = 30000,
                                   .samples = 0,
                                   .seed = options_.seed + 100 + static_cast<std::uint64_t>(run)};
    const auto fit = anneal(*dense_, options, context_);
    if (!fit) return tl::unexpected(fit.error());
    sum += fit->error, squares += fit->error * fit->error, seconds += fit->seconds;
    curve.points.push_back({run + 1, fit->seconds, fit->error, fit->error});
  }
  const double mean = sum / runs, deviation = std::sqrt(std::max(0.0, (squares - sum * mean) / (runs - 1)));
  PolynomialRow row{"variation",
                    fmt::format("annealing, mean of {} runs", runs),
                    thesis::kTerms,
                    thesis::kSamples,
                    30000,
                    mean,
                    0.0,
                    seconds / runs};
  row.thesis_error = thesis::kVariationMean;
  row.thesis_seconds = thesis::kAnnealingTable.back().seconds;
  row.note = fmt::format("standard deviation {:.5f}, thesis {:.5f}", deviation, thesis::kVariationDeviation);
  fits_.rows.push_back(std::move(row));
  fits_.curves.push_back(std::move(curve));
  return {};
}

// "Simulated annealing without fitting".
Result<void> FitsBench::measure_unfitted() {
  AnnealingOptions options{
      .terms = thesis::kTerms, .iterations = 5000, .samples = 2000, .fit = false, .seed = options_.seed};
  if (const auto fit = add_annealing("unfitted", "annealing, dense coefficients", options, thesis::kUnfitted); !fit)
    return tl::unexpected(fit.error());
  options.iterations = 100000;
  options.samples = 0;
  options.keep_best = true;
  const auto fit = add_annealing("unfitted", "annealing, dense coefficients", options, std::nullopt,
                                 "all samples; the thesis has 0.82 in the time of a search with fits");
  if (!fit) return tl::unexpected(fit.error());
  return {};
}

Result<PolynomialFits> FitsBench::measure() {
  struct Part {
    std::string_view table;
    bool sparse;
    Result<void> (FitsBench::*measure)();
  };
  constexpr Part kParts[] = {{"dense", false, &FitsBench::measure_dense},
                             {"algorithms", true, &FitsBench::measure_algorithms},
                             {"annealing", true, &FitsBench::measure_annealing},
                             {"variation", true, &FitsBench::measure_variation},
                             {"unfitted", true, &FitsBench::measure_unfitted}};
  for (const Part& part : kParts) {
    if (!wanted(part.table)) continue;
    if (part.sparse)
      if (const auto ok = start_sparse(); !ok) return tl::unexpected(ok.error());
    if (const auto ok = (this->*part.measure)(); !ok) return tl::unexpected(ok.error());
  }
  if (wanted("zones"))
    if (const auto ok = measure_polynomial_zones(fits_, options_, context_); !ok) return tl::unexpected(ok.error());
  return std::move(fits_);
}

}  // namespace

const std::vector<std::string>& published_fit_tables() {
  static const std::vector<std::string> kTables{"dense", "algorithms", "annealing", "variation", "unfitted", "zones"};
  return kTables;
}

Result<PolynomialFits> measure_polynomial_fits(const PolynomialBenchOptions& options, const Context& context) {
  return FitsBench(options, context).measure();
}

}  // namespace contrejour::cli
