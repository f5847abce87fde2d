// SPDX-License-Identifier: Apache-2.0
// The published fits on tasks whose answers are known: planted polynomials, and the figures that the thesis prints.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/published_fits.h"
#include "contrejour/expert/published_samples.h"
#include "contrejour/expert/trace.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::published;

namespace {

std::vector<Inputs> random_inputs(int count, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<Inputs> inputs(static_cast<std::size_t>(count));
  for (Inputs& at : inputs)
    for (double& x : at) x = 2.0 * (static_cast<double>(engine()) * 0x1p-32) - 1.0;
  return inputs;
}

Samples samples_of(const Polynomial& polynomial, int count, unsigned seed) {
  Samples samples{random_inputs(count, seed), {}};
  for (const Inputs& at : samples.inputs) samples.values.push_back(evaluate(polynomial, at));
  return samples;
}

// Six terms of degree up to 5, whose coefficients alternate in sign.
Polynomial planted(Basis basis) {
  Polynomial p{basis, {}};
  double c = 1.0;
  for (const Exponents& e : {Exponents{0, 0, 0, 0}, Exponents{1, 0, 0, 0}, Exponents{0, 2, 1, 0}, Exponents{1, 1, 1, 1},
                             Exponents{0, 0, 0, 5}, Exponents{2, 0, 3, 0}})
    p.terms.push_back({e, c = -1.3 * c});
  return p;
}

std::set<Exponents> terms_of(const Polynomial& polynomial) {
  std::set<Exponents> terms;
  for (const Term& term : polynomial.terms) terms.insert(term.exponents);
  return terms;
}

// A smooth function that no polynomial of few terms equals.
Samples smooth_samples(int count, unsigned seed) {
  Samples samples{random_inputs(count, seed), {}};
  for (const Inputs& x : samples.inputs)
    samples.values.push_back(std::sin(2.0 * x[0] + x[1]) * std::exp(0.5 * x[2]) + 1.0 / (2.0 + x[3]));
  return samples;
}

}  // namespace

TEST_CASE("a dense polynomial has the thesis's number of terms") {
  CHECK(terms_up_to(10).size() == 1001);  // sabatschus2022 5.3.2
  CHECK(terms_up_to(0).size() == 1);
  for (const Exponents& e : terms_up_to(3)) CHECK(e[0] + e[1] + e[2] + e[3] <= 3);
}

TEST_CASE("both bases evaluate as their formulas") {
  const Inputs at{0.3, -0.7, 0.5, 0.9};
  const Polynomial monomial{Basis::Monomials, {{{2, 1, 0, 3}, 4.0}}};
  CHECK(evaluate(monomial, at) == test::approx(4.0 * 0.09 * -0.7 * 0.729));
  const Polynomial legendre{Basis::Legendre, {{{2, 0, 3, 0}, 1.0}}};
  const double p2 = 0.5 * (3.0 * 0.09 - 1.0) * std::sqrt(5.0);
  const double p3 = 0.5 * (5.0 * 0.125 - 3.0 * 0.5) * std::sqrt(7.0);
  CHECK(evaluate(legendre, at) == test::approx(p2 * p3));
}

TEST_CASE("a dense fit reproduces a polynomial of its degree") {
  for (const Basis basis : {Basis::Monomials, Basis::Legendre}) {
    const Polynomial truth = planted(basis);
    const auto fit = DenseFit::fit(samples_of(truth, 400, 1), 5, basis);
    REQUIRE(fit.has_value());
    CHECK(fit->error() < 1e-12);
    CHECK(rms_error(fit->polynomial(), samples_of(truth, 300, 2)) < 1e-11);
  }
}

TEST_CASE("bad samples are refused") {
  Samples samples = smooth_samples(20, 1);
  CHECK(!DenseFit::fit(samples, 5).has_value());
  CHECK(!DenseFit::fit(samples, -1).has_value());
  samples.values[3] = std::nan("");
  CHECK(!DenseFit::fit(samples, 1).has_value());
  samples = smooth_samples(20, 1);
  samples.inputs[0][2] = 1.5;
  CHECK(!DenseFit::fit(samples, 1).has_value());
  samples = smooth_samples(20, 1);
  samples.values.pop_back();
  CHECK(!DenseFit::fit(samples, 1).has_value());
}

TEST_CASE("matching pursuit finds the terms of a planted polynomial") {
  for (const Basis basis : {Basis::Monomials, Basis::Legendre}) {
    const Polynomial truth = planted(basis);
    const auto dense = DenseFit::fit(samples_of(truth, 600, 3), 6, basis);
    REQUIRE(dense.has_value());
    // A greedy search takes monomials that resemble each other by mistake, which replacements put right.
    const auto sparse = matching_pursuit(*dense, {.terms = 6, .replacement = true});
    REQUIRE(sparse.has_value());
    CHECK(sparse->error < 1e-9);
    CHECK(terms_of(sparse->polynomial) == terms_of(truth));
    // Legendre polynomials are nearly orthogonal over the samples, so their dense coefficients rate terms rightly.
    if (basis == Basis::Monomials) continue;
    const auto published = matching_pursuit(*dense, {.terms = 6, .rating = PursuitOptions::Rating::DenseCoefficient});
    REQUIRE(published.has_value());
    CHECK(terms_of(published->polynomial) == terms_of(truth));
  }
}

TEST_CASE("each rating of terms is what it says") {
  const Samples samples = smooth_samples(300, 4);
  const auto dense = DenseFit::fit(samples, 3);
  REQUIRE(dense.has_value());
  // By trying every term: the error of a fit with each of two terms.
  double best = 1e9;
  const auto terms = terms_up_to(3);
  const auto first = matching_pursuit(*dense, {.terms = 1});
  REQUIRE(first.has_value());
  const Exponents chosen = first->polynomial.terms[0].exponents;
  for (const Exponents& term : terms) {
    double bb = 0.0, by = 0.0, yy = 0.0;
    for (std::size_t k = 0; k < samples.values.size(); ++k) {
      const double b = evaluate({Basis::Monomials, {{term, 1.0}}}, samples.inputs[k]), y = samples.values[k];
      bb += b * b, by += b * y, yy += y * y;
    }
    best = std::min(best, std::sqrt((yy - by * by / bb) / static_cast<double>(samples.values.size())));
    if (term == chosen) CHECK(first->error == test::approx(std::sqrt((yy - by * by / bb) / 300.0)));
  }
  CHECK(first->error == test::approx(best));
}

TEST_CASE("replacement never raises the error, and more terms lower it") {
  const auto dense = DenseFit::fit(smooth_samples(500, 5), 5);
  REQUIRE(dense.has_value());
  double last = 1e9;
  for (const int terms : {5, 10, 20}) {
    const auto plain = matching_pursuit(*dense, {.terms = terms});
    const auto replaced = matching_pursuit(*dense, {.terms = terms, .replacement = true});
    REQUIRE((plain.has_value() && replaced.has_value()));
    CHECK(plain->polynomial.terms.size() == static_cast<std::size_t>(terms));
    CHECK(replaced->error <= plain->error * (1.0 + 1e-9));
    CHECK(plain->error < last);
    CHECK(replaced->curve.back().error == test::approx(replaced->error).epsilon(1e-6));
    for (std::size_t k = 1; k < replaced->curve.size(); ++k)
      CHECK(replaced->curve[k].error <= replaced->curve[k - 1].error * (1.0 + 1e-9));
    last = plain->error;
  }
  CHECK(!matching_pursuit(*dense, {.terms = 0}).has_value());
  CHECK(!matching_pursuit(*dense, {.terms = 1000}).has_value());
}

TEST_CASE("annealing finds a planted polynomial, and its best error only falls") {
  const Polynomial truth = planted(Basis::Monomials);
  const auto dense = DenseFit::fit(samples_of(truth, 400, 6), 5);
  REQUIRE(dense.has_value());
  for (const int samples : {0, 200}) {
    const auto fit = anneal(*dense, {.terms = 12, .iterations = 4000, .samples = samples, .keep_best = true});
    REQUIRE(fit.has_value());
    CHECK(fit->error < 1e-9);
    for (std::size_t k = 1; k < fit->curve.size(); ++k) CHECK(fit->curve[k].best <= fit->curve[k - 1].best);
    const std::set<Exponents> found = terms_of(fit->polynomial);
    for (const Exponents& e : terms_of(truth)) CHECK(found.contains(e));
  }
}

TEST_CASE("annealing depends on its seed alone") {
  const auto dense = DenseFit::fit(smooth_samples(400, 7), 5);
  REQUIRE(dense.has_value());
  const AnnealingOptions options{.terms = 20, .iterations = 300, .samples = 100};
  AnnealingOptions other = options;
  other.seed = 2;
  const auto a = anneal(*dense, options), b = anneal(*dense, options), c = anneal(*dense, other);
  REQUIRE((a.has_value() && b.has_value() && c.has_value()));
  CHECK(a->error == b->error);
  CHECK(a->error != c->error);
  CHECK(terms_of(a->polynomial) == terms_of(b->polynomial));
}

TEST_CASE("annealing with dense coefficients is worse than with a fit") {
  const auto dense = DenseFit::fit(smooth_samples(400, 8), 5);
  REQUIRE(dense.has_value());
  AnnealingOptions options{.terms = 20, .iterations = 1000, .samples = 0};
  const auto fitted = anneal(*dense, options);
  options.fit = false;
  const auto kept = anneal(*dense, options);
  REQUIRE((fitted.has_value() && kept.has_value()));
  CHECK(kept->error > 2.0 * fitted->error);
  CHECK(kept->curve.back().error == test::approx(kept->error).epsilon(1e-6));  // over all samples, as reported
  CHECK(!anneal(*dense, {.terms = 20, .samples = 10}).has_value());
  CHECK(!anneal(*dense, {.terms = 20, .samples = 401}).has_value());
  CHECK(!anneal(*dense, {.terms = 20, .iterations = 0, .samples = 0}).has_value());
}

TEST_CASE("a cancelled search says so") {
  const auto dense = DenseFit::fit(smooth_samples(400, 9), 5);
  REQUIRE(dense.has_value());
  const std::atomic<bool> cancel = true;
  const auto fit = anneal(*dense, {.terms = 20, .samples = 0}, {.cancel = &cancel});
  REQUIRE(!fit.has_value());
  CHECK(fit.error().code == ErrorCode::Cancelled);
  CHECK(!matching_pursuit(*dense, {.terms = 20}, {.cancel = &cancel}).has_value());
}

TEST_CASE("zones share the terms of a planted polynomial") {
  // Each zone has its own coefficients, the middle zone none of one term.
  const std::array<Exponents, 3> truth{Exponents{0, 0, 0, 0}, Exponents{1, 0, 0, 0}, Exponents{1, 0, 2, 0}};
  std::vector<ZoneSamples> zones;
  for (int zone = 0; zone < 3; ++zone) {
    Polynomial p{Basis::Monomials, {{truth[0], 0.1 * zone}, {truth[1], 1.0 + zone}, {truth[2], 0.3 * (zone - 1)}}};
    ZoneSamples samples;
    for (const Inputs& at : random_inputs(150, 20U + static_cast<unsigned>(zone))) {
      const double r = std::sqrt(0.5 * (at[0] * at[0] + at[1] * at[1]));
      samples.inputs.push_back({at[0] * std::sqrt(0.5), at[1] * std::sqrt(0.5), r, 1.0 - r});
      samples.values.push_back(evaluate(p, samples.inputs.back()));
    }
    zones.push_back(std::move(samples));
  }
  for (const auto search : {ZoneOptions::Search::Gaps, ZoneOptions::Search::Annealing}) {
    const auto fit = fit_sparse_zones(zones, {.terms = 5, .search = search, .iterations = 4000});
    REQUIRE(fit.has_value());
    CHECK(fit->terms.size() == 5);
    // Annealing draws from 1296 terms at random and comes near; a constant alone leaves 0.8.
    CHECK(fit->error < (search == ZoneOptions::Search::Gaps ? 1e-9 : 0.05));
    for (std::size_t k = 1; k < fit->curve.size(); ++k) CHECK(fit->curve[k].best <= fit->curve[k - 1].best);
  }
  CHECK(!fit_sparse_zones({}, {}).has_value());
  CHECK(!fit_sparse_zones(zones, {.terms = 0}).has_value());
}

TEST_CASE("the thesis's own rays: as many arrive of its grid, as far from their mean") {
  // sabatschus2022 5.3.1: 11673 samples of a grid; 13^4 rays, as its code takes of 10000 (10000^0.28 = 13.2).
  const RaySamples grid = grid_samples({}, {0, 1}, 13);
  CHECK(grid.inputs.size() == 11673);
  // With spheres, 11670 arrive of the same grid if the stop does not block, which tells both apart.
  CHECK(grid_samples({TwoLenses::Tracer::Spheres, 7.0, false}, {0, 1}, 13).inputs.size() == 11670);
  CHECK(random_samples({}, {0, 1}, 100, 1).inputs.size() == 100);
  CHECK(!trace({}, {0, 2}, {}).arrives);
  CHECK(!trace({}, {1, 0}, {}).arrives);
}

TEST_CASE("with spheres the thesis's system is a lens of ours") {
  const char* toml = R"(
name = "two lenses"
source = "sabatschus2022"
f_number = 2
sensor_mm = [4, 4]
sensor_distance_mm = 3.5
surfaces = [
  { radius_mm =  3, thickness_mm = 1.5, semi_diameter_mm = 1.4, glass = "N-BK7" },
  { radius_mm = -3, thickness_mm = 1.5, semi_diameter_mm = 1.4 },
  { stop = true, thickness_mm = 0.4, semi_diameter_mm = 1.0 },
  { radius_mm =  3, thickness_mm = 1.5, semi_diameter_mm = 1.4, glass = "N-BK7" },
  { radius_mm = -3, semi_diameter_mm = 1.4 },
]
)";
  const auto read = read_lens_toml(toml, "two.toml");
  REQUIRE_MESSAGE(read.has_value(), read.error().message);
  const auto lens = configure_lens(*read);
  REQUIRE_MESSAGE(lens.has_value(), lens.error().message);
  // Ours begins at 0, has the stop 0.4 before the second lens, which a prescription needs, and its own sensor.
  for (const auto& [pair, ghost] : {std::pair{ElementPair{0, 1}, Ghost{1, 2}}, {{3, 4}, {4, 5}}, {{1, 3}, {2, 4}}}) {
    OpticalPath path = ghost_path(*lens, ghost, 500.0);
    for (PathStep& step : path.steps)
      if (step.surface >= 3) step.z_mm -= 0.4;
    path.sensor_z_mm = 12.0;
    int arrived = 0;
    for (const Inputs& at : random_inputs(400, 11)) {
      const TwoLensesRay theirs = trace({TwoLenses::Tracer::Spheres, 7.0, false}, pair, at);
      const Vec3 origin{0.5 * at[0], 0.5 * at[1], -1.0};
      const TracedRay ours = trace(path, {origin, normalized(Vec3{0.5 * at[2], 0.5 * at[3], 1.0})});
      REQUIRE(theirs.arrives == (ours.status == RayStatus::Ok));
      if (!theirs.arrives) continue;
      ++arrived;
      CHECK(length(theirs.sensor - ours.sensor_mm) < 1e-5 * (1.0 + length(ours.sensor_mm)));
      const auto last = static_cast<std::size_t>(path.stop_crossings) - 1;
      CHECK(length(theirs.stop - ours.stop[last]) < 1e-5);
    }
    CHECK(arrived > 5);
  }
}

TEST_CASE("rays in zones are those of the tracer") {
  const auto read = find_lens("tessar");
  REQUIRE(read.has_value());
  const auto lens = configure_lens(*read);
  REQUIRE(lens.has_value());
  const auto zones = zone_samples(*lens, {1, 4}, {.fields = 3, .largest_field = 0.1, .rays = 60});
  REQUIRE(zones.has_value());
  REQUIRE(zones->fields.size() == 3);
  for (std::size_t k = 0; k < zones->zones.size(); ++k) {
    const ZoneSamples& zone = zones->zones[k];
    CHECK(zone.inputs.size() == 60);
    const LightSource light(normalized({zones->fields[k], 0.0, 1.0}));
    const double z_mm = entrance_window(*lens, light).z_mm;
    for (std::size_t ray = 0; ray < zone.inputs.size(); ++ray) {
      const Inputs& at = zone.inputs[ray];
      CHECK(at[2] + at[3] == test::approx(1.0));
      CHECK(at[2] <= 1.0 + 1e-12);
      const Vec3 origin{at[0] * zones->radius_mm, at[1] * zones->radius_mm, z_mm};
      const TracedRay traced =
          trace(ghost_path(*lens, {1, 4}, 550.0), {origin, normalized(Vec3{zones->fields[k], 0.0, 1.0})});
      CHECK(traced.sensor_mm.x == test::approx(zone.values[ray]));
      CHECK(length(traced.stop[0]) <= 1.1);
    }
  }
  CHECK(!zone_samples(*lens, {1, 99}).has_value());
  CHECK(!zone_samples(*lens, {1, 4}, {.fields = 0}).has_value());
}
