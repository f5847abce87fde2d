// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "support/approx.h"

using namespace contrejour;

namespace {
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// 0, 1, 2 ... 29 over 10 pixels of 3 channels.
Image ramp() {
  Image image(5, 2, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
  return image;
}
}  // namespace

TEST_CASE("equal images have no PSNR") {
  const Comparison c = compare(ramp(), ramp()).value();
  CHECK_FALSE(c.psnr_db.has_value());
  CHECK(c.max_abs_error == 0);
  CHECK(c.flux_ratio == std::vector<double>{1, 1, 1});
  CHECK(c.peak == test::approx(0.999 * 29));  // between 28 and 29 as numpy.percentile interpolates
}

TEST_CASE("a known error gives a known PSNR") {
  const Image a = ramp();
  Image b = a;
  b.at(1, 0, 2) += 3;  // one sample of 30
  const Comparison c = compare(a, b).value();
  const double peak = 0.999 * 29;
  CHECK(c.psnr_db.value() == test::approx(10 * std::log10(peak * peak / (9.0 / 30))).epsilon(1e-12));
  CHECK(c.max_abs_error == 3);
  CHECK(c.flux_ratio[0] == 1);
  CHECK(c.flux_ratio[2] == test::approx((155.0 + 3) / 155));
}

TEST_CASE("what lies above the peak counts for the largest error only") {
  Image a(100, 100, 3), b(100, 100, 3);
  for (auto& v : a.pixels) v = 1;
  b.pixels = a.pixels;
  a.at(3, 3, 0) = 500;
  b.at(3, 3, 0) = 800;
  const Comparison c = compare(a, b).value();
  CHECK(c.peak == 1);
  CHECK_FALSE(c.psnr_db.has_value());
  CHECK(c.max_abs_error == 300);
}

TEST_CASE("what lies as far below zero, as colours beyond the gamut do, counts likewise") {
  Image a(100, 100, 3), b(100, 100, 3);
  for (auto& v : a.pixels) v = 1;
  b.pixels = a.pixels;
  a.at(3, 3, 0) = -200;
  b.at(3, 3, 0) = -150;
  CHECK_FALSE(compare(a, b).value().psnr_db.has_value());
  b.at(3, 3, 0) = 1;  // from one end to the other: two peaks
  CHECK(compare(a, b).value().psnr_db.value() == test::approx(10 * std::log10(3e4 / 4)).epsilon(1e-12));
}

TEST_CASE("a peak of 0 falls back to the largest value") {
  Image a(100, 100, 3), b(100, 100, 3);
  a.at(0, 0, 0) = 8;
  CHECK(compare(a, b).value().peak == 8);
  CHECK(compare(b, a).value().peak == 8);
  CHECK(std::isinf(compare(b, a).value().flux_ratio[0]));
  CHECK(compare(b, a).value().flux_ratio[1] == 1);
  CHECK_FALSE(compare(b, b).value().psnr_db.has_value());
}

TEST_CASE("NaN and infinity are left out, and counted where they differ") {
  Image a = ramp();
  a.at(4, 1, 2) = kNan;
  a.at(0, 0, 0) = kInf;
  Image b = a;
  CHECK_FALSE(compare(a, b).value().psnr_db.has_value());
  CHECK(compare(a, b).value().non_finite_mismatches == 0);
  b.at(4, 1, 2) = 29;
  const Comparison c = compare(a, b).value();
  CHECK(c.non_finite_mismatches == 1);
  CHECK(c.psnr_db.value() == test::approx(10 * std::log10(30.0)));
  CHECK(c.max_abs_error == 0);
}

TEST_CASE("images of different size are not compared") {
  CHECK_FALSE(compare(Image(2, 3), Image(3, 2)).has_value());
  CHECK_FALSE(compare(Image(2, 2, 3), Image(2, 2, 1)).has_value());
  CHECK_FALSE(compare(Image(), Image()).has_value());
}

TEST_CASE("quantiles are those of sorted samples, near the top and elsewhere, ties and holes among them") {
  std::mt19937 random(5);
  for (const int count : {1, 2, 3, 63, 64, 65, 1000, 5000, 100000}) {
    CAPTURE(count);
    Image image(count, 1, 1);
    std::vector<float> finite;
    for (float& value : image.pixels) {
      value = static_cast<float>(random() % (count < 10000 ? 200U : 100000U));
      if (value == 7.0F && count > 3) value = kNan;
      if (std::isfinite(value)) finite.push_back(value);
    }
    std::sort(finite.begin(), finite.end());
    for (const double q : {0.0, 0.3, 0.5, 0.95, 0.985, 0.99, 0.999, 0.9999, 1.0}) {
      CAPTURE(q);
      const double position = q * static_cast<double>(finite.size() - 1);
      const auto below = static_cast<std::size_t>(position);
      const double high = finite[std::min(below + 1, finite.size() - 1)];
      const double expected = finite[below] + (position - static_cast<double>(below)) * (high - finite[below]);
      CHECK(quantile_of_samples(image, q) == expected);
    }
  }
}
