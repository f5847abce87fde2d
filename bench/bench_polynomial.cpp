// SPDX-License-Identifier: Apache-2.0
// A ghost's polynomials at points of the pupil, on each instruction set: sensor, stop, one rim and transmittance, by
// order. Items are points.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include "polynomial/point_kernels.h"

namespace {

using namespace contrejour;
using namespace contrejour::polynomial;

constexpr std::size_t kPoints = 1024;

PowerSum sum_of(int degree, float size) {
  PowerSum sum{degree, {}};
  for (std::size_t k = 0; k < static_cast<std::size_t>(pair_count(degree)); ++k)
    sum.coefficients[k] = size / static_cast<float>(k + 1);
  return sum;
}

void evaluate_points_of(benchmark::State& state, int order, std::int64_t target) {
  const int degree = (order - 1) / 2;
  const std::array sums{sum_of(degree, 3.0F), sum_of(degree, 5.0F), sum_of(degree, 0.2F),
                        sum_of(degree, 0.9F), sum_of(degree, 0.7F), sum_of(degree, 1e-3F)};
  std::vector<float> x(kPoints), y(kPoints);
  for (std::size_t k = 0; k < kPoints; ++k) {
    x[k] = 10.0F * std::sin(static_cast<float>(k));
    y[k] = 10.0F * std::cos(1.7F * static_cast<float>(k));
  }
  std::array<std::vector<float>, 7> out;
  for (auto& values : out) values.resize(kPoints);
  const std::array vectors{VectorOutput{&sums[0], &sums[1], out[0].data(), out[1].data()},
                           VectorOutput{&sums[2], &sums[3], out[2].data(), out[3].data()}};
  const std::array rims{ScalarOutput{&sums[4], out[4].data()}};
  const PointOutputs outputs{vectors, rims, out[5].data(), 1, 1.0F, {&sums[5], out[6].data()}, 1.0F};
  hwy::SetSupportedTargetsForTest(target);
  for (auto _ : state) {
    evaluate_points({.x = 0.1F, .y = 0.0F, .per_mm = 0.05F, .h = 0.8F, .per_end = 1.0F}, x.data(), y.data(), kPoints,
                    outputs);
    benchmark::ClobberMemory();
  }
  hwy::SetSupportedTargetsForTest(0);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoints));
}

const bool kRegistered = [] {
  for (const int order : {5, 7, 9, 11, 13, 15, 17}) {
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
      const std::string name =
          std::string("evaluate_points/") + hwy::TargetName(target) + "/order:" + std::to_string(order);
      benchmark::RegisterBenchmark(name.c_str(), evaluate_points_of, order, static_cast<std::int64_t>(target));
    }
  }
  return true;
}();

}  // namespace
