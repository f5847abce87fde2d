// SPDX-License-Identifier: Apache-2.0
#include "studio/core/plate_picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "contrejour/apply.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"

namespace contrejour::studio {
namespace {

// A text of everything that decides which lights are found, and in which directions they are.
std::string detection_key(const LensState& lens, const params::Values& values) {
  std::string key = fmt::format("{} {} {}", static_cast<const void*>(&lens), lens.focal_length_mm, lens.f_number);
  for (const params::Parameter& p : params::all_parameters())
    if (p.group == "Light detection" || p.group == "Frame" || p.name == "sensor")
      for (const std::string& text : p.name == "size" ? std::vector<std::string>{} : values.list(p.name))
        key += fmt::format(" {}={}", p.name, text);
  return key;
}

void add_mean_of_flare(Image& plate, const Image& flare, float per_pixel) {
  for (std::size_t k = 0; k < plate.pixels.size(); ++k)
    if (flare.pixels[k] > 0) plate.pixels[k] += flare.pixels[k] * per_pixel;
}

}  // namespace

Image reduced_image(const Image& image, int width, int height) {
  Image small(width, height, image.channels);
  const auto edge = [](int k, int of, int whole) { return static_cast<int>(static_cast<long long>(k) * whole / of); };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int x0 = edge(x, width, image.width), x1 = std::max(x0 + 1, edge(x + 1, width, image.width));
      const int y0 = edge(y, height, image.height), y1 = std::max(y0 + 1, edge(y + 1, height, image.height));
      const float part = 1.0F / static_cast<float>((x1 - x0) * (y1 - y0));
      for (int c = 0; c < image.channels; ++c) {
        float sum = 0;
        for (int sy = y0; sy < y1; ++sy)
          for (int sx = x0; sx < x1; ++sx) sum += image.at(sx, sy, c);
        small.at(x, y, c) = sum * part;
      }
    }
  return small;
}

Result<PlatePictures::Picture> PlatePictures::refined(const Plate& plate, const LensState& lens,
                                                      const params::Values& values, Renderer& renderer,
                                                      const Context& context) {
  const auto plan = plan_flare(plate.picture, lens, values);
  if (!plan) return tl::unexpected(plan.error());
  const auto flare = render_flare(*plan, plate.picture.rgb, values, renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  Picture picture{plate.picture.rgb, flare->statistics.ghosts_rendered};
  add_flare(picture.image, flare->image);
  return picture;
}

Result<std::vector<Light>> PlatePictures::detected(const Plate& plate, const LensState& lens,
                                                   const params::Values& values) {
  if (!values.is_on("detect")) return std::vector<Light>{};
  const std::string key = detection_key(lens, values);
  if (key == detected_with_) return detected_;
  auto plan = plan_flare(plate.picture, lens, values);
  if (!plan) return tl::unexpected(plan.error());
  plan->lights.resize(plan->lights.size() - plan->given_light_count);
  detected_ = std::move(plan->lights);
  detected_with_ = key;
  return detected_;
}

const Image& PlatePictures::reduced(int width, int height) {
  const auto [found, is_new] = reduced_.try_emplace({width, height});
  if (is_new) found->second = reduced_image(plate_->picture.rgb, width, height);
  return found->second;
}

Result<PlatePictures::Picture> PlatePictures::draft(const std::shared_ptr<const Plate>& plate, const LensState& lens,
                                                    const params::Values& values, const DrawFlare& draw) {
  if (plate_ != plate) {
    plate_ = plate;
    reduced_.clear();
    detected_with_.clear();
  }
  const auto lights = detected(*plate, lens, values);
  if (!lights) return tl::unexpected(lights.error());
  auto request = picture_request(values, lens, *lights, WithoutLights::Dark);
  if (!request) return tl::unexpected(request.error());
  for (std::size_t k = lights->size(); k < request->lights.size(); ++k)
    for (double& value : request->lights[k].value) value *= params::gain(values);
  Picture picture{reduced(request->grid.width, request->grid.height), 0};
  if (request->lights.empty()) return picture;
  const auto flare = draw(*request);
  if (!flare) return tl::unexpected(flare.error());
  const Image& whole = plate->picture.rgb;
  const double area = static_cast<double>(whole.width) * whole.height /
                      (static_cast<double>(picture.image.width) * picture.image.height);
  add_mean_of_flare(picture.image, flare->image, static_cast<float>(1 / area));
  picture.ghosts = flare->statistics.ghosts_rendered;
  return picture;
}

}  // namespace contrejour::studio
