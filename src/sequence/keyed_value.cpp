// SPDX-License-Identifier: Apache-2.0
#include "sequence/keyed_value.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace contrejour {
namespace {

// The last key at or before the frame; the first one for an earlier frame.
std::size_t key_before(const KeyedValue& value, double frame) {
  const auto after =
      std::find_if(value.keys.begin(), value.keys.end(), [&](const Key& key) { return key.frame > frame; });
  return after == value.keys.begin() ? 0 : static_cast<std::size_t>(after - value.keys.begin()) - 1;
}

double span_of(const KeyedValue& value, std::size_t k) {
  return static_cast<double>(value.keys[k + 1].frame) - value.keys[k].frame;
}

// From key k to the next, a frame's change.
double secant(const KeyedValue& value, std::size_t k, std::size_t component) {
  return (value.keys[k + 1].numbers[component] - value.keys[k].numbers[component]) / span_of(value, k);
}

// The slope at a key of a cubic that is monotone between keys: the weighted harmonic mean of the secants beside it
// (Fritsch and Butland 1984, equation 5), level at the ends and where the secants differ in sign.
double slope_at(const KeyedValue& value, std::size_t k, std::size_t component) {
  if (k == 0 || k + 1 == value.keys.size()) return 0.0;
  const double before = secant(value, k - 1, component), after = secant(value, k, component);
  if (before * after <= 0.0) return 0.0;
  const double h0 = span_of(value, k - 1), h1 = span_of(value, k);
  return 3.0 * (h0 + h1) / ((2.0 * h1 + h0) / before + (h1 + 2.0 * h0) / after);
}

// Hermite's cubic over the span from key k, at t from 0 to 1.
double smooth_between(const KeyedValue& value, std::size_t k, std::size_t component, double t) {
  const double h = span_of(value, k);
  const double a = value.keys[k].numbers[component], b = value.keys[k + 1].numbers[component];
  const double at_a = h * slope_at(value, k, component), at_b = h * slope_at(value, k + 1, component);
  const double u = 1.0 - t;
  return u * u * ((1.0 + 2.0 * t) * a + t * at_a) + t * t * ((1.0 + 2.0 * u) * b - u * at_b);
}

}  // namespace

inline namespace internal {

std::vector<double> numbers_at(const KeyedValue& value, double frame) {
  const std::size_t k = key_before(value, frame);
  std::vector<double> numbers = value.keys[k].numbers;
  if (k + 1 == value.keys.size() || frame <= value.keys[k].frame || value.between == Interpolation::Step)
    return numbers;
  const double t = (frame - value.keys[k].frame) / span_of(value, k);
  for (std::size_t c = 0; c < numbers.size(); ++c)
    numbers[c] = value.between == Interpolation::Smooth ? smooth_between(value, k, c, t)
                                                        : std::lerp(numbers[c], value.keys[k + 1].numbers[c], t);
  return numbers;
}

}  // namespace internal

std::string text_at(const KeyedValue& value, double frame) {
  const Key& key = value.keys[key_before(value, frame)];
  return key.numbers.empty() ? key.text : fmt::format("{}", fmt::join(numbers_at(value, frame), ","));
}

}  // namespace contrejour
