// SPDX-License-Identifier: Apache-2.0
// contrejour lights track: the lights of a sequence, with an identity over time, as a file of lights.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/sequence_options.h"
#include "contrejour/expert/light_tracks.h"
#include "contrejour/expert/run_frames.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kTrackExamples =
    "Bright areas of each frame become lights with keys by frame, for `apply --lights`. Look at the file, correct it,\n"
    "and use it again: docs/sequences.md says how.\n\n"
    "Examples:\n"
    "  contrejour lights track plate.####.exr -o lights.toml\n"
    "  contrejour lights track plate.####.exr -o lights.toml --frames 1001-1100 --threshold 20 --hfov 40";

constexpr int kMaxDetections = 1000;     // in a frame: more are grain, and are merged into the nearest
constexpr std::size_t kThresholdFrames = 9;  // that the shot's threshold is derived from

struct TrackOptions {
  std::string input, output;
  bool json = false;
  ReadOptions read;
  PlateColour colour;
  SequenceOptions sequence;
  params::Values values;
  TrackingSettings tracking;
  TrackKeySettings keys;
  double search = 0.05;  // of the frame's width
};

std::vector<PixelRegion> regions_in(const Picture& picture, const params::Values& values) {
  const PixelWindow &display = picture.display_window, &data = picture.data_window;
  const auto whole = [](double px) { return static_cast<int>(std::clamp(std::round(px), -1e9, 1e9)); };
  std::vector<PixelRegion> regions;
  for (const std::string& text : values.list("region")) {
    const params::UvRegion uv = *params::parse_region(text);
    regions.push_back(
        {whole(uv.from.x * display.width) + display.x - data.x, whole(uv.from.y * display.height) + display.y - data.y,
         whole(uv.to.x * display.width) + display.x - data.x, whole(uv.to.y * display.height) + display.y - data.y});
  }
  return regions;
}

Error error_of_frame(int frame, const Error& error) {
  const std::string where = error.position.file.empty() ? "" : error.position.file + ": ";
  return {error.code, fmt::format("frame {}: {}{}", frame, where, error.message), {}};
}

// Detects the lights of each frame of a shot; all must have one size.
class ShotDetection {
 public:
  ShotDetection(const TrackOptions& options, const SequenceFrames& frames) : options_(options), frames_(frames) {}

  [[nodiscard]] Result<Picture> read(int frame) const {
    const auto name = name_of_frame(options_.input, frame);
    if (!name) return tl::unexpected(name.error());
    auto plate = read_plate(*name, options_.read, options_.colour);
    if (!plate) return tl::unexpected(plate.error());
    return std::move(plate->picture);
  }

  [[nodiscard]] Result<Detection> detect(const Picture& picture, std::optional<double> threshold) const {
    DetectionSettings settings = params::detection_settings(options_.values);
    settings.threshold = threshold;
    settings.max_lights = kMaxDetections;
    settings.regions = regions_in(picture, options_.values);
    return detect_lights(picture.rgb, settings);
  }

  // --threshold, or one for all frames from some of them; none if they have no light.
  [[nodiscard]] Result<std::optional<double>> threshold() const {
    if (const auto given = options_.values.real("threshold")) return given;
    std::vector<Threshold> thresholds;
    const std::size_t count = frames_.frames.size(), step = (count + kThresholdFrames - 1) / kThresholdFrames;
    for (std::size_t k = step / 2; k < count; k += step) {
      if (frames_.missing.contains(frames_.frames[k])) continue;
      const auto picture = read(frames_.frames[k]);
      if (!picture) return tl::unexpected(error_of_frame(frames_.frames[k], picture.error()));
      const auto found = detect(*picture, std::nullopt);
      if (!found) return tl::unexpected(found.error());
      thresholds.push_back({found->threshold, found->source});
    }
    return shot_threshold(thresholds);
  }

  // A missing frame has no lights.
  [[nodiscard]] Result<FrameLights> lights_of(int frame, const std::optional<Picture>& picture, double threshold) {
    if (!picture) return FrameLights{frame, {0, 0, size_.width, size_.height}, {}};
    const PixelWindow& display = picture->display_window;
    if (size_.width == 0) size_ = display;
    if (display.width != size_.width || display.height != size_.height)
      return invalid_argument(fmt::format("the picture has {} x {} pixels, but the frames before it have {} x {}",
                                          display.width, display.height, size_.width, size_.height));
    const auto found = detect(*picture, threshold);
    if (!found) return tl::unexpected(found.error());
    return frame_lights(frame, *found, picture->data_window, display);
  }

  [[nodiscard]] const PixelWindow& size() const { return size_; }

 private:
  const TrackOptions& options_;
  const SequenceFrames& frames_;
  PixelWindow size_;
};

Result<std::vector<FrameLights>> detect_all(ShotDetection& shot, const SequenceFrames& frames, double threshold) {
  std::vector<FrameLights> all;
  const LongTask task("detecting", 0);
  const auto read = [&](int frame) -> Result<std::optional<Picture>> {
    if (frames.missing.contains(frame)) return std::optional<Picture>();
    auto picture = shot.read(frame);
    if (!picture) return tl::unexpected(picture.error());
    return std::optional<Picture>(std::move(*picture));
  };
  const auto detect = [&](int frame, const std::optional<Picture>& picture, const Context&) {
    return shot.lights_of(frame, picture, threshold);
  };
  const auto keep = [&](int, FrameLights& lights) -> Result<void> {
    all.push_back(std::move(lights));
    return {};
  };
  const auto failures = run_frames(frames.frames, read, detect, keep, {false, 2}, task.context());
  if (!failures) return tl::unexpected(failures.error());
  if (failures->empty()) return all;
  return tl::unexpected(error_of_frame(failures->front().frame, failures->front().error));
}

// The angle of a pixel in the middle of the frame.
std::optional<double> pixel_deg(const params::Values& values, int width) {
  const auto hfov = values.real("hfov");
  if (!hfov) return std::nullopt;
  return 2.0 * std::tan(0.5 * *hfov * params::kDegree_rad) / width / params::kDegree_rad;
}

Result<void> write_lights(const std::string& name, const Animation& animation) {
  Outputs outputs;
  const auto file = outputs.add(name);
  if (!file) return tl::unexpected(file.error());
  if (auto ok = (*file)->write(write_animation(animation)); !ok) return ok;
  return outputs.commit();
}

void report(const TrackOptions& options, const Animation& animation, std::size_t track_count, std::size_t frame_count,
            double threshold) {
  const std::size_t left_out = track_count - animation.lights.size();
  if (options.json) {
    print_json({{"output", options.output},
                {"frames", frame_count},
                {"threshold", threshold},
                {"lights", animation.lights.size()},
                {"left_out", left_out}});
    return;
  }
  const std::string rest = left_out == 0 ? "" : fmt::format("; the weakest {} left out (--max-lights)", left_out);
  print_summary(fmt::format("{}: {} lights in {} frames, threshold {:g}{}\n", options.output, animation.lights.size(),
                            frame_count, threshold, rest));
}

Result<int> run_track(TrackOptions options) {
  if (!is_sequence(options.input))
    return invalid_argument(fmt::format("{}: give the name of a sequence, such as plate.####.exr", options.input));
  const auto frames = frames_of_sequence(options.sequence, options.input);
  if (!frames) return tl::unexpected(frames.error());
  ShotDetection shot(options, *frames);
  const auto threshold = shot.threshold();
  if (!threshold) return tl::unexpected(threshold.error());
  if (!*threshold)
    return failure(ErrorCode::InvalidArgument,
                   "no frame has a light that is much brighter than the rest; --threshold sets a level",
                   {options.input});
  const auto detected = detect_all(shot, *frames, **threshold);
  if (!detected) return tl::unexpected(detected.error());
  options.keys.width = shot.size().width;
  options.keys.height = shot.size().height;
  options.keys.pixel_deg = pixel_deg(options.values, options.keys.width);
  options.tracking.search_px = std::max(1.0, options.search * options.keys.width);
  const auto tracks = track_lights(*detected, options.tracking);
  const Animation animation = animation_of_tracks(tracks, frames->frames, options.keys);
  if (auto ok = write_lights(options.output, animation); !ok) return tl::unexpected(ok.error());
  report(options, animation, tracks.size(), frames->frames.size(), **threshold);
  return kDone;
}

void add_tracking_options(CLI::App& command, TrackOptions& options) {
  constexpr const char* kGroup = "Tracking";
  command
      .add_option("--search", options.search,
                  "how far a light of unknown velocity may move in a frame, in widths of the picture (default: 0.05)")
      ->check(CLI::Range(0.001, 1.0))
      ->option_text("FRACTION")
      ->group(kGroup);
  add_number(command, "--max-gap", options.tracking.max_gap, 0, 1000,
             "frames that a light may be hidden for and still be the same")
      ->group(kGroup);
  add_number(command, "--min-frames", options.tracking.min_frames, 1, 1000,
             "lights that are seen in fewer frames are left out")
      ->group(kGroup);
  add_number(command, "--max-lights", options.keys.max_lights, 1, 10000, "lights to keep, the brightest")
      ->group(kGroup);
  add_number(command, "--fade", options.keys.fade_frames, 0, 1000,
             "frames in which a light appears before it is first seen, and disappears after it is last seen")
      ->group(kGroup);
  command
      .add_option("--position-tolerance", options.keys.position_tolerance_px,
                  "keys are left out if positions change by less, in pixels (default: 0.05)")
      ->check(CLI::Range(1e-6, 1000.0))
      ->option_text("PX")
      ->group(kGroup);
  command
      .add_option("--value-tolerance", options.keys.value_tolerance,
                  "keys are left out if values change by less, as a fraction (default: 0.01)")
      ->check(CLI::Range(1e-6, 1.0))
      ->option_text("FRACTION")
      ->group(kGroup);
}

}  // namespace

void add_lights_track(CLI::App& lights, Action& action) {
  const auto options = std::make_shared<TrackOptions>();
  CLI::App* command = lights.add_subcommand("track", "the lights of a sequence, followed from frame to frame");
  command->add_option("IN", options->input, "the sequence, e.g. plate.####.exr")->required()->option_text(" ");
  add_picture_choice(*command, options->read);
  add_plate_colour(*command, options->colour, PlateUse::Read);
  add_output(*command, "-o,--output", options->output, {".toml"}, "the lights, with keys by frame")->required();
  command->add_flag("--json", options->json, "print the report as JSON");
  add_frame_options(*command, options->sequence, SequenceInput::Files);
  add_parameters(*command, options->values, {"region", "threshold", "softness", "min-pixels", "max-value"});
  add_parameters(*command, options->values, {"hfov"});
  add_tracking_options(*command, *options);
  command->footer(kTrackExamples);
  command->callback([options, &action] { action = [options] { return run_track(*options); }; });
}

}  // namespace contrejour::cli
