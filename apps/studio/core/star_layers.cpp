// SPDX-License-Identifier: Apache-2.0
#include "studio/core/star_layers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/requests.h"

namespace contrejour::studio {
namespace {

// The frame about a light, twice as wide and high as the picture's: wherever the light moves within it, it is covered.
Frame frame_about(const Frame& picture, Vec2 light_px) {
  Frame frame = picture;
  frame.width = 2 * picture.width;
  frame.height = 2 * picture.height;
  frame.origin_x = static_cast<int>(std::lround(light_px.x)) - picture.width;
  frame.origin_y = static_cast<int>(std::lround(light_px.y)) - picture.height;
  return frame;
}

// All that is left of the ghosts is one, without light.
void leave_out_ghosts(FrameSettings& settings, const LensState& lens) {
  settings.ghosts = {};
  settings.ghosts.gain = 0;
  const auto ghosts = enumerate_ghosts(lens, settings.scope);
  if (!ghosts.empty()) settings.selection = SelectList{{ghosts.front()}};
}

Result<PictureRequest> coarse_request(params::Values values, const LensState& lens) {
  const auto size = params::parse_size(*values.text("size"));
  if (!size) return tl::unexpected(size.error());
  const auto coarse = [](int pixels) { return std::max(1, pixels / StarLayers::kDivisor); };
  if (auto ok = values.set("size", fmt::format("{}x{}", coarse(size->width), coarse(size->height))); !ok)
    return tl::unexpected(ok.error());
  auto request = picture_request(values, lens);
  if (request && !request->grid.is_square())
    return failure(ErrorCode::Unsupported, "pixels that are not square on the sensor have no star layers");
  return request;
}

// The image between its pixels; nothing outside.
struct Sampler {
  const Image& image;

  void add(double x, double y, float gain, float* to) const {
    const double fx = x - 0.5, fy = y - 0.5;
    const int x0 = static_cast<int>(std::floor(fx)), y0 = static_cast<int>(std::floor(fy));
    if (x0 < 0 || y0 < 0 || x0 + 1 >= image.width || y0 + 1 >= image.height) return;
    const auto tx = static_cast<float>(fx - x0), ty = static_cast<float>(fy - y0);
    const float* p = &image.pixels[image.index(x0, y0)];
    const float* q = p + static_cast<std::ptrdiff_t>(image.width) * 3;
    for (int c = 0; c < 3; ++c)
      to[c] += gain * ((1 - ty) * ((1 - tx) * p[c] + tx * p[c + 3]) + ty * ((1 - tx) * q[c] + tx * q[c + 3]));
  }
};

}  // namespace

bool StarLayers::are_wanted(const params::Values& values) {
  return values.is_on("starburst") || values.number("glare") > 0;
}

const StarLayers::Layer* StarLayers::find(const std::string& key) const {
  const auto found = std::find_if(layers_.begin(), layers_.end(), [&](const Layer& l) { return l.key == key; });
  return found != layers_.end() ? &*found : nullptr;
}

bool StarLayers::have(const std::vector<StarLight>& lights) const {
  return !lights.empty() && lights.size() <= kMostLights &&
         std::all_of(lights.begin(), lights.end(), [&](const StarLight& l) { return find(l.key) != nullptr; });
}

Result<void> StarLayers::prepare(const std::vector<StarLight>& lights, const params::Values& values,
                                 const LensState& lens, Renderer& renderer, const Context& context) {
  if (have(lights) || lights.empty() || lights.size() > kMostLights) return {};
  auto request = coarse_request(values, lens);
  if (!request) return tl::unexpected(request.error());
  if (request->lights.size() != lights.size()) return {};
  const Frame picture = request->grid.frame;
  leave_out_ghosts(request->settings, lens);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    if (find(lights[k].key) != nullptr) continue;
    const Vec2 at{lights[k].at.x * picture.width, lights[k].at.y * picture.height};
    request->settings.frame = frame_about(picture, at);
    auto flare = renderer.render({&request->lights[k], 1}, request->settings, context);
    if (!flare) return tl::unexpected(flare.error());
    const Vec2 origin{static_cast<double>(request->settings.frame.origin_x),
                      static_cast<double>(request->settings.frame.origin_y)};
    if (layers_.size() >= 2 * kMostLights) layers_.erase(layers_.begin());
    layers_.push_back({lights[k].key, std::move(flare->image), at - origin});
  }
  return {};
}

void StarLayers::add(const std::vector<StarLight>& lights, Vec2 picture_px, int divisor, Image& draft) const {
  const double to_layer = static_cast<double>(divisor) / kDivisor;
  const auto gain = static_cast<float>(to_layer * to_layer);  // a pixel's value is its area's
  for (const StarLight& light : lights) {
    const Layer* layer = find(light.key);
    if (layer == nullptr) continue;
    const Sampler sampler{layer->image};
    const Vec2 at{light.at.x * picture_px.x / kDivisor, light.at.y * picture_px.y / kDivisor};
    const Vec2 shift = layer->light_px - at;
    for (int y = 0; y < draft.height; ++y)
      for (int x = 0; x < draft.width; ++x)
        sampler.add((x + 0.5) * to_layer + shift.x, (y + 0.5) * to_layer + shift.y, gain,
                    &draft.pixels[draft.index(x, y)]);
  }
}

}  // namespace contrejour::studio
