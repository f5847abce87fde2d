// SPDX-License-Identifier: Apache-2.0
#include "cli/render_sequence.h"

#include <utility>

#include <fmt/format.h>

#include "cli/frame_lens.h"
#include "cli/frame_renderers.h"
#include "cli/frame_report.h"
#include "cli/long_task.h"
#include "contrejour/expert/frame_range.h"
#include "contrejour/expert/frame_record.h"
#include "contrejour/expert/run_frames.h"

namespace contrejour::cli {
namespace {

Result<RenderOptions> options_of_frame(const RenderOptions& options, const FrameValues& values, int frame) {
  RenderOptions own = options;
  own.values = values.at(frame);
  if (auto ok = number_names(frame, {&own.output, &own.preview, &own.stats}); !ok) return tl::unexpected(ok.error());
  own.preset.save.clear();
  own.layers.light_names = values.light_names(frame);
  own.layers.off_names = values.off_names(frame);
  return own;
}

// The files of a frame, for its record.
FrameFiles files_of(const RenderOptions& own, const std::string& exposure) {
  SettingsRecord settings = settings_record("render", own.lens, own.values);
  settings.text += fmt::format("default light = {}\n", own.needs_light);
  if (!own.colour.output_space.empty())
    settings.text += fmt::format("spaces = {} of {}\n", own.colour.output_space, colour_config(own.colour));
  settings.text += compression_text(own.compression) + exposure + layers_text(own.layers);
  return frame_files(std::move(settings), {}, own.outputs());
}

Result<PlannedFrame> plan_numbered(const RenderOptions& options, const FrameValues& values, const FrameLens& lens,
                                   int frame) {
  auto own = options_of_frame(options, values, frame);
  if (!own) return tl::unexpected(own.error());
  auto state = lens.at(own->values);
  if (!state) return tl::unexpected(state.error());
  auto planned = plan_frame(*own, lens.first_source(), std::move(*state));
  if (planned) planned->exposure = FrameExposure::create(values, lens, frame);
  return planned;
}

// The same with the ghosts that have layers of their own in all frames: the brightest ones of the first frame, with the
// default light where it has none.
Result<RenderOptions> with_same_layers(RenderOptions options, const FrameValues& values, const FrameLens& lens,
                                       int first_frame) {
  if (!chooses_ghosts(options.layers)) return options;
  const auto first = plan_numbered(options, values, lens, first_frame);
  if (!first) return tl::unexpected(first.error());
  if (auto ok = choose_ghosts(options.layers, *first->lens, first->request.lights, first->options.values,
                              first->request.settings);
      !ok)
    return tl::unexpected(ok.error());
  return options;
}

}  // namespace

Result<int> render_sequence(const RenderOptions& given, const FrameValues& values, const SequenceOptions& sequence) {
  RenderOptions options = given;
  if (auto ok = check_sequence_outputs(options.outputs()); !ok) return tl::unexpected(ok.error());
  auto frames = parse_frame_range(sequence.frames);
  if (!frames) return tl::unexpected(frames.error());
  auto lens = FrameLens::create(options.lens, values, frames->front(), MeasuredUse::Lights);
  if (!lens) return tl::unexpected(lens.error());
  if (auto same = with_same_layers(options, values, *lens, frames->front()); same)
    options = std::move(*same);
  else
    return tl::unexpected(same.error());
  const int first = frames->front();
  if (sequence.resume)
    leave_out_done(*frames, [&](int frame) {
      const auto own = options_of_frame(options, values, frame);
      return own && is_frame_done(files_of(*own, values.exposure_text(frame)));
    });
  if (sequence.list_frames) return print_frames(*frames);
  auto renderers = FrameRenderers::create(*lens, values.at(first), sequence.frames_in_flight);
  if (!renderers) return tl::unexpected(renderers.error());
  if (auto ok = save_preset(options.preset, options.lens, options.values); !ok) return tl::unexpected(ok.error());

  FrameReport report(options.json);
  const LongTask task("rendering", options.values.integer("threads"));
  const auto render = [&](int, PlannedFrame& planned, const Context& context) -> Result<RenderedFrame> {
    return renderers->use([&](FrameRenderer& renderer) -> Result<RenderedFrame> {
      if (auto set = renderer.set(planned.lens, planned.options.values); !set) return tl::unexpected(set.error());
      return render_frame(std::move(planned), renderer.get(), context);
    });
  };
  const auto write = [&](int frame, RenderedFrame& rendered) -> Result<void> {
    if (auto ok = write_frame(rendered, without_progress(task.context())); !ok) return ok;
    report.warn(rendered.planned.request.warnings);
    report.add(frame, rendered);
    return write_frame_record(files_of(rendered.planned.options, values.exposure_text(frame)));
  };
  const auto failures = run_frames(
      *frames, [&](int frame) { return plan_numbered(options, values, *lens, frame); }, render, write,
      run_options(sequence, renderers->count()), task.context());
  if (!failures) return tl::unexpected(failures.error());
  return report_failures(*failures, frames->size());
}

}  // namespace contrejour::cli
