// SPDX-License-Identifier: Apache-2.0
#include "contrejour/apply.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "compositing/picture_flare.h"
#include "contrejour/expert/pixel_grid.h"
#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/settings.h"

namespace contrejour {

inline namespace internal {

FrameSettings settings_of(const FlarePlan& plan, const params::Values& values) {
  FrameSettings settings = params::frame_settings(values, plan.grid.frame, plan.space);
  settings.starburst.left_out = plan.light_matte;
  settings.starburst.lights = plan.imaged_lights;
  return settings;
}

PictureFlare flare_without_lights(const FlarePlan& plan) {
  PictureFlare flare;
  flare.image = Image(plan.grid.width, plan.grid.height);
  return flare;
}

Result<PictureFlare> on_picture(Flare frame, const FlarePlan& plan, const Image& rgb) {
  auto image = picture_of_flare(std::move(frame.image), plan.grid);
  if (!image) return tl::unexpected(image.error());
  PictureFlare flare;
  flare.image = std::move(*image);
  flare.statistics = std::move(frame.statistics);
  flare.visibility = visibility_of(rgb, flare.image, plan.found, plan.space);
  return flare;
}

}  // namespace internal

Result<PictureFlare> render_flare(const FlarePlan& plan, const Image& rgb, const params::Values& values,
                                  Renderer& renderer, const Context& context) {
  if (plan.lights.empty()) return flare_without_lights(plan);
  auto rendered = renderer.render(plan.lights, settings_of(plan, values), context);
  if (!rendered) return tl::unexpected(rendered.error());
  return on_picture(std::move(*rendered), plan, rgb);
}

Result<PictureFlare> render_flare(const FlarePlan& plan, const Image& rgb, const LensState& lens,
                                  const params::Values& values, const Context& context) {
  auto renderer = Renderer::create();
  if (!renderer) return tl::unexpected(renderer.error());
  if (auto set = configure_renderer(*renderer, values); !set) return tl::unexpected(set.error());
  if (auto set = renderer->set_lens(lens); !set) return tl::unexpected(set.error());
  return render_flare(plan, rgb, values, *renderer, context);
}

void add_flare(Image& image, const Image& flare) {
  assert(image.width == flare.width && image.height == flare.height && image.channels >= 3 && flare.channels == 3);
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t pixels = flare.pixels.size() / 3;
  for (std::size_t k = 0; k < pixels; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      float& sample = image.pixels[channels * k + c];
      const float added = flare.pixels[3 * k + c];
      if (std::isfinite(sample) && added > 0.0F) sample += added;
    }
  }
}

Result<AppliedFlare> apply_flare(Picture& picture, const LensState& lens, const params::Values& values,
                                 const Context& context) {
  auto plan = plan_flare(picture, lens, values);
  if (!plan) return tl::unexpected(plan.error());
  auto flare = render_flare(*plan, picture.rgb, lens, values, context);
  if (!flare) return tl::unexpected(flare.error());
  add_flare(picture.rgb, flare->image);
  return AppliedFlare{std::move(*plan), std::move(*flare)};
}

}  // namespace contrejour
