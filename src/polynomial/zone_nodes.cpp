// SPDX-License-Identifier: Apache-2.0
#include "polynomial/zone_nodes.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "polynomial/chebyshev_basis.h"
#include "polynomial/least_squares.h"
#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr double kRoom = 1.02;  // of the pupil radius, around the bounds
constexpr std::size_t kSmoothTerms = 3;  // of a pupil coordinate's polynomial over the nodes

// The numbers of a zone that are interpolated between nodes.
constexpr std::array kFrame{&PolynomialZone::field_low,       &PolynomialZone::field_high, &PolynomialZone::centre_mm,
                            &PolynomialZone::centre_slope_mm, &PolynomialZone::radius_mm,  &PolynomialZone::flux_mm2};

// Bounds in pupil coordinates.
struct PupilBounds {
  double low_x = 0.0, high_x = 0.0, half_y = 0.0;

  [[nodiscard]] double farthest() const { return std::hypot(std::max(std::abs(low_x), std::abs(high_x)), half_y); }
};

PupilBounds pupil_bounds(const PolynomialZone& zone, const PolynomialBounds& bounds) {
  const double centre = centre_at(zone, bounds.field);
  return {(bounds.low_x_mm - centre) / zone.radius_mm, (bounds.high_x_mm - centre) / zone.radius_mm,
          bounds.half_y_mm / zone.radius_mm};
}

PolynomialBounds bounds_in_mm(const PolynomialZone& zone, double field, const PupilBounds& pupil) {
  const double centre = centre_at(zone, field);
  return {static_cast<float>(field), static_cast<float>(centre + zone.radius_mm * pupil.low_x),
          static_cast<float>(centre + zone.radius_mm * pupil.high_x),
          static_cast<float>(zone.radius_mm * pupil.half_y)};
}

bool is_lit(const PolynomialZone& zone) { return std::ranges::any_of(zone.bounds, has_light); }

// Replaces a value of the zones by a polynomial of low degree through those of the zones with light.
void smooth(std::span<PolynomialZone> zones, double PolynomialZone::* value) {
  const auto lit = static_cast<std::size_t>(std::ranges::count_if(zones, is_lit));
  const std::size_t terms = std::min({kSmoothTerms, lit, zones.size()});
  const auto count = static_cast<int>(zones.size());
  Rows rows{terms, {}};
  std::vector<double> right;
  std::array<double, kSmoothTerms> t{};
  for (int n = 0; n < count; ++n) {
    const PolynomialZone& zone = zones[static_cast<std::size_t>(n)];
    if (!is_lit(zone)) continue;
    chebyshev_values(node_coordinate(n, count), t);
    rows.values.insert(rows.values.end(), t.begin(), t.begin() + static_cast<std::ptrdiff_t>(terms));
    right.push_back(zone.*value);
  }
  const std::vector<double> solution = LeastSquares(rows, 0.0).solve(right);
  for (int n = 0; n < count; ++n) {
    chebyshev_values(node_coordinate(n, count), t);
    double sum = 0.0;
    for (std::size_t k = 0; k < terms; ++k) sum += solution[k] * t[k];
    zones[static_cast<std::size_t>(n)].*value = sum;
  }
}

double weighted(std::span<const PolynomialZone> nodes, std::span<const double> weights,
                double PolynomialZone::* value) {
  double sum = 0.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) sum += weights[n] * nodes[n].*value;
  return sum;
}

// The smallest bounds in pupil coordinates at one field that contain those of all states with light there.
std::optional<PupilBounds> common_bounds(std::span<const PolynomialZone> zones, std::size_t field) {
  std::optional<PupilBounds> common;
  for (const PolynomialZone& zone : zones) {
    if (!has_light(zone.bounds[field])) continue;
    const PupilBounds own = pupil_bounds(zone, zone.bounds[field]);
    if (!common) common = own;
    *common = {std::min(common->low_x, own.low_x), std::max(common->high_x, own.high_x),
               std::max(common->half_y, own.half_y)};
  }
  return common;
}

}  // namespace

double node_coordinate(int node, int count) {
  return count == 1 ? 0.0 : std::cos(std::numbers::pi * node / (count - 1));
}

std::vector<double> node_weights(int count, double coordinate) {
  std::vector<double> weights;
  double sum = 0.0;
  for (int n = 0; n < count; ++n) {
    const double apart = coordinate - node_coordinate(n, count);
    if (std::abs(apart) < 1e-14) {
      weights.assign(static_cast<std::size_t>(count), 0.0);
      weights[static_cast<std::size_t>(n)] = 1.0;
      return weights;
    }
    const bool is_end = n == 0 || n == count - 1;
    weights.push_back((n % 2 == 0 ? 1.0 : -1.0) * (is_end ? 0.5 : 1.0) / apart);
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

void set_pupil_coordinates(PolynomialZone& zone) {
  double ff = 0.0, fg = 0.0, gg = 0.0, fm = 0.0, gm = 0.0;  // least squares over the fields with light
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

void align_pupils(std::span<PolynomialZone> zones, std::span<const BoundsBetween> between) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const PolynomialZone& zone : zones)
    if (is_lit(zone)) smallest = std::min(smallest, zone.radius_mm);
  for (double PolynomialZone::* const value :
       {&PolynomialZone::centre_mm, &PolynomialZone::centre_slope_mm, &PolynomialZone::radius_mm})
    smooth(zones, value);
  // A polynomial through few radii can fall below all of them at a node without light.
  for (PolynomialZone& zone : zones) zone.radius_mm = std::max(zone.radius_mm, 0.5 * smallest);
  std::vector<PolynomialZone> all(zones.begin(), zones.end());
  for (const BoundsBetween& state : between) {
    PolynomialZone& zone = all.emplace_back();
    for (double PolynomialZone::* const value : kFrame) zone.*value = weighted(zones, state.weights, value);
    zone.bounds = state.bounds;
  }
  const std::size_t fields = zones.front().bounds.size();
  double farthest = 0.0;
  for (std::size_t f = 0; f < fields; ++f)
    if (const auto common = common_bounds(all, f)) farthest = std::max(farthest, common->farthest());
  for (PolynomialZone& zone : all) zone.radius_mm *= kRoom * farthest;
  for (PolynomialZone& zone : zones) zone.radius_mm *= kRoom * farthest;
  for (std::size_t f = 0; f < fields; ++f) {
    const auto common = common_bounds(all, f);
    if (!common) continue;
    for (PolynomialZone& zone : zones) zone.bounds[f] = bounds_in_mm(zone, zone.bounds[f].field, *common);
  }
}

ChebyshevSum interpolated(std::span<const ChebyshevSum> nodes, std::span<const double> weights) {
  if (nodes.size() == 1) return nodes.front();
  ChebyshevSum out = nodes.front();
  for (const ChebyshevSum& node : nodes) {
    if (node.degree != out.degree) return {};
    out.wavelength_terms = std::max(out.wavelength_terms, node.wavelength_terms);
    out.step = std::min(out.step, node.step);
  }
  const std::size_t count =
      static_cast<std::size_t>(term_count(out.degree)) * static_cast<std::size_t>(out.wavelength_terms);
  std::vector<double> sums(out.degree < 0 ? 0 : count, 0.0);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (std::size_t k = 0; k < nodes[n].coefficients.size(); ++k)
      sums[k] += weights[n] * static_cast<double>(nodes[n].coefficients[k]);
  out.coefficients.assign(sums.begin(), sums.end());
  // Multiples of the step, as in files.
  double largest = 0.0;
  for (const double c : sums) largest = std::max(largest, std::abs(c));
  while (largest > 0x1p23 * static_cast<double>(out.step)) out.step *= 2.0F;
  for (float& c : out.coefficients) c = out.step * std::round(c / out.step);
  return out;
}

ChebyshevVector interpolated(std::span<const ChebyshevVector> nodes, std::span<const double> weights) {
  std::vector<ChebyshevSum> along_field, along_pupil;
  for (const ChebyshevVector& node : nodes) {
    along_field.push_back(node.along_field);
    along_pupil.push_back(node.along_pupil);
  }
  return {interpolated(along_field, weights), interpolated(along_pupil, weights)};
}

PolynomialZone zone_frame(std::span<const PolynomialZone> nodes, std::span<const double> weights) {
  PolynomialZone zone;
  const PolynomialZone& first = nodes.front();
  zone.state = first.state;
  zone.order = first.order;
  zone.accuracy = first.accuracy;
  if (nodes.size() == 1) zone.bounds = first.bounds;
  zone.pupil_end = first.pupil_end;
  for (double PolynomialZone::* const value :
       {&PolynomialZone::field_low, &PolynomialZone::field_high, &PolynomialZone::centre_mm,
        &PolynomialZone::centre_slope_mm, &PolynomialZone::radius_mm, &PolynomialZone::flux_mm2})
    zone.*value = weighted(nodes, weights, value);
  zone.flux_mm2 = std::max(zone.flux_mm2, 0.0);
  if (nodes.size() == 1) return zone;
  for (std::size_t f = 0; f < first.bounds.size(); ++f) {
    double field = 0.0;
    for (std::size_t n = 0; n < nodes.size(); ++n) field += weights[n] * static_cast<double>(nodes[n].bounds[f].field);
    zone.bounds.push_back(has_light(first.bounds[f]) ? bounds_in_mm(zone, field, pupil_bounds(first, first.bounds[f]))
                                                     : PolynomialBounds{static_cast<float>(field), 0.0F, 0.0F, 0.0F});
  }
  return zone;
}

PolynomialZone zone_between(std::span<const PolynomialZone> nodes, std::span<const double> weights) {
  PolynomialZone zone = zone_frame(nodes, weights);
  const auto between = [&](const auto& of) {
    std::vector<std::decay_t<decltype(of(nodes.front()))>> all;
    for (const PolynomialZone& node : nodes) all.push_back(of(node));
    return interpolated(all, weights);
  };
  zone.sensor_mm = between([](const PolynomialZone& node) { return node.sensor_mm; });
  for (std::size_t c = 0; c < nodes.front().stop.size(); ++c)
    zone.stop.push_back(between([c](const PolynomialZone& node) { return node.stop[c]; }));
  for (std::size_t r = 0; r < nodes.front().rims.size(); ++r)
    zone.rims.push_back(
        {nodes.front().rims[r].step, between([r](const PolynomialZone& node) { return node.rims[r].squared; })});
  zone.transmittance = between([](const PolynomialZone& node) { return node.transmittance; });
  return zone;
}

}  // namespace contrejour::inline internal::polynomial
