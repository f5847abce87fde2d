// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "optics/glass/formulas.h"

namespace contrejour::inline internal {
namespace {

struct Points {
  std::span<const double> pairs;
  [[nodiscard]] std::size_t size() const { return pairs.size() / 2; }
  [[nodiscard]] double x(std::size_t k) const { return pairs[2 * k]; }
  [[nodiscard]] double y(std::size_t k) const { return pairs[2 * k + 1]; }
  [[nodiscard]] double secant(std::size_t k) const { return (y(k + 1) - y(k)) / (x(k + 1) - x(k)); }
};

// Fritsch & Butland 1984, eq. 5 with the weights of their eq. 6: 0 at an extremum, else a weighted harmonic mean.
double inner_slope(const Points& p, std::size_t k) {
  const double before = p.secant(k - 1);
  const double after = p.secant(k);
  if (!(before * after > 0.0)) return 0.0;
  const double h0 = p.x(k) - p.x(k - 1);
  const double h1 = p.x(k + 1) - p.x(k);
  const double w = (h0 + 2.0 * h1) / (3.0 * (h0 + h1));
  return before * after / (w * after + (1.0 - w) * before);
}

// The slope at an end: that of the parabola through three points, limited so that the piece stays monotone.
double end_slope(double near, double far, double h_near, double h_far) {
  const double slope = ((2.0 * h_near + h_far) * near - h_near * far) / (h_near + h_far);
  if (!(slope * near > 0.0)) return 0.0;
  return near * far <= 0.0 && std::abs(slope) > 3.0 * std::abs(near) ? 3.0 * near : slope;
}

double slope(const Points& p, std::size_t k) {
  const std::size_t last = p.size() - 1;
  if (p.size() == 2) return p.secant(0);
  if (k == 0) return end_slope(p.secant(0), p.secant(1), p.x(1) - p.x(0), p.x(2) - p.x(1));
  if (k == last) {
    return end_slope(p.secant(last - 1), p.secant(last - 2), p.x(last) - p.x(last - 1), p.x(last - 1) - p.x(last - 2));
  }
  return inner_slope(p, k);
}

}  // namespace

double table_value(std::span<const double> points, double x) {
  const Points p{points};
  if (p.size() == 0) return std::nan("");
  const std::size_t last = p.size() - 1;
  if (x <= p.x(0)) return p.y(0);
  if (x >= p.x(last)) return p.y(last);
  if (!(x > p.x(0))) return std::nan("");
  std::size_t low = 0, high = last;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (p.x(middle) <= x ? low : high) = middle;
  }
  const double h = p.x(high) - p.x(low);
  const double t = (x - p.x(low)) / h;
  // Cubic Hermite.
  const double s = 1.0 - t;
  return s * s * (1.0 + 2.0 * t) * p.y(low) + t * t * (3.0 - 2.0 * t) * p.y(high) +
         h * s * t * (s * slope(p, low) - t * slope(p, high));
}

}  // namespace contrejour::inline internal
