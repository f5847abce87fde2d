// SPDX-License-Identifier: Apache-2.0
#include "demo/moving_shot.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "contrejour/apply.h"
#include "contrejour/expert/frame_pattern.h"
#include "contrejour/expert/light_tracks.h"
#include "contrejour/expert/output_file.h"
#include "contrejour/expert/run_frames.h"
#include "contrejour/expert/settings.h"
#include "contrejour/renderer.h"
#include "demo/footage.h"

namespace contrejour::demo {
namespace {

namespace fs = std::filesystem;

constexpr int kColumns = 6, kTileWidth = 320, kGap = 4;

// One file of a sequence in the shot's folder.
class ShotFiles {
 public:
  ShotFiles(const fs::path& folder, const std::string& name) : pattern_{(folder / name).string() + ".", ".exr", 4} {}

  [[nodiscard]] fs::path at(int frame) const { return file_of_frame(pattern_, frame); }

 private:
  FramePattern pattern_;
};

// One threshold for the whole shot, from three of its frames.
Result<double> common_threshold(const ShotFiles& plates, const std::vector<int>& frames) {
  std::vector<Threshold> thresholds;
  for (std::size_t k = frames.size() / 6; k < frames.size(); k += std::max<std::size_t>(1, frames.size() / 3)) {
    const auto plate = read_picture(plates.at(frames[k]));
    if (!plate) return tl::unexpected(plate.error());
    thresholds.push_back(automatic_threshold(plate->rgb));
  }
  const auto threshold = shot_threshold(thresholds);
  if (!threshold) return failure(ErrorCode::InvalidArgument, "the shot has no light");
  return *threshold;
}

Result<Animation> tracked_lights(const ShotSettings& settings, const ShotFiles& plates, const std::vector<int>& frames,
                                 int max_lights) {
  const auto threshold = common_threshold(plates, frames);
  if (!threshold) return tl::unexpected(threshold.error());
  DetectionSettings detection;
  detection.threshold = *threshold;
  detection.max_lights = 1000;
  std::vector<FrameLights> found;
  for (const int frame : frames) {
    const auto plate = read_picture(plates.at(frame));
    if (!plate) return tl::unexpected(plate.error());
    const auto lights = detect_lights(plate->rgb, detection);
    if (!lights) return tl::unexpected(lights.error());
    found.push_back(frame_lights(frame, *lights, plate->data_window, plate->display_window));
  }
  TrackKeySettings keys;
  keys.width = settings.width;
  keys.height = settings.height;
  keys.max_lights = max_lights;
  return animation_of_tracks(track_lights(found, {.search_px = 0.05 * settings.width}), frames, keys);
}

// The frames in rows, each reduced to the same width.
class ContactSheet {
 public:
  ContactSheet(const ShotSettings& settings, std::size_t count)
      : width_(std::min(kTileWidth, settings.width)), height_(width_ * settings.height / settings.width) {
    const int rows = static_cast<int>((count + kColumns - 1) / kColumns);
    sheet_ = Image(kColumns * (width_ + kGap) - kGap, rows * (height_ + kGap) - kGap, 3);
  }

  void add(std::size_t number, const Image& picture) {
    const int left = static_cast<int>(number % kColumns) * (width_ + kGap);
    const int top = static_cast<int>(number / kColumns) * (height_ + kGap);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        for (int c = 0; c < 3; ++c) sheet_.at(left + x, top + y, c) = mean(picture, x, y, c);
  }

  [[nodiscard]] const Image& image() const { return sheet_; }

 private:
  // The mean over the picture's pixels that a pixel of the tile covers.
  [[nodiscard]] float mean(const Image& picture, int x, int y, int c) const {
    const int x0 = x * picture.width / width_, x1 = std::max(x0 + 1, (x + 1) * picture.width / width_);
    const int y0 = y * picture.height / height_, y1 = std::max(y0 + 1, (y + 1) * picture.height / height_);
    float sum = 0.0F;
    for (int v = y0; v < y1; ++v)
      for (int u = x0; u < x1; ++u) sum += picture.at(u, v, c);
    return sum / static_cast<float>((x1 - x0) * (y1 - y0));
  }

  int width_, height_;
  Image sheet_;
};

// Adds the flare of the file's lights to each frame, while others are read and written.
Result<void> flare_frames(const ShotFiles& plates, const ShotFiles& flared, const std::vector<int>& frames,
                          const Animation& lights, const LensState& lens, const params::Values& common,
                          ContactSheet& sheet) {
  auto renderer = Renderer::create(params::method_options(common));
  if (!renderer) return tl::unexpected(renderer.error());
  if (auto ok = renderer->set_lens(lens); !ok) return ok;
  const auto render = [&](int frame, Picture& plate, const Context& context) -> Result<Picture> {
    params::Values values = common.over(parameters_at(lights, frame));
    add_lights_at(lights, frame, values);
    const auto plan = plan_flare(plate, lens, values);
    if (!plan) return tl::unexpected(plan.error());
    const auto flare = render_flare(*plan, plate.rgb, values, *renderer, context);
    if (!flare) return tl::unexpected(flare.error());
    add_flare(plate.rgb, flare->image);
    return std::move(plate);
  };
  const auto write = [&](int frame, Picture& done) -> Result<void> {
    sheet.add(static_cast<std::size_t>(frame - frames.front()), done.rgb);
    return write_picture(flared.at(frame), done);
  };
  const auto failures = run_frames(frames, [&](int frame) { return read_picture(plates.at(frame)); }, render, write);
  if (!failures) return tl::unexpected(failures.error());
  if (!failures->empty()) return tl::unexpected(failures->front().error);
  return {};
}

}  // namespace

Result<MovingShot> flare_footage(const ShotSettings& settings, const LensState& lens, const params::Values& values,
                                 const fs::path& folder) {
  const ShotFiles plates(folder, "plate"), flared(folder, "flared");
  std::vector<int> frames(static_cast<std::size_t>(settings.frame_count));
  std::iota(frames.begin(), frames.end(), kFirstFrame);
  const auto lights = tracked_lights(settings, plates, frames, values.integer("max-lights"));
  if (!lights) return tl::unexpected(lights.error());
  MovingShot shot{lights->lights.size(), folder / "lights.toml", folder / "contact-sheet.png"};
  auto file = OutputFile::create(shot.lights_file);
  if (!file) return tl::unexpected(file.error());
  if (auto ok = file->write(write_animation(*lights)); !ok) return tl::unexpected(ok.error());
  if (auto ok = file->commit(); !ok) return tl::unexpected(ok.error());
  ContactSheet sheet(settings, frames.size());
  if (auto ok = flare_frames(plates, flared, frames, *lights, lens, values, sheet); !ok)
    return tl::unexpected(ok.error());
  if (auto ok = write_preview_png(shot.contact_sheet, sheet.image()); !ok) return tl::unexpected(ok.error());
  return shot;
}

}  // namespace contrejour::demo
