// SPDX-License-Identifier: Apache-2.0
// The camera to test with: photon noise, read noise, black level, rounding and clipping of a Bayer mosaic.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/split_mix.h"
#include "base/tasks.h"
#include "measure/capture/bayer.h"

namespace contrejour {
namespace {

// From this many electrons on, a normal distribution stands for Poisson's.
constexpr double kManyElectrons = 60.0;

// Random numbers of one pixel, which depend on the seed and the pixel alone.
class PixelRandom {
 public:
  PixelRandom(std::uint64_t seed, std::uint64_t pixel) : state_(split_mix(seed + pixel * kSplitMixIncrement)) {}

  double unit() { return unit_interval(split_mix(state_ += kSplitMixIncrement)); }  // in [0, 1)
  double normal() {  // Box and Muller 1958; mean 0, variance 1
    const double radius = std::sqrt(-2.0 * std::log(1.0 - unit()));
    return radius * std::cos(2.0 * std::numbers::pi * unit());
  }

 private:
  std::uint64_t state_;
};

// A number of electrons of this mean, by multiplying uniform numbers until their product is below exp(-mean) (Knuth).
double few_electrons(double mean, PixelRandom& random) {
  const double limit = std::exp(-mean);
  double product = random.unit(), count = 0.0;
  while (product > limit) {
    product *= random.unit();
    ++count;
  }
  return count;
}

double electrons(double mean, PixelRandom& random) {
  if (mean <= 0.0) return 0.0;
  if (mean < kManyElectrons) return few_electrons(mean, random);
  return std::max(0.0, mean + std::sqrt(mean) * random.normal());
}

std::uint16_t exposed_pixel(double rate, const SensorModel& sensor, double time_s, PixelRandom random) {
  const double signal = electrons(rate * time_s * sensor.noise.electrons_per_dn, random);
  const double read = sensor.noise.read_electrons * random.normal();
  const double dn = sensor.black_dn + (signal + read) / sensor.noise.electrons_per_dn;
  return static_cast<std::uint16_t>(std::clamp(std::round(dn), 0.0, sensor.white_dn));
}

Result<void> check(const Image& rate, const SensorModel& sensor, double time_s) {
  if (rate.channels != 3 || rate.width < 2 || rate.height < 2 || rate.width % 2 != 0 || rate.height % 2 != 0) {
    return invalid_argument(fmt::format("a picture to expose has three channels and an even size: {} x {} x {}",
                                        rate.width, rate.height, rate.channels));
  }
  const bool sensor_ok = sensor.noise.electrons_per_dn > 0.0 && sensor.noise.read_electrons >= 0.0 &&
                         sensor.black_dn >= 0.0 && sensor.black_dn < sensor.white_dn && sensor.white_dn <= 65535.0;
  if (!sensor_ok || !(time_s > 0.0 && std::isfinite(time_s))) {
    return invalid_argument("the sensor's gain and the time must be above 0, black below white, white at most 65535");
  }
  return {};
}

}  // namespace

Result<RawFrame> expose(const Image& rate, const SensorModel& sensor, double time_s, std::uint64_t seed,
                        const Context& context) {
  if (Result<void> ok = check(rate, sensor, time_s); !ok) return tl::unexpected(ok.error());
  RawFrame frame{rate.width, rate.height, sensor.pattern, sensor.black_dn, sensor.white_dn, time_s, {}};
  const auto width = static_cast<std::size_t>(rate.width);
  frame.dn.resize(width * static_cast<std::size_t>(rate.height));
  const bool done = parallel_for(static_cast<std::size_t>(rate.height), context, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < rate.width; ++x) {
      const std::size_t k = row * width + static_cast<std::size_t>(x);
      const std::size_t channel = channel_at(sensor.pattern, x, y);
      const auto value = static_cast<double>(rate.at(x, y, static_cast<int>(channel)));
      frame.dn[k] = exposed_pixel(value, sensor, time_s, PixelRandom(seed, k));
    }
  });
  if (!done) return interrupted();
  return frame;
}

}  // namespace contrejour
