// SPDX-License-Identifier: Apache-2.0
#include "studio/core/frame_export.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/frame_pattern.h"
#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/settings.h"
#include "studio/core/frame_values.h"
#include "studio/core/picture_files.h"
#include "studio/core/plate_frames.h"

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

// With the plate of one frame.
Result<FramesOrder> order_of_frame(const FramesOrder& order, int frame) {
  FramesOrder one = order;
  if (!is_plate_sequence(order.document.plate.file)) return one;
  auto plate = plate_of(order.document.plate, frame);
  if (!plate) return tl::unexpected(plate.error());
  one.plate = std::move(*plate);
  one.document.plate = plate_at(order.document.plate, frame);
  return one;
}

Result<void> write_frame(const FramesOrder& one, int frame, Renderer& renderer, const Context& context) {
  const auto pattern = parse_frame_pattern(one.pattern);
  if (!pattern) return tl::unexpected(pattern.error());
  auto file = OutputFile::create(file_of_frame(*pattern, frame));
  if (!file) return tl::unexpected(file.error());
  const auto drawn = parameters_change_during(one.document, frame)
                         ? draw_exposure(one, frame, renderer, context)
                         : draw_at(one, values_of_frame(one.document, frame), renderer, context);
  if (!drawn) return tl::unexpected(drawn.error());
  if (auto ok = write_drawn(*file, *drawn, context); !ok) return ok;
  return file->commit();
}

// Writes frames, all of whose plates must have the first one's size.
class FrameWriter {
 public:
  explicit FrameWriter(const FramesOrder& order) : order_(order) {}

  Result<void> write(int frame, Renderer& renderer, const Context& context) {
    const auto one = order_of_frame(order_, frame);
    if (!one) return tl::unexpected(one.error());
    if (one->plate) {
      const PixelWindow& window = one->plate->picture.display_window;
      if (!window_) window_ = window;
      if (window != *window_)
        return failure(ErrorCode::InvalidArgument,
                       fmt::format("frame {} of the plate has {} x {} pixels, but those before have {} x {}", frame,
                                   window.width, window.height, window_->width, window_->height),
                       {one->document.plate.file});
    }
    return write_frame(*one, frame, renderer, context);
  }

 private:
  const FramesOrder& order_;
  std::optional<PixelWindow> window_;
};

// The frames of a sequence that have no file.
std::vector<int> missing_of(const FramesOrder& order) {
  if (!is_plate_sequence(order.document.plate.file)) return {};
  const auto present = frames_of_plate(order.document.plate);
  return present ? missing_frames(*present, order.first, order.last) : std::vector<int>{};
}

void write_all(const FramesOrder& order, FramesJob::Control& control) {
  FramesAnswer answer{0, order.last - order.first + 1, missing_of(order), {}, false};
  FrameWriter writer(order);
  auto renderer = Renderer::create();
  if (static_cast<int>(answer.missing.size()) == answer.count) answer.error = "none of the plate's frames exists";
  for (int frame = order.first; renderer && frame <= order.last && !control.is_outdated(); ++frame) {
    if (std::ranges::binary_search(answer.missing, frame)) continue;
    control.publish(answer);
    if (auto ok = writer.write(frame, *renderer, control.context()); !ok) {
      answer.error = ok.error().to_string();
      break;
    }
    ++answer.done;
  }
  answer.is_over = true;
  control.publish(answer);
}

}  // namespace

Result<void> check_pattern(const std::string& pattern, bool has_plate) {
  if (auto parsed = parse_frame_pattern(pattern); !parsed)
    return failure(ErrorCode::InvalidArgument, "give #### for the number of a frame, as in flare.####.exr", {pattern});
  return check_picture_name(pattern, has_plate);
}

Result<void> export_frame(const FramesOrder& order, int frame, Renderer& renderer, const Context& context) {
  return FrameWriter(order).write(frame, renderer, context);
}

FramesJob::Work frames_work() {
  return [](const FramesOrder& order, FramesJob::Control& control) {
    if (!order.pattern.empty()) write_all(order, control);
  };
}

}  // namespace contrejour::studio
