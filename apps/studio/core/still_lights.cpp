// SPDX-License-Identifier: Apache-2.0
#include "studio/core/still_lights.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace contrejour::studio {
namespace {

bool are_alike(const Light& a, const Light& b) {
  const auto direction = [](const Light& light) {
    return std::array{light.direction.x, light.direction.y, light.direction.z};
  };
  return direction(a) == direction(b) && a.value == b.value && a.spectrum == b.spectrum &&
         a.distance_mm == b.distance_mm && a.radius_rad == b.radius_rad && a.shape == b.shape;
}

}  // namespace

Result<Flare> StillLights::draw(const PictureRequest& request, const std::string& key, const DrawFlare& draw) {
  were_drawn_ = false;
  const bool is_comparable = key == key_ && request.lights.size() == before_.size();
  std::vector<Light> still;
  PictureRequest moved = request;
  moved.lights.clear();
  for (std::size_t k = 0; k < request.lights.size(); ++k) {
    const Light& light = request.lights[k];
    (is_comparable && are_alike(light, before_[k]) ? still : moved.lights).push_back(light);
  }
  key_ = key;
  before_ = request.lights;
  if (still.empty() || moved.lights.empty()) {
    kept_.reset();
    return draw(request);
  }
  if (!kept_ || !std::ranges::equal(still, still_, are_alike)) {
    if (auto kept = keep(request, std::move(still), draw); !kept) return tl::unexpected(kept.error());
  }
  auto flare = draw(moved);
  if (flare) std::ranges::transform(flare->image.pixels, kept_->pixels, flare->image.pixels.begin(), std::plus<>());
  return flare;
}

Result<void> StillLights::keep(const PictureRequest& request, std::vector<Light> lights, const DrawFlare& draw) {
  const auto start = std::chrono::steady_clock::now();
  kept_.reset();
  PictureRequest still = request;
  still.lights = lights;
  auto flare = draw(still);
  if (!flare) return tl::unexpected(flare.error());
  still_ = std::move(lights);
  kept_ = std::move(flare->image);
  kept_time_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  were_drawn_ = true;
  return {};
}

std::string key_without_lights(const params::Values& values) {
  std::string key;
  for (const params::Parameter& p : params::all_parameters())
    if (p.group != "Lights" && values.given(p.name))
      key += fmt::format("{}={}\n", p.name, fmt::join(values.list(p.name), "\t"));
  return key;
}

}  // namespace contrejour::studio
