// SPDX-License-Identifier: Apache-2.0
#include "cli/apply_sequence.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cli/frame_lens.h"
#include "cli/frame_renderers.h"
#include "cli/frame_report.h"
#include "cli/long_task.h"
#include "contrejour/expert/frame_record.h"
#include "contrejour/expert/run_frames.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

Result<ApplyOptions> options_of_frame(const ApplyOptions& options, const FrameValues& values, int frame) {
  ApplyOptions own = options;
  own.values = values.at(frame);
  if (auto ok = number_names(frame, {&own.input, &own.output, &own.flare_only, &own.detected, &own.preview}); !ok)
    return tl::unexpected(ok.error());
  own.preset.save.clear();
  own.layers.light_names = values.light_names(frame);
  own.layers.off_names = values.off_names(frame);
  return own;
}

// The files of a frame, for its record.
FrameFiles files_of(const ApplyOptions& own, const std::string& exposure, bool is_missing) {
  SettingsRecord settings = settings_record("apply", own.lens, own.values);
  settings.text += fmt::format("layer = {}\npart = {}\n", own.read.layer, own.read.part);
  const PlateColour& colour = own.colour;
  if (!colour.input_space.empty() || !colour.output_space.empty())
    settings.text +=
        fmt::format("spaces = {} -> {} of {}\n", colour.input_space, colour.output_space, colour_config(colour));
  settings.text += compression_text(own.compression) + exposure + layers_text(own.layers);
  return frame_files(std::move(settings), is_missing ? std::string() : own.input, own.outputs());
}

// Reads frames, all of which must have the first one's size.
class FrameReader {
 public:
  FrameReader(const ApplyOptions& options, const FrameValues& values, FrameLens& lens, const SequenceFrames& sequence)
      : options_(options), values_(values), lens_(lens), sequence_(sequence) {}

  [[nodiscard]] Result<PlannedPhotograph> read(int frame) {
    auto own = options_of_frame(options_, values_, frame);
    if (!own) return tl::unexpected(own.error());
    auto lens = lens_.at(own->values);
    if (!lens) return tl::unexpected(lens.error());
    auto plate = sequence_.missing.contains(frame) ? black_picture() : read_plate(own->input, own->read, own->colour);
    if (!plate) return tl::unexpected(plate.error());
    if (auto fits = check_size(plate->picture, frame, own->input); !fits) return tl::unexpected(fits.error());
    auto planned = plan_photograph(*own, std::move(*lens), std::move(*plate));
    if (planned) planned->exposure = FrameExposure::create(values_, lens_, frame);
    return planned;
  }

 private:
  struct FirstFrame {
    int frame = 0;
    PixelWindow window;
  };

  // Black in the size and form of the first frame that exists.
  [[nodiscard]] Result<Plate> black_picture() {
    if (!black_) {
      const auto present = std::find_if(sequence_.frames.begin(), sequence_.frames.end(),
                                        [&](int frame) { return !sequence_.missing.contains(frame); });
      const auto own = options_of_frame(options_, values_, *present);
      if (!own) return tl::unexpected(own.error());
      auto plate = read_plate(own->input, own->read, own->colour);
      if (!plate) return plate;
      Pixels& pixels = plate->picture.rgb.pixels;
      std::fill(pixels.begin(), pixels.end(), 0.0F);
      black_ = std::move(*plate);
    }
    return *black_;
  }

  [[nodiscard]] Result<void> check_size(const Picture& picture, int frame, const std::string& input) {
    const PixelWindow& window = picture.display_window;
    if (!first_) first_ = {frame, window};
    if (window == first_->window) return {};
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("the picture has {} x {} pixels, but frame {} has {} x {}; render it by itself, or make "
                               "the display windows equal",
                               window.width, window.height, first_->frame, first_->window.width, first_->window.height),
                   {input});
  }

  const ApplyOptions& options_;
  const FrameValues& values_;
  FrameLens& lens_;
  const SequenceFrames& sequence_;
  std::optional<FirstFrame> first_;
  std::optional<Plate> black_;
};

// The same with the ghosts that have layers of their own in all frames: the brightest ones of the first frame.
Result<ApplyOptions> with_same_layers(ApplyOptions options, const FrameValues& values, FrameLens& lens,
                                      const SequenceFrames& sequence) {
  if (!chooses_ghosts(options.layers)) return options;
  const auto first = FrameReader(options, values, lens, sequence).read(sequence.frames.front());
  if (!first) return tl::unexpected(first.error());
  const FlarePlan& plan = first->plan;
  const FrameSettings settings = params::frame_settings(first->options.values, plan.grid.frame, plan.space);
  if (auto ok = choose_ghosts(options.layers, *first->lens, plan.lights, first->options.values, settings); !ok)
    return tl::unexpected(ok.error());
  return options;
}

}  // namespace

Result<int> apply_to_sequence(const ApplyOptions& given, const FrameValues& values,
                              const SequenceOptions& sequence_options) {
  ApplyOptions options = given;
  if (auto ok = check_sequence_outputs(options.outputs()); !ok) return tl::unexpected(ok.error());
  auto sequence = frames_of_sequence(sequence_options, options.input);
  if (!sequence) return tl::unexpected(sequence.error());
  auto lens = FrameLens::create(options.lens, values, sequence->frames.front(), MeasuredUse::Photograph);
  if (!lens) return tl::unexpected(lens.error());
  if (auto same = with_same_layers(options, values, *lens, *sequence); same)
    options = std::move(*same);
  else
    return tl::unexpected(same.error());
  const auto is_missing = [&](int frame) { return sequence->missing.contains(frame); };
  std::vector<int> frames = sequence->frames;
  if (sequence_options.resume)
    leave_out_done(frames, [&](int frame) {
      const auto own = options_of_frame(options, values, frame);
      return own && is_frame_done(files_of(*own, values.exposure_text(frame), is_missing(frame)));
    });
  if (sequence_options.list_frames) return print_frames(frames);
  auto renderers =
      FrameRenderers::create(*lens, values.at(sequence->frames.front()), sequence_options.frames_in_flight);
  if (!renderers) return tl::unexpected(renderers.error());
  if (auto ok = save_preset(options.preset, options.lens, options.values); !ok) return tl::unexpected(ok.error());

  FrameReader reader(options, values, *lens, *sequence);
  FrameReport report(options.json);
  const LongTask task("rendering", options.values.integer("threads"));
  const auto render = [&](int, PlannedPhotograph& planned, const Context& context) -> Result<FlaredPhotograph> {
    return renderers->use([&](FrameRenderer& renderer) -> Result<FlaredPhotograph> {
      if (auto set = renderer.set(planned.lens, planned.options.values); !set) return tl::unexpected(set.error());
      return render_photograph(std::move(planned), renderer.get(), context);
    });
  };
  const auto write = [&](int frame, FlaredPhotograph& flared) -> Result<void> {
    if (auto ok = write_photograph(flared, without_progress(task.context())); !ok) return ok;
    report.warn(flared.planned.plan.warnings);
    report.add(frame, flared);
    return write_frame_record(files_of(flared.planned.options, values.exposure_text(frame), is_missing(frame)));
  };
  const auto failures = run_frames(
      frames, [&](int frame) { return reader.read(frame); }, render, write,
      run_options(sequence_options, renderers->count()), task.context());
  if (!failures) return tl::unexpected(failures.error());
  return report_failures(*failures, frames.size());
}

}  // namespace contrejour::cli
