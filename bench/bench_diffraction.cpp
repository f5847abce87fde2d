// SPDX-License-Identifier: Apache-2.0
// A starburst for a new iris and its drawing at 1080p; ringing of a mask of 512 samples. Times are wall time.
#include <complex>
#include <vector>

#include <benchmark/benchmark.h>

#include "contrejour/expert/fractional_fourier.h"
#include "contrejour/expert/fresnel.h"
#include "contrejour/expert/lens_starburst.h"
#include "contrejour/expert/starburst.h"
#include "contrejour/render.h"

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

// The work that remains for each frame once a starburst is kept: the light moves by fractions of a pixel.
void starburst_kept_over_frames(benchmark::State& state) {
  const auto bands = spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709);
  StarburstSettings settings = at_f16();
  settings.radius_px = 2250.0;
  const Starburst starburst = make_starburst(IrisOpening(iris_of(state)), bands, settings).value();
  const StarburstImage sheet = lay_out(starburst, kWidth, kHeight).value();
  Image image(kWidth, kHeight);
  double x = 900.3;
  for (auto _ : state) {
    add_starburst(image, sheet, {x += 0.3, 539.8}, {1.0, 1.0, 1.0});
    benchmark::DoNotOptimize(image.pixels.data());
  }
}

void starburst_laid_out(benchmark::State& state) {
  const auto bands = spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709);
  StarburstSettings settings = at_f16();
  settings.radius_px = 2250.0;
  const Starburst starburst = make_starburst(IrisOpening(iris_of(state)), bands, settings).value();
  for (auto _ : state) benchmark::DoNotOptimize(lay_out(starburst, kWidth, kHeight));
}

// A lens's own exit pupil, off the axis and vignetted, to pixels: the cost of a new lens state or light.
void starburst_through_lens(benchmark::State& state) {
  const auto lens =
      configure_lens(*find_lens("canon-70-200"),
                     {.focal_length_mm = 135.0, .f_number = static_cast<double>(state.range(0)), .iris = {8, 0.2}});
  const Frame frame = frame_on_sensor(*lens, kWidth, kHeight);
  const Vec2 centre_px{1344.0, 356.0};
  const Vec3 direction =
      direction_for_image_point(*lens, frame.sensor_from_pixel(centre_px), lens->design_wavelength_nm);
  const auto bands = spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709);
  Image image(kWidth, kHeight);
  for (auto _ : state) {
    const auto starburst = lens_starburst(*lens, direction, bands, {frame.pixel_pitch_mm, 1525.0});
    add_starburst(image, *starburst, centre_px, {1.0, 1.0, 1.0});
    benchmark::DoNotOptimize(image.pixels.data());
  }
}

void exit_pupil_of_lens(benchmark::State& state) {
  const auto lens =
      configure_lens(*find_lens("canon-70-200"),
                     {.focal_length_mm = 135.0, .f_number = static_cast<double>(state.range(0)), .iris = {8, 0.2}});
  const Vec3 direction = direction_from_angles(0.06, 0.04);
  for (auto _ : state) benchmark::DoNotOptimize(exit_pupil(*lens, direction, lens->design_wavelength_nm));
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
BENCHMARK(starburst_kept_over_frames)
    ->ArgNames({"blades", "curvature%"})
    ->Args({8, 0})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(starburst_laid_out)
    ->ArgNames({"blades", "curvature%"})
    ->Args({8, 0})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(starburst_through_lens)
    ->ArgName("f")
    ->Arg(16)
    ->Arg(4)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(exit_pupil_of_lens)
    ->ArgName("f")
    ->Arg(16)
    ->Arg(4)
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
