// SPDX-License-Identifier: Apache-2.0
// A frame of the shot: the street by rays, then its lights as discs that are exact to a part of a pixel, then noise.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "demo/rows.h"
#include "demo/street_shot.h"

namespace contrejour::demo {
namespace {

constexpr int kRays = 2;               // per pixel along each side
constexpr double kPointsPerPixel = 9;  // of a light's disc
constexpr double kReadNoise = 0.003, kShotNoise = 0.0004, kGrain = 0.012;

void draw_background(const StreetScene& scene, const StreetCamera& camera, Image& image) {
  for_each_row(image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      Rgb sum{};
      for (int k = 0; k < kRays * kRays; ++k) {
        const Vec2 pixel{x + (k % kRays + 0.5) / kRays, y + (k / kRays + 0.5) / kRays};
        const Rgb radiance = scene.background(camera.position(), camera.direction_of(pixel));
        for (std::size_t c = 0; c < 3; ++c) sum[c] += radiance[c] / (kRays * kRays);
      }
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(sum[static_cast<std::size_t>(c)]);
    }
  });
}

// Adds light to the four pixels around a point, by a tent as wide as two pixels: a light that moves by a part of a
// pixel keeps its sum and its centroid.
void splat(Image& image, Vec2 at, const Rgb& flux) {
  const double left = std::floor(at.x - 0.5), top = std::floor(at.y - 0.5);
  for (int k = 0; k < 4; ++k) {
    const int x = static_cast<int>(left) + k % 2, y = static_cast<int>(top) + k / 2;
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
    const double weight = (1.0 - std::abs(at.x - 0.5 - x)) * (1.0 - std::abs(at.y - 0.5 - y));
    for (int c = 0; c < 3; ++c) image.at(x, y, c) += static_cast<float>(weight * flux[static_cast<std::size_t>(c)]);
  }
}

// A light's disc as points of equal flux in a spiral; those behind a pole are not drawn.
class Disc {
 public:
  Disc(const ShotLight& light, const StreetCamera& camera) : camera_(camera) {
    const Vec3 ray = light.lamp.centre - camera.position();
    const double distance = length(ray);
    centre_ = light.lamp.centre;
    const Vec3 toward = ray * (1.0 / distance);
    across_ = normalized(Vec3{toward.z, 0.0, -toward.x}) * light.lamp.radius;
    up_ = Vec3{toward.y * across_.z, toward.z * across_.x - toward.x * across_.z, -toward.y * across_.x};
    const double sine = light.lamp.radius / distance;
    area_px_ = std::numbers::pi * sine * sine * camera.pixels_per_solid_angle(toward);
    const double clear = light.in_haze ? haze_transmittance(distance) : 1.0;
    count_ = static_cast<int>(std::clamp(kPointsPerPixel * area_px_, 128.0, 65536.0));
    for (std::size_t c = 0; c < 3; ++c) point_flux_[c] = light.lamp.radiance[c] * clear * area_px_ / count_;
  }

  template <class Visit>
  void for_each_point(const StreetScene& scene, const Visit& visit) const {
    constexpr double kGoldenAngle_rad = 2.399963229728653;
    for (int k = 0; k < count_; ++k) {
      const double radius = std::sqrt((k + 0.5) / count_), angle = k * kGoldenAngle_rad;
      const Vec3 point = centre_ + across_ * (radius * std::cos(angle)) + up_ * (radius * std::sin(angle));
      const auto pixel = camera_.pixel_of(point);
      if (pixel && scene.is_visible(camera_.position(), point)) visit(*pixel, point_flux_);
    }
  }

 private:
  const StreetCamera& camera_;
  Vec3 centre_, across_, up_;
  double area_px_ = 0;
  int count_ = 0;
  Rgb point_flux_{};
};

TrueLight draw_light(const ShotLight& light, const StreetScene& scene, const StreetCamera& camera, Image& image) {
  TrueLight seen;
  seen.position_px = camera.pixel_of(light.lamp.centre).value_or(Vec2{-1.0, -1.0});
  int drawn = 0;
  Vec2 sum;
  Disc(light, camera).for_each_point(scene, [&](Vec2 pixel, const Rgb& flux) {
    splat(image, pixel, flux);
    if (pixel.x < 0.0 || pixel.y < 0.0 || pixel.x >= image.width || pixel.y >= image.height) return;
    for (std::size_t c = 0; c < 3; ++c) seen.flux[c] += flux[c];
    sum = sum + pixel;
    ++drawn;
  });
  seen.is_in_picture = drawn > 0;
  if (drawn > 0) seen.position_px = sum * (1.0 / drawn);
  return seen;
}

double gaussian(std::int64_t a, std::int64_t b, std::int64_t c) {
  return std::sqrt(-2.0 * std::log(1.0 - hash01(a, b, 2 * c))) *
         std::cos(2.0 * std::numbers::pi * hash01(a, b, 2 * c + 1));
}

// The sensor's noise in each pixel, and grain that is two pixels wide.
void add_noise(const ShotSettings& settings, int frame, Image& image) {
  const std::int64_t roll = (static_cast<std::int64_t>(settings.seed) << 32) + frame;
  for_each_row(image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        float& value = image.at(x, y, c);
        const double sigma = std::sqrt(kReadNoise * kReadNoise + kShotNoise * static_cast<double>(value));
        const double grain = kGrain * gaussian(roll, (std::int64_t{y / 2} << 20) + x / 2, 3 + c);
        value += static_cast<float>(sigma * gaussian(roll, (std::int64_t{y} << 20) + x, c) +
                                    grain * static_cast<double>(value));
      }
  });
}

}  // namespace

ShotFrame make_frame(const ShotSettings& settings, int frame) {
  const ShotMoment moment = shot_moment(settings, frame);
  const StreetCamera camera(moment.camera, settings.width, settings.height, settings.hfov_rad);
  std::vector<Lamp> lamps;
  for (const ShotLight& light : moment.lights)
    if (light.in_haze) lamps.push_back(light.lamp);
  const StreetScene scene(std::move(lamps), shot_poles());
  ShotFrame made{Image(settings.width, settings.height, 3), {}};
  draw_background(scene, camera, made.image);
  for (const ShotLight& light : moment.lights) made.lights.push_back(draw_light(light, scene, camera, made.image));
  if (settings.noise) add_noise(settings, frame, made.image);
  return made;
}

}  // namespace contrejour::demo
