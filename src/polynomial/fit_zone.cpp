// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fit_zone.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "polynomial/chebyshev_basis.h"
#include "polynomial/least_squares.h"
#include "polynomial/zone_check.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kFields = 19, kRaysAtField = 96;
constexpr int kRimRaysAtField = 400;  // at one wavelength, that show which rims block
constexpr int kMinDegree = 2;  // order 5
// Chebyshev-Lobatto wavelengths: every third one suffices for positions, which vary less than transmittances.
constexpr int kWavelengths = 13, kWavelengthStep = 3;
// Relative heights beyond which rays are left out, and how steeply rays that are blocked count less before. Next to the
// light, a ghost's rays often are close to total reflection or to missing a surface, where its map has a branch point:
// a polynomial that follows these rays spends its degrees there. Positions on the sensor and transmittances matter only
// for light that gets through; the edges that block light must also block all light beyond.
constexpr double kFarthestLight = 1.2, kFarthestEdge = 2.0;
constexpr double kFallLight = 48.0, kFallEdge = 48.0;
constexpr double kNearSensor = 1.6;  // half diagonals: rays that land farther out count less
constexpr double kSamplesPerUnknown = 2.0;
// Rays do not cover the basis' whole cube, |v| <= h |p|, so that at high orders some sums of terms are nearly 0 at all
// of them. Without a ridge their coefficients grow until float cannot hold the differences.
constexpr double kRidge = 1e-7;
// Squared relative heights next to an edge, wide enough that the few rays there show which rim is the outermost, and by
// how much a rim must exceed the others.
constexpr double kOpenLimit = 1.12, kBlockingRim = 0.88, kOutermostBy = 0.004;
constexpr double kRoom = 1.02;  // of the pupil radius, around the bounds

double lobatto(int k, int count) { return std::cos(std::numbers::pi * k / (count - 1)); }

// Chebyshev coefficients of the polynomial through values at Lobatto points.
std::vector<double> coefficients_of(std::span<const double> values) {
  const auto last = static_cast<int>(values.size()) - 1;
  std::vector<double> out(values.size(), 0.0);
  for (int l = 0; l <= last; ++l) {
    double sum = 0.0;
    for (int j = 0; j <= last; ++j) {
      const double end = j == 0 || j == last ? 0.5 : 1.0;
      sum += end * values[static_cast<std::size_t>(j)] * std::cos(std::numbers::pi * l * j / last);
    }
    out[static_cast<std::size_t>(l)] = (l == 0 || l == last ? 1.0 : 2.0) / last * sum;
  }
  return out;
}

// The shear that moves the pupil's middle to the origin: least squares over the fields with light.
void set_pupil_coordinates(PolynomialZone& zone) {
  double ff = 0.0, fg = 0.0, gg = 0.0, fm = 0.0, gm = 0.0;
  for (const PolynomialBounds& b : zone.bounds) {
    if (!has_light(b)) continue;
    const double middle = 0.5 * (static_cast<double>(b.low_x_mm) + b.high_x_mm);
    const double f = b.field, g = f * field_coordinate(zone, f);
    ff += f * f, fg += f * g, gg += g * g, fm += f * middle, gm += g * middle;
  }
  const double determinant = ff * gg - fg * fg;
  if (determinant > 1e-9 * ff * gg) {
    zone.centre_mm = (gg * fm - fg * gm) / determinant;
    zone.centre_slope_mm = (ff * gm - fg * fm) / determinant;
  } else {
    zone.centre_mm = ff > 0.0 ? fm / ff : 0.0;
  }
  double farthest = 0.0;
  for (const PolynomialBounds& b : zone.bounds) {
    if (!has_light(b)) continue;
    for (const double x : {b.low_x_mm, b.high_x_mm})
      farthest = std::max(farthest, std::hypot(x - centre_at(zone, b.field), static_cast<double>(b.half_y_mm)));
  }
  zone.radius_mm = kRoom * farthest;
}

// Rays of a fit that arrive at all wavelengths, and how much each of them counts.
struct WeightedRays {
  std::vector<std::size_t> used;
  std::vector<double> weight;

  void add(std::size_t ray, double by) {
    used.push_back(ray);
    weight.push_back(by);
  }
};

// The rays of a fit at all of its wavelengths.
struct FitRays {
  std::vector<RayStart> starts;
  std::vector<ZonePoint> points;
  std::vector<RayTable> tables;  // one a wavelength
  WeightedRays for_light, for_edges;

  [[nodiscard]] const RayTable& middle() const { return tables[tables.size() / 2]; }
};

FitRays fit_rays(const ZoneProblem& problem, const PolynomialZone& zone) {
  FitRays out;
  out.starts = starts_within(zone.bounds, kRaysAtField, 1);
  for (const RayStart& start : out.starts) out.points.push_back(zone_point(zone, start.field, start.entrance_mm));
  for (int k = 0; k < kWavelengths; ++k)
    out.tables.push_back(problem.rays.trace(out.starts, wavelength_at(problem.lens, lobatto(k, kWavelengths))));
  const double near_mm = kNearSensor * length(problem.sensor_half_mm);
  for (std::size_t ray = 0; ray < out.starts.size(); ++ray) {
    double clearance = 0.0;
    for (const RayTable& table : out.tables) clearance = std::max(clearance, table.clearance(ray));
    const RayTable& middle = out.middle();
    const double landing_mm = std::hypot(middle.sensor_x_mm[ray], middle.sensor_y_mm[ray]);
    const double by_landing = std::min(1.0, near_mm / std::max(landing_mm, near_mm));
    const auto falling = [&](double power) { return std::pow(std::max(clearance, 1.0), -power); };
    if (clearance < kFarthestLight) out.for_light.add(ray, by_landing * falling(kFallLight));
    if (clearance < kFarthestEdge) out.for_edges.add(ray, falling(kFallEdge));
  }
  return out;
}

// The steps whose rims block light that nothing else blocks: the one that blocks most comes first. table: at the middle
// wavelength.
std::vector<int> blocking_steps(const RayTable& table) {
  std::vector<std::size_t> used;
  std::vector<double> limits;  // squared, of the stop and of the steps found so far
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (!(table.clearance(k) < kFarthestEdge)) continue;
    used.push_back(k);
    limits.push_back(0.0);
    for (const auto& crossing : table.stop)
      limits.back() = std::max(limits.back(), std::pow(std::hypot(crossing[0][k], crossing[1][k]), 2.0));
  }
  std::vector<int> steps;
  for (;;) {
    int most = 0, found = -1;
    for (std::size_t step = 0; step < table.rim_squared.size(); ++step) {
      int count = 0;
      for (std::size_t k = 0; k < limits.size(); ++k) {
        const double height = table.rim_squared[step][used[k]];
        count += limits[k] < kOpenLimit && height > std::max(kBlockingRim, limits[k] + kOutermostBy) ? 1 : 0;
      }
      if (count > most && std::ranges::find(steps, static_cast<int>(step)) == steps.end())
        most = count, found = static_cast<int>(step);
    }
    if (found < 0) return steps;
    steps.push_back(found);
    for (std::size_t k = 0; k < limits.size(); ++k)
      limits[k] = std::max(limits[k], static_cast<double>(table.rim_squared[static_cast<std::size_t>(found)][used[k]]));
  }
}

// Weighted rows of the basis at the rays: for scalars, or for both coordinates of vectors.
class Systems {
 public:
  Systems(const FitRays& rays, const WeightedRays& weighted) : rays_(rays), weighted_(weighted) {}

  [[nodiscard]] bool has_enough_rays(int degree) const {
    return static_cast<double>(weighted_.used.size()) >= kSamplesPerUnknown * term_count(degree);
  }
  [[nodiscard]] const LeastSquares& scalars(int degree) { return made(scalars_, degree, false); }
  [[nodiscard]] const LeastSquares& vectors(int degree) { return made(vectors_, degree, true); }
  [[nodiscard]] const FitRays& rays() const { return rays_; }
  [[nodiscard]] const WeightedRays& weighted() const { return weighted_; }

 private:
  using Made = std::array<std::optional<LeastSquares>, kMaxDegree + 1>;

  const LeastSquares& made(Made& all, int degree, bool of_vectors) {
    auto& one = all[static_cast<std::size_t>(degree)];
    if (!one) one.emplace(matrix(degree, of_vectors), kRidge);
    return *one;
  }

  [[nodiscard]] Rows matrix(int degree, bool of_vectors) const {
    const auto count = static_cast<std::size_t>(term_count(degree));
    Rows rows;
    rows.columns = of_vectors ? 2 * count : count;
    rows.values.reserve(weighted_.used.size() * rows.columns * (of_vectors ? 2 : 1));
    std::vector<double> terms(count);
    for (std::size_t k = 0; k < weighted_.used.size(); ++k) {
      const ZonePoint& point = rays_.points[weighted_.used[k]];
      term_values(degree, point, terms);
      const auto add = [&](double factor) {
        for (const double term : terms) rows.values.push_back(weighted_.weight[k] * factor * term);
      };
      if (!of_vectors) {
        add(1.0);
        continue;
      }
      add(point.h), add(point.p.x);
      add(0.0), add(point.p.y);
    }
    return rows;
  }

  const FitRays& rays_;
  const WeightedRays& weighted_;
  Made scalars_, vectors_;
};

// Coefficients by wavelength terms from solutions at Lobatto wavelengths, without the last terms that together change
// no value by more than `negligible`.
ChebyshevSum assembled(int degree, std::span<const std::vector<double>> solutions, std::size_t from,
                       double negligible) {
  const auto count = static_cast<std::size_t>(term_count(degree));
  std::vector<std::vector<double>> by_term;
  std::vector<double> values(solutions.size());
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t l = 0; l < solutions.size(); ++l) values[l] = solutions[l][from + t];
    by_term.push_back(coefficients_of(values));
  }
  std::size_t kept = solutions.size();
  for (double dropped = 0.0; kept > 1; --kept) {
    for (const auto& coefficients : by_term) dropped += std::abs(coefficients[kept - 1]);
    if (dropped > negligible) break;
  }
  ChebyshevSum sum{degree, static_cast<int>(kept), 1.0F, {}};
  double largest = 0.0;
  for (const auto& coefficients : by_term)
    for (const double c : coefficients) largest = std::max(largest, std::abs(c));
  if (!std::isfinite(largest)) return {};
  // The rounding of several hundred coefficients stays far below what is negligible, and float holds all multiples.
  const double step = std::exp2(std::floor(std::log2(std::max(negligible / 64.0, largest * 0x1p-23))));
  sum.step = static_cast<float>(step);
  for (std::size_t l = 0; l < kept; ++l)
    for (const auto& coefficients : by_term)
      sum.coefficients.push_back(static_cast<float>(step * std::round(coefficients[l] / step)));
  return sum;
}

using ValueOf = std::function<double(const RayTable& table, std::size_t ray)>;

ChebyshevSum fitted_sum(Systems& systems, int degree, int step, const ValueOf& value, double negligible) {
  const FitRays& rays = systems.rays();
  const auto& [used, weight] = systems.weighted();
  const LeastSquares& system = systems.scalars(degree);
  std::vector<std::vector<double>> solutions;
  std::vector<double> right(used.size());
  for (std::size_t l = 0; l < rays.tables.size(); l += static_cast<std::size_t>(step)) {
    for (std::size_t k = 0; k < right.size(); ++k) right[k] = weight[k] * value(rays.tables[l], used[k]);
    solutions.push_back(system.solve(right));
  }
  return assembled(degree, solutions, 0, negligible);
}

ChebyshevVector fitted_vector(Systems& systems, int degree, const ValueOf& x, const ValueOf& y, double negligible) {
  const FitRays& rays = systems.rays();
  const auto& [used, weight] = systems.weighted();
  const LeastSquares& system = systems.vectors(degree);
  std::vector<std::vector<double>> solutions;
  std::vector<double> right(2 * used.size());
  for (std::size_t l = 0; l < rays.tables.size(); l += kWavelengthStep) {
    for (std::size_t k = 0; k < used.size(); ++k) {
      right[2 * k] = weight[k] * x(rays.tables[l], used[k]);
      right[2 * k + 1] = weight[k] * y(rays.tables[l], used[k]);
    }
    solutions.push_back(system.solve(right));
  }
  return {assembled(degree, solutions, 0, negligible),
          assembled(degree, solutions, static_cast<std::size_t>(term_count(degree)), negligible)};
}

// The errors that a polynomial should have, up to which higher degrees are tried, and those up to which it is accepted.
struct Tolerated {
  double target = 0.0, accepted = 0.0;
};

// True if higher degrees cannot be expected to bring an error down to the accepted one, even if each of them lowers it
// by twice as much as the last one did.
bool is_hopeless(double p95, double before, int degrees_left, double accepted) {
  constexpr double kBetterThanBefore = 0.5;
  return p95 * std::pow(kBetterThanBefore * p95 / before, degrees_left) > accepted;
}

// The polynomial of the lowest degree whose errors reach the target, or else the best one.
template <class Polynomial, class Fit, class Errors>
double raise_degree(const Systems& systems, int max_degree, const Tolerated& tolerated, Polynomial& best,
                    const Fit& fit, const Errors& errors) {
  double best_p95 = std::numeric_limits<double>::infinity();
  for (int degree = kMinDegree; degree <= max_degree && systems.has_enough_rays(degree); ++degree) {
    Polynomial tried = fit(degree);
    const double p95 = quantile(errors(tried), 0.95);
    if (!(p95 < best_p95)) continue;  // not a number, too
    const bool stops = p95 <= tolerated.target || is_hopeless(p95, best_p95, max_degree - degree, tolerated.accepted);
    best_p95 = p95;
    best = std::move(tried);
    if (stops) break;
  }
  return best_p95;
}

double flux_mm2(const PolynomialZone& zone, const FitRays& rays) {
  const RayTable& middle = rays.middle();
  double sum = 0.0, weights = 0.0;
  for (std::size_t f = 0; f < zone.bounds.size(); ++f) {
    const double field = zone.bounds[f].field;
    const double weight = std::sin(std::numbers::pi * (static_cast<double>(f) + 0.5) /
                                   static_cast<double>(zone.bounds.size()));  // Lobatto points are denser at both ends
    weights += weight;
    for (std::size_t k = 0; k < rays.starts.size(); ++k)
      if (rays.starts[k].field == field && middle.clearance(k) <= 1.0)
        sum += weight * rays.starts[k].area_mm2 * middle.transmission[k] / std::sqrt(1.0 + field * field);
  }
  return sum / weights;
}

constexpr double kFractionOfEdge = 0.3, kFractionOfTransmittance = 0.25;  // targets, of the tolerances
constexpr double kNegligible = 0.5;  // of a target: wavelength terms that are left out

// Fits all outputs; returns whether they are accurate enough.
bool fit_outputs(const ZoneProblem& problem, const FitRays& rays, const ZoneCheck& check, PolynomialZone& zone) {
  const PolynomialOptions& options = problem.options;
  Systems light(rays, rays.for_light), edges(rays, rays.for_edges);
  const int max_degree = (options.max_order - 1) / 2;
  const double pixel_mm = problem.lens.pixel_mm, target_mm = options.target_px * pixel_mm;
  PolynomialAccuracy& accuracy = zone.accuracy;
  raise_degree(
      light, max_degree, {target_mm, options.position_px * pixel_mm}, zone.sensor_mm,
      [&](int degree) {
        return fitted_vector(
            light, degree, [](const RayTable& t, std::size_t k) { return t.sensor_x_mm[k]; },
            [](const RayTable& t, std::size_t k) { return t.sensor_y_mm[k]; }, kNegligible * target_mm);
      },
      [&](const ChebyshevVector& sensor) { return check.position_errors_mm(sensor); });
  const std::vector<double> errors_mm = check.position_errors_mm(zone.sensor_mm);
  accuracy.position_p50_px = quantile(errors_mm, 0.5) / pixel_mm;
  accuracy.position_p95_px = quantile(errors_mm, 0.95) / pixel_mm;
  accuracy.position_max_px = quantile(errors_mm, 1.0) / pixel_mm;
  zone.order = 2 * zone.sensor_mm.along_field.degree + 1;
  if (!(accuracy.position_p95_px <= options.position_px)) return false;
  const double edge_target = kFractionOfEdge * options.edge;
  for (std::size_t c = 0; c < rays.middle().stop.size(); ++c) {
    const auto axis = [c](std::size_t of) {
      return [c, of](const RayTable& t, std::size_t k) { return t.stop[c][of][k]; };
    };
    const double p95 = raise_degree(
        edges, max_degree, {edge_target, options.edge}, zone.stop.emplace_back(),
        [&](int degree) { return fitted_vector(edges, degree, axis(0), axis(1), kNegligible * edge_target); },
        [&](const ChebyshevVector& stop) { return check.stop_errors(stop, c); });
    accuracy.edge_p95 = std::max(accuracy.edge_p95, p95);
  }
  const RayTable for_rims =
      problem.rays.trace(starts_within(zone.bounds, kRimRaysAtField, 1), wavelength_at(problem.lens, 0.0));
  for (const int step : blocking_steps(for_rims)) {
    PolynomialRim& rim = zone.rims.emplace_back(PolynomialRim{step, {}});
    const double p95 = raise_degree(
        edges, max_degree, {edge_target, options.edge}, rim.squared,
        [&](int degree) {
          const auto value = [step](const RayTable& t, std::size_t k) {
            return t.rim_squared[static_cast<std::size_t>(step)][k];
          };
          return fitted_sum(edges, degree, kWavelengthStep, value, kNegligible * edge_target);
        },
        [&](const ChebyshevSum& squared) { return check.rim_errors(squared, step); });
    accuracy.edge_p95 = std::max(accuracy.edge_p95, p95);
  }
  if (!(accuracy.edge_p95 <= options.edge)) return false;
  const double largest = *std::ranges::max_element(rays.middle().transmission);
  const double transmittance_target = kFractionOfTransmittance * options.transmittance;
  accuracy.transmittance_p95 = raise_degree(
      light, max_degree, {transmittance_target, options.transmittance}, zone.transmittance,
      [&](int degree) {
        const auto value = [](const RayTable& t, std::size_t k) { return t.transmission[k]; };
        return fitted_sum(light, degree, 1, value, kNegligible * transmittance_target * largest);
      },
      [&](const ChebyshevSum& transmittance) { return check.transmittance_errors(transmittance); });
  return accuracy.transmittance_p95 <= options.transmittance && !check.admits_blocked_light(problem.lens, zone);
}

}  // namespace

PolynomialZone fit_zone(const ZoneProblem& problem, double field_low, double field_high) {
  PolynomialZone zone;
  zone.field_low = field_low;
  zone.field_high = field_high;
  const double low = field_low * field_low, high = field_high * field_high;
  for (int k = 0; k < kFields; ++k)
    zone.bounds.push_back(problem.rays.bounds(std::sqrt(low + 0.5 * (high - low) * (1.0 - lobatto(k, kFields)))));
  if (std::ranges::none_of(zone.bounds, has_light)) {
    zone.bounds.clear();
    return zone;
  }
  set_pupil_coordinates(zone);
  const FitRays rays = fit_rays(problem, zone);
  zone.flux_mm2 = flux_mm2(zone, rays);
  const ZoneCheck check(problem.lens, problem.rays, zone, problem.sensor_half_mm);
  zone.accuracy.rays = check.rays();
  if (fit_outputs(problem, rays, check, zone)) {
    zone.state = PolynomialZone::State::Fitted;
    return zone;
  }
  PolynomialZone traced;
  traced.state = PolynomialZone::State::Traced;
  traced.field_low = field_low;
  traced.field_high = field_high;
  traced.accuracy = zone.accuracy;
  traced.flux_mm2 = zone.flux_mm2;
  return traced;
}

}  // namespace contrejour::inline internal::polynomial
