// SPDX-License-Identifier: Apache-2.0
#include "studio/core/frame_export.h"

#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/frame_pattern.h"
#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/settings.h"
#include "studio/core/frame_values.h"
#include "studio/core/picture_files.h"

namespace contrejour::studio {
namespace {

Result<PictureInput> input_of(const FramesOrder& order, params::Values values) {
  auto lens = params::lens_of(*order.document.lens, values);
  if (!lens) return tl::unexpected(lens.error());
  const bool has_lights = !order.document.animation.lights.empty();
  return PictureInput{std::move(values), std::make_shared<const LensState>(std::move(*lens)), order.plate,
                      order.document.plate, has_lights ? WithoutLights::Dark : WithoutLights::DefaultLight};
}

Result<DrawnPicture> draw_at(const FramesOrder& order, params::Values values, Renderer& renderer,
                             const Context& context) {
  const auto input = input_of(order, std::move(values));
  if (!input) return tl::unexpected(input.error());
  if (auto set = configure_renderer(renderer, input->values); !set) return tl::unexpected(set.error());
  if (auto set = renderer.set_lens(*input->lens); !set) return tl::unexpected(set.error());
  return draw_picture(*input, renderer, context);
}

// The mean over the time for which the shutter is open, where the lens or the settings change meanwhile.
Result<DrawnPicture> draw_exposure(const FramesOrder& order, int frame, Renderer& renderer, const Context& context) {
  const Document& document = order.document;
  const Shutter shutter = shutter_of_frame(document, frame);
  auto input = input_of(order, values_of_frame(document, frame));
  if (!input) return tl::unexpected(input.error());
  const auto draw = [&](const ExposureTimes& times, const Context& within) -> Result<LayeredFlare> {
    auto drawn = draw_at(order, values_during_frame(document, frame, times), renderer, within);
    if (!drawn) return tl::unexpected(drawn.error());
    return LayeredFlare{std::move(drawn->flare), {}, {}};
  };
  ExposureOptions options;
  options.error = params::frame_settings(input->values, Frame{}, ColourSpace::Rec709).area_error;
  options.lights_move = do_lights_move(document.animation, frame, shutter);
  options.may_turn_back = shutter.centred;
  auto exposed = expose(draw, options, context);
  if (!exposed) return tl::unexpected(exposed.error());
  return DrawnPicture{std::move(*input), std::move(exposed->flare.image), true};
}

void write_all(const FramesOrder& order, FramesJob::Control& control) {
  FramesAnswer answer{0, order.last - order.first + 1, {}, false};
  auto renderer = Renderer::create();
  for (int frame = order.first; renderer && frame <= order.last && !control.is_outdated(); ++frame) {
    control.publish(answer);
    if (auto ok = export_frame(order, frame, *renderer, {.cancel = &control.is_outdated()}); !ok) {
      answer.error = ok.error().to_string();
      break;
    }
    ++answer.done;
  }
  answer.is_over = true;
  control.publish(answer);
}

}  // namespace

Result<void> check_pattern(const std::string& pattern) {
  if (auto parsed = parse_frame_pattern(pattern); !parsed)
    return failure(ErrorCode::InvalidArgument, "give #### for the number of a frame, as in flare.####.exr", {pattern});
  return check_picture_name(pattern, false);
}

Result<void> export_frame(const FramesOrder& order, int frame, Renderer& renderer, const Context& context) {
  const auto pattern = parse_frame_pattern(order.pattern);
  if (!pattern) return tl::unexpected(pattern.error());
  auto file = OutputFile::create(file_of_frame(*pattern, frame));
  if (!file) return tl::unexpected(file.error());
  const auto drawn = parameters_change_during(order.document, frame)
                         ? draw_exposure(order, frame, renderer, context)
                         : draw_at(order, values_of_frame(order.document, frame), renderer, context);
  if (!drawn) return tl::unexpected(drawn.error());
  if (auto ok = write_drawn(*file, *drawn, context); !ok) return ok;
  return file->commit();
}

FramesJob::Work frames_work() {
  return [](const FramesOrder& order, FramesJob::Control& control) {
    if (!order.pattern.empty()) write_all(order, control);
  };
}

}  // namespace contrejour::studio
