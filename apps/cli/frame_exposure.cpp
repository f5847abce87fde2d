// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_exposure.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "contrejour/expert/renderer_settings.h"

namespace contrejour::cli {
namespace {

// The time after which the lens and the lights are compared with those of a moment, over the time that a drawing is the
// mean of.
constexpr double kLater = 0.1;

Result<void> set_renderer(SourceRenderer& renderer, const FrameMoment& moment) {
  auto* const of_lens = std::get_if<Renderer>(&renderer);
  if (of_lens == nullptr) return {};
  if (auto set = configure_renderer(*of_lens, moment.values); !set) return set;
  return of_lens->set_lens(*moment.lens);
}

}  // namespace

std::shared_ptr<const FrameExposure> FrameExposure::create(const FrameValues& values, const FrameLens& lens,
                                                           int frame) {
  if (!values.change_during(frame)) return nullptr;
  return std::shared_ptr<const FrameExposure>(new FrameExposure(values, lens, frame));
}

// Ghosts are blurred where the lens is known and all lights are points.
Result<bool> FrameExposure::can_blur(const Scene& scene) const {
  if (!std::holds_alternative<LensState>(lens_.first_source())) return false;
  const auto middle = at({});
  if (!middle) return tl::unexpected(middle.error());
  const auto lights = scene.lights(*middle);
  if (!lights) return tl::unexpected(lights.error());
  return std::ranges::all_of(*lights, &Light::is_point);
}

// Lights that come or go meanwhile, or get a size, are drawn as they are at the moment.
Result<void> FrameExposure::set_motion(Renderer& renderer, const Scene& scene, const FrameMoment& moment,
                                       const ExposureTimes& times) const {
  const double by = kLater * (times.over->fall_to - times.over->rise_from);
  const auto later = at({times.parameters + by, times.lights_from + by, times.lights_to + by});
  if (!later) return tl::unexpected(later.error());
  const auto lights = scene.lights(moment);
  if (!lights) return tl::unexpected(lights.error());
  auto later_lights = scene.lights(*later);
  if (!later_lights) return tl::unexpected(later_lights.error());
  const bool can_move = lights->size() == later_lights->size() && std::ranges::all_of(*lights, &Light::is_point);
  if (can_move) renderer.set_motion(FrameMotion{*later->lens, std::move(*later_lights), by, *times.over});
  return {};
}

Result<ExposedFlare> FrameExposure::expose(const Scene& scene, SourceRenderer& renderer, double error,
                                           const Context& context) const {
  const auto blurs = can_blur(scene);
  if (!blurs) return tl::unexpected(blurs.error());
  ExposureOptions options;
  options.error = error;
  options.blurs = *blurs;
  // The lights of a measured flare are points.
  options.lights_move = values_.do_lights_move(frame_) && std::holds_alternative<LensState>(lens_.first_source());
  // Only a frame's own time may have a key between opening and closing.
  options.may_turn_back = values_.at(frame_).text("shutter-offset") == "centre";
  auto* const of_lens = std::get_if<Renderer>(&renderer);
  auto exposed = contrejour::expose(
      [&](const ExposureTimes& times, const Context& within) -> Result<LayeredFlare> {
        const auto moment = at(times);
        if (!moment) return tl::unexpected(moment.error());
        if (auto set = set_renderer(renderer, *moment); !set) return tl::unexpected(set.error());
        if (of_lens != nullptr) of_lens->set_motion(std::nullopt);
        if (of_lens != nullptr && times.over)
          if (auto set = set_motion(*of_lens, scene, *moment, times); !set) return tl::unexpected(set.error());
        return scene.draw(*moment, within);
      },
      options, context);
  if (of_lens != nullptr) of_lens->set_motion(std::nullopt);
  return exposed;
}

Result<FrameMoment> FrameExposure::at(const ExposureTimes& times) const {
  params::Values values = values_.during(frame_, times);
  auto lens = lens_.at(values);
  if (!lens) return tl::unexpected(lens.error());
  return FrameMoment{std::move(*lens), std::move(values)};
}

}  // namespace contrejour::cli
