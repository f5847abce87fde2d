// SPDX-License-Identifier: Apache-2.0
#include "polynomial/direct_evaluate.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::polynomial {
namespace {

// h_i da + p_i db for both components: how a vector h A + p B changes with A and B.
Vec2 changed(Vec2 h, double a, Vec2 p, double b) { return h * a + p * b; }

Vec2 solved(const Derivative2& matrix, Vec2 right) {
  return Vec2{cross(right, matrix.by_y), cross(matrix.by_x, right)} * (1.0 / matrix.determinant());
}

// The unit vector to the scene with these x and y; none for vectors longer than 1.
std::optional<Vec3> to_scene(Vec2 xy) {
  const double rest = 1.0 - dot(xy, xy);
  if (!(rest > 0.0)) return std::nullopt;
  return Vec3{xy.x, xy.y, -std::sqrt(rest)};
}

// How far the ray from a sensor point passes a point of the scene by, as a difference of unit vectors' x and y, and how
// this changes with the sensor point.
struct Miss {
  Vec2 by;
  Derivative2 change;
};
std::optional<Miss> miss_at(const DirectPolynomials& polynomials, const ScenePoint& point, const DirectPoint& at) {
  const VectorAt origin = at.at(polynomials.origin_mm), direction = at.at(polynomials.direction);
  const double w = point.distant ? 0.0 : 1.0;
  const Vec3 from{w * origin.value.x, w * origin.value.y, w * polynomials.front_z_mm};
  const double distance = length(point.at_mm - from);
  if (!(distance > 0.0)) return std::nullopt;
  const Vec3 to = (point.at_mm - from) * (1.0 / distance);
  // The derivative of a unit vector: the part of the change across it, over the distance.
  const auto turned = [&](Vec2 moved) {
    const double along = to.x * moved.x + to.y * moved.y;
    return Vec2{to.x * along - moved.x, to.y * along - moved.y} * (w / distance);
  };
  return Miss{{to.x - direction.value.x, to.y - direction.value.y},
              {turned(origin.by_sensor.by_x) - direction.by_sensor.by_x,
               turned(origin.by_sensor.by_y) - direction.by_sensor.by_y}};
}

}  // namespace

double direct_wavelength(const DirectPolynomials& polynomials, double lambda_nm) {
  const double at = 1.0 / (lambda_nm * lambda_nm), low = 1.0 / (polynomials.longest_nm * polynomials.longest_nm),
               high = 1.0 / (polynomials.shortest_nm * polynomials.shortest_nm);
  return (2.0 * at - low - high) / (high - low);
}

double direct_wavelength_nm(const DirectPolynomials& polynomials, double coordinate) {
  const double low = 1.0 / (polynomials.longest_nm * polynomials.longest_nm),
               high = 1.0 / (polynomials.shortest_nm * polynomials.shortest_nm);
  return 1.0 / std::sqrt(0.5 * (low + high + coordinate * (high - low)));
}

DirectPoint::Variable::Variable(double x) {
  values[0] = 1.0, values[1] = x;
  slopes[0] = 0.0, slopes[1] = 1.0;
  for (std::size_t k = 2; k < values.size(); ++k) {
    values[k] = 2.0 * x * values[k - 1] - values[k - 2];
    slopes[k] = 2.0 * values[k - 1] + 2.0 * x * slopes[k - 1] - slopes[k - 2];
  }
}

DirectPoint::DirectPoint(const DirectPolynomials& polynomials, Vec2 sensor_mm, Vec2 stop, double lambda_nm)
    : h_(sensor_mm * (1.0 / polynomials.max_height_mm)), p_(stop * (1.0 / DirectPolynomials::kMargin)),
      h_per_mm_(1.0 / polynomials.max_height_mm), u_(2.0 * dot(h_, h_) - 1.0), v_(dot(h_, p_)),
      w_(2.0 * dot(p_, p_) - 1.0) {
  chebyshev_values(direct_wavelength(polynomials, lambda_nm), wavelength_);
}

std::array<double, 4> DirectPoint::sum_at(const ChebyshevSum& sum) const {
  std::array<double, 4> out{};
  auto c = sum.coefficients.begin();
  for (std::size_t l = 0; l < static_cast<std::size_t>(sum.wavelength_terms); ++l) {
    for (int kv = 0; kv <= sum.degree; ++kv) {
      for (int kw = 0; kw <= sum.degree - kv; ++kw) {
        double along = 0.0, slope = 0.0;
        for (int ku = 0; ku <= sum.degree - kv - kw; ++ku, ++c) {
          along += static_cast<double>(*c) * u_.values[static_cast<std::size_t>(ku)];
          slope += static_cast<double>(*c) * u_.slopes[static_cast<std::size_t>(ku)];
        }
        const auto v = static_cast<std::size_t>(kv), w = static_cast<std::size_t>(kw);
        out[0] += wavelength_[l] * along * v_.values[v] * w_.values[w];
        out[1] += wavelength_[l] * slope * v_.values[v] * w_.values[w];
        out[2] += wavelength_[l] * along * v_.slopes[v] * w_.values[w];
        out[3] += wavelength_[l] * along * v_.values[v] * w_.slopes[w];
      }
    }
  }
  return out;
}

VectorAt DirectPoint::at(const ChebyshevVector& vector) const {
  const auto [a, a_u, a_v, a_w] = sum_at(vector.along_field);
  const auto [b, b_u, b_v, b_w] = sum_at(vector.along_pupil);
  // u = 2 h.h - 1, v = h.p, w = 2 p.p - 1.
  const auto by_h = [&](double h, double p) {
    return changed(h_, 4.0 * h * a_u + p * a_v, p_, 4.0 * h * b_u + p * b_v);
  };
  const auto by_p = [&](double h, double p) {
    return changed(h_, h * a_v + 4.0 * p * a_w, p_, h * b_v + 4.0 * p * b_w);
  };
  constexpr double kPerRadius = 1.0 / DirectPolynomials::kMargin;
  return {changed(h_, a, p_, b),
          {(by_h(h_.x, p_.x) + Vec2{a, 0.0}) * h_per_mm_, (by_h(h_.y, p_.y) + Vec2{0.0, a}) * h_per_mm_},
          {(by_p(h_.x, p_.x) + Vec2{b, 0.0}) * kPerRadius, (by_p(h_.y, p_.y) + Vec2{0.0, b}) * kPerRadius}};
}

}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

int order_of(const DirectPolynomials& polynomials) { return 2 * polynomials.direction.along_field.degree + 1; }

std::optional<DirectRay> direct_ray(const DirectPolynomials& polynomials, Vec2 sensor_mm, Vec2 stop, double lambda_nm) {
  if (!(length(sensor_mm) <= polynomials.max_height_mm && length(stop) <= DirectPolynomials::kMargin))
    return std::nullopt;
  const DirectPoint at(polynomials, sensor_mm, stop, lambda_nm);
  const auto direction = to_scene(at.at(polynomials.direction).value);
  if (!direction) return std::nullopt;
  const Vec2 origin = at.at(polynomials.origin_mm).value;
  DirectRay ray{{origin.x, origin.y, polynomials.front_z_mm}, *direction};
  double squared = 0.0;
  for (const PolynomialRim& rim : polynomials.rims) squared = std::max(squared, at.at(rim.squared));
  ray.relative_height = std::sqrt(squared);
  ray.transmittance = std::max(at.at(polynomials.transmittance), 0.0);
  ray.weight = std::abs(at.at(polynomials.inner).by_stop.determinant());
  return ray;
}

std::optional<Vec2> direct_sensor_point(const DirectPolynomials& polynomials, const ScenePoint& point, Vec2 stop,
                                        double lambda_nm) {
  constexpr int kMaxSteps = 12;
  constexpr double kConverged_mm = 1e-9, kLargestStep = 0.5;  // the latter of the largest height
  if (!(point.at_mm.z < (point.distant ? 0.0 : polynomials.front_z_mm))) return std::nullopt;
  if (!(length(stop) <= DirectPolynomials::kMargin)) return std::nullopt;
  Vec2 sensor;
  for (int k = 0; k < kMaxSteps; ++k) {
    const auto miss = miss_at(polynomials, point, DirectPoint(polynomials, sensor, stop, lambda_nm));
    if (!miss) return std::nullopt;
    Vec2 step = solved(miss->change, miss->by) * -1.0;
    const double size = length(step), largest = kLargestStep * polynomials.max_height_mm;
    if (!std::isfinite(size)) return std::nullopt;
    if (size > largest) step = step * (largest / size);
    sensor = sensor + step;
    const double height = length(sensor);
    if (size < kConverged_mm) {
      if (height > polynomials.max_height_mm) return std::nullopt;
      return sensor;
    }
    // Polynomials are wrong outside; the last steps decide whether the point is there.
    const double farthest = 1.05 * polynomials.max_height_mm;
    if (height > farthest) sensor = sensor * (farthest / height);
  }
  return std::nullopt;
}

DirectPolynomials at_wavelength(const DirectPolynomials& polynomials, double lambda_nm) {
  std::array<double, kMaxWavelengthTerms> factors{};
  chebyshev_values(direct_wavelength(polynomials, lambda_nm), factors);
  DirectPolynomials out = polynomials;
  const auto reduce = [&](ChebyshevSum& sum) {
    const auto count = static_cast<std::size_t>(term_count(sum.degree));
    std::vector<double> values(count, 0.0);
    for (std::size_t k = 0; k < sum.coefficients.size(); ++k)
      values[k % count] += factors[k / count] * static_cast<double>(sum.coefficients[k]);
    // Float holds multiples up to 2^24 of a step.
    for (const double value : values)
      while (std::abs(value) > 0x1p23 * sum.step) sum.step *= 2.0F;
    sum.wavelength_terms = 1;
    sum.coefficients.clear();
    for (const double value : values)
      sum.coefficients.push_back(sum.step * static_cast<float>(std::round(value / sum.step)));
  };
  for (ChebyshevVector* vector : {&out.origin_mm, &out.direction, &out.inner})
    reduce(vector->along_field), reduce(vector->along_pupil);
  for (PolynomialRim& rim : out.rims) reduce(rim.squared);
  reduce(out.transmittance);
  return out;
}

}  // namespace contrejour
