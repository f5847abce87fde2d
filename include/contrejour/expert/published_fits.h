// SPDX-License-Identifier: Apache-2.0
// Polynomials of rays as they were published, for comparison with ours (polynomial.h): dense ones and sparse choices of
// their terms (sabatschus2022 3.3, 3.8, 3.9), and sparse ones in zones of the field (Bodonyi, Csoba and Kunkli 2025).
// docs/physics/polynomial-published.md has their figures and ours.
// Errors are root mean squares over samples, in the samples' units; seconds are processor time of the whole process.
// Equal seeds give equal results on any machine with the same floating-point arithmetic, for any number of threads.
// Thread-safety: plain values, pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour::published {

inline constexpr int kLargestDegree = 16;

// Four variables, each in [-1, 1].
using Inputs = std::array<double, 4>;
using Exponents = std::array<std::uint8_t, 4>;

struct Samples {
  std::vector<Inputs> inputs;
  std::vector<double> values;  // one for each of the inputs
};

// Legendre polynomials have a mean square of 1 over [-1, 1].
enum class Basis : std::uint8_t { Monomials, Legendre };

struct Term {
  Exponents exponents{};
  double coefficient = 0.0;
};

struct Polynomial {
  Basis basis = Basis::Monomials;
  std::vector<Term> terms;  // their degrees are at most kLargestDegree
};

[[nodiscard]] CONTREJOUR_API double evaluate(const Polynomial& polynomial, const Inputs& at);
[[nodiscard]] CONTREJOUR_API double rms_error(const Polynomial& polynomial, const Samples& samples);

// All terms whose exponents sum to at most the degree, the last exponent fastest: 1001 for degree 10.
[[nodiscard]] CONTREJOUR_API std::vector<Exponents> terms_up_to(int degree);

// The polynomial of all terms up to a degree that fits samples best, and what searches among its terms need.
class CONTREJOUR_API DenseFit {
 public:
  // By Householder's QR in double. Differs: the thesis solves the normal equations, which square the condition number.
  // Errors: InvalidArgument for a degree outside of 0 to kLargestDegree, numbers that are not finite, or fewer samples
  // than terms.
  [[nodiscard]] static Result<DenseFit> fit(const Samples& samples, int degree, Basis basis = Basis::Monomials);

  [[nodiscard]] const Polynomial& polynomial() const;
  [[nodiscard]] double error() const;
  [[nodiscard]] double seconds() const;  // of the fit

  struct State;
  [[nodiscard]] const State& state() const { return *state_; }

 private:
  explicit DenseFit(std::shared_ptr<const State> state) : state_(std::move(state)) {}

  std::shared_ptr<const State> state_;
};

struct CurvePoint {
  int step = 0;
  double seconds = 0.0;  // since the search began
  double error = 0.0;  // of the terms at this step
  double best = 0.0;  // the lowest error so far
};

struct SparseFit {
  Polynomial polynomial;  // fitted to all samples
  double error = 0.0;
  double seconds = 0.0;  // of the search, without the dense fit
  std::vector<CurvePoint> curve;
};

struct PursuitOptions {
  int terms = 100;
  bool replacement = false;
  // How a term is rated that might be added.
  enum class Rating : std::uint8_t {
    // As the thesis's code does: by the error with the term's coefficient of the dense polynomial, before the new fit.
    DenseCoefficient,
    // By the error after a fit of all coefficients, which an orthogonalisation of all terms yields without the fits
    // (orthogonal least squares; Chen, Billings and Luo 1989).
    ErrorReduction,
  } rating = Rating::ErrorReduction;
  // With replacement. DenseCoefficient: one step for each term of the dense polynomial, as in the thesis.
  // ErrorReduction: replacements end when none lowers the error, and after this number at the latest.
  int max_replacements = 1000;
};

// Adds terms one by one, and fits all coefficients after each (orthogonal matching pursuit). With replacement, each
// further term takes the place of the one whose removal costs least (Schrade, Hanika and Dachsbacher 2016).
// Errors: InvalidArgument for a number of terms that the dense polynomial does not have; Cancelled.
[[nodiscard]] CONTREJOUR_API Result<SparseFit> matching_pursuit(const DenseFit& dense,
                                                                const PursuitOptions& options = {},
                                                                const Context& context = {});

struct AnnealingOptions {
  int terms = 100;
  int iterations = 5000;
  // Number of consecutive samples, from a random one on, that each step fits and rates. 0: all of them, through sums
  // over the samples that the dense fit has, which takes less time than a thousand samples.
  int samples = 2000;
  bool fit = true;  // false: the coefficients of the dense polynomial are kept
  bool keep_best = false;  // false: the result has the last terms, as in the thesis; true: the best ones
  std::uint64_t seed = 1;
  // The thesis's schedule: a temperature t that falls linearly from 1 to 0, max(t^power terms, 1) terms exchanged, and
  // exp(-factor dE / t) as the probability that an increase dE of the error is accepted (3.9.1).
  double power = 3.0, factor = 100.0;
};

// Errors: InvalidArgument for options out of range; Cancelled.
[[nodiscard]] CONTREJOUR_API Result<SparseFit> anneal(const DenseFit& dense, const AnnealingOptions& options = {},
                                                      const Context& context = {});

// One point of the field and one output of a ghost: rays by x, y, r and 1 - r of their entrance point over the
// entrance's radius, as the 2025 work has it. All zones of a fit have the same terms, and coefficients of their own.
struct ZoneSamples {
  std::vector<Inputs> inputs;
  std::vector<double> values;
};

struct ZoneOptions {
  int terms = 5;
  int largest_exponent = 5;
  enum class Search : std::uint8_t {
    Gaps,  // terms grown one by one from the constant, then replaced, with ever larger changes of one exponent
    Annealing,
  } search = Search::Gaps;
  int iterations = 10000;  // of annealing, as published
  std::uint64_t seed = 1;
};

struct ZoneFit {
  std::vector<Exponents> terms;
  std::vector<std::vector<double>> coefficients;  // by zone, one for each term
  std::vector<double> zone_errors;
  double error = 0.0;  // root of the mean square of the zones' errors
  double seconds = 0.0;
  std::vector<CurvePoint> curve;
};

// Errors: InvalidArgument for options out of range, no zones, or a zone with fewer samples than terms; Cancelled.
[[nodiscard]] CONTREJOUR_API Result<ZoneFit> fit_sparse_zones(std::span<const ZoneSamples> zones,
                                                              const ZoneOptions& options = {},
                                                              const Context& context = {});

}  // namespace contrejour::published
