// SPDX-License-Identifier: Apache-2.0
#include "demo/street.h"

#include <cmath>
#include <vector>

#include "demo/rows.h"
#include "demo/street_scene.h"

namespace contrejour::demo {
namespace {

constexpr int kSamples = 4;  // per pixel along each side
constexpr double kCameraHeight_m = 1.7;
constexpr double kHorizonOffset = 0.16;  // below the middle of the picture, as a fraction of its height
constexpr Rgb kHeadlight{2400, 2300, 2050};

std::vector<Lamp> lamps_of_still() {
  std::vector<Lamp> lamps = street_lamps();
  for (const double x : {-2.6, -1.3}) lamps.push_back({{x, 0.68, 47.0}, 0.085, kHeadlight});
  for (const double x : {1.2, 2.5}) lamps.push_back({{x, 0.75, 33.0}, 0.07, {60, 3, 1}});
  lamps.push_back({{4.4, 3.1, 60.0}, 0.13, {4, 80, 45}});  // traffic light
  return lamps;
}

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
  const StreetScene scene(lamps_of_still());
  Image image(settings.width, settings.height);
  for_each_row(settings.height, [&](int y) {
    for (int x = 0; x < settings.width; ++x) {
      const Rgb rgb = pixel(scene, settings, x, y);
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(rgb[static_cast<std::size_t>(c)]);
    }
  });
  return image;
}

}  // namespace contrejour::demo
