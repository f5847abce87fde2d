// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_exposure.h"

#include <utility>
#include <variant>

#include "contrejour/expert/renderer_settings.h"

namespace contrejour::cli {
namespace {

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

Result<ExposedFlare> FrameExposure::expose(const DrawMoment& draw, SourceRenderer& renderer, double error,
                                           const Context& context) const {
  ExposureOptions options;
  options.error = error;
  // The lights of a measured flare are points.
  options.lights_move = values_.do_lights_move(frame_) && std::holds_alternative<LensState>(lens_.first_source());
  // Only a frame's own time may have a key between opening and closing.
  options.may_turn_back = values_.at(frame_).text("shutter-offset") == "centre";
  return contrejour::expose(
      [&](const ExposureTimes& times, const Context& within) -> Result<LayeredFlare> {
        const auto moment = at(times);
        if (!moment) return tl::unexpected(moment.error());
        if (auto set = set_renderer(renderer, *moment); !set) return tl::unexpected(set.error());
        return draw(*moment, within);
      },
      options, context);
}

Result<FrameMoment> FrameExposure::at(const ExposureTimes& times) const {
  params::Values values = values_.during(frame_, times);
  auto lens = lens_.at(values);
  if (!lens) return tl::unexpected(lens.error());
  return FrameMoment{std::move(*lens), std::move(values)};
}

}  // namespace contrejour::cli
