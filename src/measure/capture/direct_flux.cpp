// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contrejour/expert/capture_list.h"
#include "contrejour/expert/sweep_geometry.h"
#include "measure/capture/half_size.h"

namespace contrejour {
namespace {

constexpr double kSaturatedDirect = 0.99;  // of the range
constexpr double kDirectRadii = 3.0;  // radius of the sum, in those of the image's area above half of its maximum
constexpr double kRingRadii = 5.0;  // outer radius of the ring that the background is taken from

// Sums of a picture's pixels and their number within two radii about a point.
struct RingSum {
  Rgb sum{};
  double pixels = 0;
};

RingSum ring_sum(const Image& image, Vec2 centre, double from, double to) {
  RingSum ring;
  const auto low = [to](double x) { return std::max(static_cast<int>(std::floor(x - to)), 0); };
  const int right = std::min(static_cast<int>(std::ceil(centre.x + to)), image.width - 1);
  const int bottom = std::min(static_cast<int>(std::ceil(centre.y + to)), image.height - 1);
  for (int y = low(centre.y); y <= bottom; ++y) {
    for (int x = low(centre.x); x <= right; ++x) {
      const double distance = length(Vec2{x + 0.5, y + 0.5} - centre);
      if (distance < from || distance >= to) continue;
      for (std::size_t c = 0; c < 3; ++c) ring.sum[c] += static_cast<double>(image.at(x, y, static_cast<int>(c)));
      ++ring.pixels;
    }
  }
  return ring;
}

// The radius of a disc as large as the part of the image above half of its maximum.
double half_maximum_radius(const Image& image) {
  float largest = 0.0F;
  for (std::size_t k = 1; k < image.pixels.size(); k += 3) largest = std::max(largest, image.pixels[k]);
  double count = 0.0;
  for (std::size_t k = 1; k < image.pixels.size(); k += 3) count += image.pixels[k] >= 0.5F * largest ? 1.0 : 0.0;
  return std::sqrt(count / std::numbers::pi);
}

}  // namespace

Result<DirectFlux> direct_flux(const RawFrame& direct) {
  const auto position = direct_image_position(direct);
  if (!position)
    return invalid_argument("the short exposure shows no light, or a saturated one; take it with another time");
  const HalfSize half = half_size(direct, {}, kSaturatedDirect);
  const double radius = kDirectRadii * half_maximum_radius(half.signal) + 2.0;
  const double ring_radius = radius * kRingRadii / kDirectRadii;
  const RingSum inside = ring_sum(half.signal, *position, 0.0, radius);
  const RingSum around = ring_sum(half.signal, *position, radius, ring_radius);
  DirectFlux flux{*position, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    const double background = around.pixels > 0.0 ? around.sum[c] / around.pixels : 0.0;
    flux.rate[c] = (inside.sum[c] - background * inside.pixels) / direct.time_s;
  }
  return flux;
}

std::vector<std::size_t> unsteady_stations(std::span<const double> flux, double largest) {
  std::vector<std::size_t> unsteady;
  for (std::size_t k = 0; k < flux.size(); ++k) {
    const std::size_t first = k >= 2 ? k - 2 : 0, last = std::min(k + 3, flux.size());
    std::vector<double> near(flux.begin() + static_cast<std::ptrdiff_t>(first),
                             flux.begin() + static_cast<std::ptrdiff_t>(last));
    std::ranges::sort(near);
    const double middle = near[near.size() / 2];
    if (middle > 0.0 && std::abs(flux[k] / middle - 1.0) > largest) unsteady.push_back(k);
  }
  return unsteady;
}

}  // namespace contrejour
