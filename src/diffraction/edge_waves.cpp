// SPDX-License-Identifier: Apache-2.0
#include "diffraction/edge_waves.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "base/scalar.h"
#include "diffraction/special_functions.h"

namespace contrejour::inline internal {
namespace {

constexpr double kFlatPhase = 0.1;     // rad: an arc with a smaller phase from its curvature is straight
constexpr double kUniformEnd = 2.5;    // Fresnel's u from which on the asymptotic form is faded in,
constexpr double kAsymptoticFrom = 4.0;  // and from which on it is used alone: the spectrum blurs the fringes there
constexpr double kSpectralBlur = 0.15;   // half the visible spectrum's width over its middle, for one channel
constexpr double kFarPhase = 14.0;       // rad, a straight edge's q from which on sinc^2 is its mean
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kStepU = 0.5;         // of Fresnel's u in an average over directions
constexpr int kMaxSteps = 16;

double wrap(double angle, double period) { return angle - period * std::round(angle / period); }

}  // namespace

EdgeWaves::EdgeWaves(const IrisOpening& opening) {
  for (const IrisEdge& edge : opening.edges()) {
    if (edge.bound.straight()) {
      outline_.push_back(
          {0.0, length(edge.end - edge.start), std::atan2(edge.bound.normal.y, edge.bound.normal.x), 0.0, false});
      continue;
    }
    const Vec2 from = edge.start - edge.bound.centre, to = edge.end - edge.bound.centre;
    const double first = std::atan2(from.y, from.x);
    double span = std::atan2(to.y, to.x) - first;
    if (span <= 0.0) span += 2.0 * kPi;
    outline_.push_back(
        {edge.bound.radius, edge.bound.radius * span, first + 0.5 * span, 0.5 * span, opening.edges().size() == 1});
  }
}

std::vector<double> EdgeWaves::end_normals() const {
  std::vector<double> normals;
  for (const Outline& o : outline_) {
    if (o.full_circle) continue;
    normals.push_back(o.normal_middle_rad - o.half_span_rad);
    if (o.half_span_rad > 0.0) normals.push_back(o.normal_middle_rad + o.half_span_rad);
  }
  return normals;
}

EdgeWaves::Direction EdgeWaves::along(double direction_rad, double window_rad) const {
  Direction direction;
  direction.window_rad_ = window_rad;
  for (const Outline& o : outline_) {
    // u and -u give the same power: take the one nearer to the middle normal.
    const double middle = wrap(o.normal_middle_rad - direction_rad, kPi);
    if (o.radius == 0.0 || o.full_circle) {
      direction.add({o.radius, o.length, middle - o.half_span_rad, middle + o.half_span_rad, 0, 0, o.full_circle});
      continue;
    }
    // Splits the arc into pieces that belong to u or -u alone: they meet at a normal perpendicular to u, which
    // diffracts nothing along u.
    const double last = middle + o.half_span_rad;
    for (double first = middle - o.half_span_rad; first < last;) {
      const double turn = kPi * std::round(first / kPi);
      double end = turn + 0.5 * kPi;
      if (!(end > first)) end += kPi;
      end = std::min(end, last);
      const double centre = kPi * std::round(0.5 * (first + end) / kPi);
      direction.add({o.radius, o.radius * (end - first), first - centre, end - centre});
      first = end;
    }
  }
  direction.constant_ += direction.corner_terms();
  return direction;
}

void EdgeWaves::Direction::add(Edge edge) {
  edge.cot_start = -1.0 / std::tan(edge.tau_start);
  edge.cot_end = -1.0 / std::tan(edge.tau_end);
  find_far(edge, window_rad_);
  edges_.push_back(edge);
  far_from_ = std::max(far_from_, edge.far_from);
  constant_ += edge.constant;
  slope_ += edge.slope;
}

// Finds the k from which on the special functions below have their asymptotic forms.
void EdgeWaves::Direction::find_far(Edge& edge, double window_rad) {
  if (edge.full_circle) {
    edge.slope = 4.0 * kPi * edge.radius;  // two stationary points
    return;
  }
  edge.constant = square(edge.cot_start) + square(edge.cot_end);
  if (edge.radius == 0.0) {
    const double tau = edge.tau_start;
    const double per_k = 0.5 * edge.length * (std::abs(std::sin(tau)) - 0.5 * std::cos(tau) * window_rad);
    edge.far_from = per_k > 0.0 ? kFarPhase / per_k : kNever;
    return;
  }
  if (edge.tau_start < 0.0 && edge.tau_end > 0.0) edge.slope += 2.0 * kPi * edge.radius;
  const double nearest = std::min(std::abs(edge.tau_start), std::abs(edge.tau_end)) - 0.5 * window_rad;
  const double sine = std::sin(0.5 * std::clamp(nearest, 0.0, kPi));
  const double bends = 8.0 * kFlatPhase * edge.radius / square(edge.length);  // below this k the edge counts as
                                                                              // straight
  edge.far_from = sine > 0.0 ? std::max(bends, square(kAsymptoticFrom / sine) * kPi / (4.0 * edge.radius)) : kNever;
}

// k^4 |E|^2 = (k L cos(tau) sinc(q))^2, q = k L sin(tau) / 2 (Komrska 1982), averaged over q.
double EdgeWaves::Direction::straight_power(const Edge& edge, double k, double window_rad) {
  const double tau = 0.5 * (edge.tau_start + edge.tau_end);
  const double q = 0.5 * k * edge.length * std::sin(tau);
  // The spectrum blurs fringes beyond the spike's middle, even for a narrow window.
  const double blur = std::clamp(kSpectralBlur * std::abs(q), 1e-3, 0.5 * kPi);
  const double h = std::max(0.25 * k * edge.length * std::abs(std::cos(tau)) * window_rad, blur);
  const double average = (integral_of_sinc_squared(q + h) - integral_of_sinc_squared(q - h)) / (2.0 * h);
  return square(k * edge.length * std::cos(tau)) * average;
}

// With s the arc's angle from the direction, phase k R cos(s) = k R - (pi / 2) u^2, u = sqrt(4 k R / pi) sin(s / 2).
double EdgeWaves::Direction::arc_power(const Edge& edge, double k, double window_rad) {
  const double per_sine = std::sqrt(4.0 * k * edge.radius / kPi);
  const double stationary = 2.0 * kPi * k * edge.radius;
  const double du = 0.5 * per_sine * window_rad;
  const auto u_of = [&](double tau) { return per_sine * std::sin(0.5 * std::clamp(tau, -kPi, kPi)); };
  const auto at = [&](double shift) {
    const double start = u_of(edge.tau_start + shift), end = u_of(edge.tau_end + shift);
    const double nearest = std::min(std::abs(start), std::abs(end));
    double uniform = 0.0, asymptotic = 0.0;
    if (nearest < kAsymptoticFrom) {
      const FresnelIntegrals a = fresnel_integrals(start), b = fresnel_integrals(end);
      uniform = 0.5 * stationary * (square(b.c - a.c) + square(b.s - a.s));
    }
    if (nearest > kUniformEnd)
      asymptotic = (start < 0.0 && end > 0.0 ? stationary : 0.0) + std::min(square(edge.cot_start), stationary) +
                   std::min(square(edge.cot_end), stationary);
    const double t = smooth_step((nearest - kUniformEnd) / (kAsymptoticFrom - kUniformEnd));
    return (1.0 - t) * uniform + t * asymptotic;
  };
  const double start = u_of(edge.tau_start), end = u_of(edge.tau_end);
  const bool near_end = std::min(std::abs(start), std::abs(end)) < kAsymptoticFrom + du;
  const int steps = near_end ? std::clamp(static_cast<int>(std::ceil(du / kStepU)), 1, kMaxSteps) : 1;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += at(window_rad * ((i + 0.5) / steps - 0.5));
  return sum / steps;
}

double EdgeWaves::Direction::edge_power(const Edge& edge, double k, double window_rad) {
  if (k >= edge.far_from) return edge.constant + edge.slope * k;
  if (edge.radius == 0.0 || k * square(edge.length) < 8.0 * kFlatPhase * edge.radius)
    return straight_power(edge, k, window_rad);
  const bool inside = edge.tau_start < 0.0 && edge.tau_end > 0.0;
  return arc_power(edge, k, window_rad) + k * (edge.slope - (inside ? 2.0 * kPi * edge.radius : 0.0));
}

// The terms of corners besides the squares of their edges' ends.
double EdgeWaves::Direction::corner_terms() const {
  double sum = 0.0;
  for (std::size_t j = 0; edges_.size() > 1 && j < edges_.size(); ++j)
    sum -= 2.0 * edges_[j].cot_end * edges_[(j + 1) % edges_.size()].cot_start;
  return sum;
}

// Arcs that meet nearly without a corner may both end near the direction. Then the cross term is 2 Re(A conj(B)) of
// their Fresnel integrals, with phases relative to the corner, so that arcs of one circle together equal the circle
// without ends.
EdgeWaves::Direction::Joined EdgeWaves::Direction::joined_arcs(const Edge& before, const Edge& after, double k,
                                                               double window_rad) {
  const auto is_arc = [&](const Edge& e) {
    return e.radius > 0.0 && !e.full_circle && k < e.far_from && k * square(e.length) >= 8.0 * kFlatPhase * e.radius;
  };
  if (!is_arc(before) || !is_arc(after)) return {};
  const double scale_before = std::sqrt(4.0 * k * before.radius / kPi),
               scale_after = std::sqrt(4.0 * k * after.radius / kPi);
  const auto u_of = [](double scale, double tau) { return scale * std::sin(0.5 * std::clamp(tau, -kPi, kPi)); };
  const double farther =
      std::max(std::abs(u_of(scale_before, before.tau_end)), std::abs(u_of(scale_after, after.tau_start)));
  // For an arc so short that its other end is as near, that end's neighbour would have to be included as well.
  const double shorter = std::min(scale_before * 0.5 * (before.tau_end - before.tau_start),
                                  scale_after * 0.5 * (after.tau_end - after.tau_start));
  constexpr double kFade = kAsymptoticFrom - kUniformEnd;
  const double weight =
      std::min(smooth_step((kAsymptoticFrom - farther) / kFade), smooth_step((shorter - kUniformEnd) / kFade));
  if (!(weight > 0.0)) return {};
  const double du = 0.5 * std::max(scale_before, scale_after) * window_rad;
  const int steps = std::clamp(static_cast<int>(std::ceil(du / kStepU)), 1, kMaxSteps);
  const auto wave = [&](double from, double to, double corner) {
    const FresnelIntegrals a = fresnel_integrals(from), b = fresnel_integrals(to);
    return std::complex<double>(b.c - a.c, b.s - a.s) * std::polar(1.0, -0.5 * kPi * square(corner));
  };
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double shift = window_rad * ((i + 0.5) / steps - 0.5);
    const double end = u_of(scale_before, before.tau_end + shift), start = u_of(scale_after, after.tau_start + shift);
    sum += std::real(wave(u_of(scale_before, before.tau_start + shift), end, end) *
                     std::conj(wave(start, u_of(scale_after, after.tau_end + shift), start)));
  }
  return {2.0 * kPi * k * std::sqrt(before.radius * after.radius) * sum / steps, weight};
}

// Corners: |sum of both edges' ends|^2, without what oscillates (Komrska 1982 eq. 10, averaged). Near an edge's normal
// the cotangent diverges, but the wave does not: there the edge's own power bounds the term.
double EdgeWaves::Direction::power(double k) const {
  const double per_k4 = 1.0 / square(square(k));
  if (k >= far_from_) return (constant_ + slope_ * k) * per_k4;
  double sum = 0.0, last_bound = 0.0, first_bound = 0.0;
  const auto corner = [&](const Edge& before, double bound_before, const Edge& after, double bound_after) {
    const Joined joined = joined_arcs(before, after, k, window_rad_);
    const double cotangents = std::clamp(before.cot_end, -bound_before, bound_before) *
                              std::clamp(after.cot_start, -bound_after, bound_after);
    return joined.weight * joined.power - (1.0 - joined.weight) * 2.0 * cotangents;
  };
  for (std::size_t j = 0; j < edges_.size(); ++j) {
    const Edge& edge = edges_[j];
    const double own = edge_power(edge, k, window_rad_);
    const double bound = k >= edge.far_from ? kNever : std::sqrt(own);
    sum += own;
    if (j == 0) first_bound = bound;
    if (j > 0) sum += corner(edges_[j - 1], last_bound, edge, bound);
    last_bound = bound;
  }
  if (edges_.size() > 1) sum += corner(edges_.back(), last_bound, edges_.front(), first_bound);
  return std::max(sum, 0.0) * per_k4;
}

}  // namespace contrejour::inline internal
