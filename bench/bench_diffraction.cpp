// A starburst for a new iris and its drawing at 1080p; ringing of a mask of 512 samples. Times are wall time.
#include <complex>
#include <vector>

#include <benchmark/benchmark.h>

#include "contrejour/fractional_fourier.h"
#include "contrejour/fresnel.h"
#include "contrejour/starburst.h"

namespace {

using namespace contrejour;

constexpr int kWidth = 1920, kHeight = 1080;

StarburstSettings at_f16() { return {100.0, 50.0 / 16.0, 0.01875, 1102.0}; }

Iris iris_of(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), 0.2, 0.01 * static_cast<double>(state.range(1))};
}

// Everything that a change of the iris costs: outline, mask, spectrum, colours, pixels.
void starburst_of_new_iris(benchmark::State& state) {
  const auto bands = spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709);
  Image image(kWidth, kHeight);
  for (auto _ : state) {
    const Starburst starburst = make_starburst(IrisOpening(iris_of(state)), bands, at_f16()).value();
    add_starburst(image, starburst, {960.3, 539.8}, {1.0, 1.0, 1.0});
    benchmark::DoNotOptimize(image.pixels.data());
  }
}

void starburst_of_another_light(benchmark::State& state) {
  const auto bands = spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709);
  const Starburst starburst = make_starburst(IrisOpening(iris_of(state)), bands, at_f16()).value();
  Image image(kWidth, kHeight);
  for (auto _ : state) {
    add_starburst(image, starburst, {960.3, 539.8}, {1.0, 1.0, 1.0});
    benchmark::DoNotOptimize(image.pixels.data());
  }
}

void fresnel_ringing(benchmark::State& state) {
  const PupilMask mask = make_mask(grid_over(1.0, 510), IrisOpening(Iris{8, 0.2}), 1.0);
  const FresnelSettings settings{static_cast<double>(state.range(0)), 512};
  for (auto _ : state) benchmark::DoNotOptimize(fresnel_pattern(mask, 1.0, settings));
}

void fractional_fourier_order(benchmark::State& state) {
  const auto side = static_cast<int>(state.range(0));
  const FractionalFourier fourier(side);
  const std::vector<std::complex<double>> square(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 1.0);
  for (auto _ : state) benchmark::DoNotOptimize(fourier.transform(square, 0.15));
}

BENCHMARK(starburst_of_new_iris)
    ->ArgNames({"blades", "curvature%"})
    ->Args({0, 0})
    ->Args({8, 0})
    ->Args({8, 30})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(starburst_of_another_light)
    ->ArgNames({"blades", "curvature%"})
    ->Args({8, 0})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(fresnel_ringing)
    ->ArgName("F")
    ->Arg(2)
    ->Arg(100)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(fractional_fourier_order)
    ->ArgName("side")
    ->Arg(256)
    ->Arg(512)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
