// SPDX-License-Identifier: Apache-2.0
#include "demo/street.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "demo/street_scene.h"

namespace contrejour::demo {
namespace {

constexpr int kSamples = 4;  // per pixel along each side
constexpr double kCameraHeight_m = 1.7;
constexpr double kHorizonOffset = 0.16;  // below the middle of the picture, as a fraction of its height

Rgb pixel(const StreetScene& scene, const StreetSettings& settings, int x, int y) {
  const double scale = 2.0 * std::tan(0.5 * settings.hfov_rad) / settings.width;
  Rgb sum{};
  for (int k = 0; k < kSamples * kSamples; ++k) {
    const double px = x + (k % kSamples + hash01(x, y, 2 * k)) / kSamples;
    const double py = y + (k / kSamples + hash01(x, y, 2 * k + 1)) / kSamples;
    const Vec3 direction = normalized(
        {(px - 0.5 * settings.width) * scale + 1e-9, ((0.5 + kHorizonOffset) * settings.height - py) * scale, 1.0});
    const Rgb radiance = scene.radiance({0.5, kCameraHeight_m, 0.0}, direction);
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += radiance[c] / (kSamples * kSamples);
  }
  return sum;
}

}  // namespace

Image make_street(const StreetSettings& settings) {
  const StreetScene scene;
  Image image(settings.width, settings.height);
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const auto fill_rows = [&](int first) {
    for (int y = first; y < settings.height; y += threads) {
      for (int x = 0; x < settings.width; ++x) {
        const Rgb rgb = pixel(scene, settings, x, y);
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(rgb[static_cast<std::size_t>(c)]);
      }
    }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(fill_rows, t);
  fill_rows(0);
  for (std::thread& other : others) other.join();
  return image;
}

}  // namespace contrejour::demo
