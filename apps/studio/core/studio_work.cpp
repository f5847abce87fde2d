// SPDX-License-Identifier: Apache-2.0
// The studio's tasks besides its document and its picture: frames, snapshots, thumbnails, point spreads.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/settings.h"
#include "studio/core/keys.h"
#include "studio/core/plate_frames.h"
#include "studio/core/studio.h"

namespace contrejour::studio {
namespace {

constexpr std::size_t kMostSnapshots = 9;

}  // namespace

void Studio::take_background_work() {
  if (const auto exported = export_job_.take()) take_export(*exported);
  if (auto plate = plates_.take()) take_plate(std::move(*plate));
  if (auto detection = detection_job_.take()) take_detection(*detection);
  if (auto frames = frames_job_.take()) take_exported_frames(*frames);
  if (cache_job_.take()) ++changes_;
  if (auto views = views_job_.take()) {
    colour_views_ = std::move(*views);
    ++changes_;
  }
  if (auto comparison = compare_job_.take()) {
    comparison_ = std::move(comparison->figures);
    ++changes_;
  }
  if (auto thumbnails = thumbnail_job_.take()) {
    thumbnails_ = std::move(*thumbnails);
    ++changes_;
  }
  if (auto measured = measured_job_.take()) {
    if (!measured->error.empty()) take_problem(measured->error);
    measured_ = std::move(*measured);
    ++measured_count_;
    ++changes_;
  }
  if (auto spread = point_spread_job_.take()) {
    point_spread_ = std::move(*spread);
    ++point_spread_count_;
    ++changes_;
  }
}

void Studio::take_export(const ExportAnswer& answer) {
  if (!answer.error.empty()) return take_problem(answer.error);
  say(fmt::format("wrote {}", std::filesystem::absolute(answer.file).lexically_normal().string()));
}

void Studio::go_to_frame(int frame) {
  if (is_playing()) play(false);
  view.frame = std::clamp(frame, view.first_frame, view.last_frame);
  const bool is_other_plate = view.frame != frame_of_picture_ && is_plate_sequence(document().plate.file);
  if (is_other_plate && problem_key_.empty()) problem_.clear();  // that of the frame before
  Document then = document().animation == Animation{} ? document() : at_frame(document(), view.frame);
  if (then.texts == document().texts) {
    if (is_other_plate) post_picture();
    return;
  }
  auto lens = params::lens_of(*then.lens, then.values());
  if (!lens) return take_problem(lens.error().to_string());
  history_.replace_now(std::move(then));
  history_.seal();
  lens_ = std::make_shared<const LensState>(std::move(*lens));
  document_changed();
}

void Studio::play(bool plays) {
  if (!plays) {
    if (!std::exchange(playing_since_, std::nullopt)) return;
    cache_job_.post({});
    go_to_frame(view.frame);
    return refresh_display();
  }
  if (is_playing()) return;
  playing_from_ = view.frame;
  const bool is_sequence = is_plate_sequence(document().plate.file);
  CacheOrder order{revision_, history_.shared_now(), is_sequence ? nullptr : plate(), view.first_frame,
                   view.last_frame};
  order.now = std::clamp(view.frame, view.first_frame, view.last_frame);
  order.stops = shown_.stops;
  order.transform = view.transform;
  order.colour = view.colour;
  cache_job_.post(std::move(order));
  playing_since_ = std::chrono::steady_clock::now();
}

// At the speed of the shot where the frames are there, else as they come.
void Studio::show_playing_frame() {
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - *playing_since_;
  const int count = view.last_frame - view.first_frame + 1;
  const auto steps = static_cast<long long>(since.count() * view.frames_per_second);
  const int frame =
      view.first_frame + static_cast<int>((playing_from_ - view.first_frame + steps) % std::max(1, count));
  const auto shown = frame_cache_->find(frame);
  if (!shown || (frame == view.frame && shown_count_ > 0 && shown_.rgba == shown->rgba)) return;
  view.frame = frame;
  shown_ = *shown;
  ++shown_count_;
  ++changes_;
}

bool Studio::take_snapshot() {
  if (!picture_.image || picture_.kind != PictureKind::Refined)
    return refuse({ErrorCode::InvalidArgument, "wait for the refined picture, then take the snapshot", {}}, "");
  if (snapshots_.size() >= kMostSnapshots)
    return refuse({ErrorCode::InvalidArgument, fmt::format("remove one of the {} snapshots first", kMostSnapshots), {}},
                  "");
  auto thumbnail = std::make_shared<const Thumbnail>(reduced_codes(shown_.rgba, shown_.width, shown_.height));
  snapshots_.push_back(
      {fmt::format("Snapshot {}", ++snapshots_taken_), history_.shared_now(), picture_.image, std::move(thumbnail)});
  if (compare_.mode == CompareMode::Off) compare_.snapshot = snapshots_.size() - 1;
  say(fmt::format("took snapshot {}", snapshots_taken_));
  post_comparison();
  return true;
}

void Studio::remove_snapshot(std::size_t index) {
  if (index >= snapshots_.size()) return;
  snapshots_.erase(snapshots_.begin() + static_cast<std::ptrdiff_t>(index));
  CompareView compare = compare_;
  if (compare.snapshot >= index && compare.snapshot > 0) --compare.snapshot;
  if (snapshots_.empty()) compare.mode = CompareMode::Off;
  comparison_.reset();
  compare_ = compare;
  refresh_display();
  post_comparison();
}

bool Studio::restore_snapshot(std::size_t index) {
  if (index >= snapshots_.size()) return false;
  const Snapshot snapshot = snapshots_[index];
  return adopt_whole(*snapshot.document, fmt::format("back to {}", snapshot.name), "");
}

void Studio::set_compare(const CompareView& compare) {
  if (compare == compare_) return;
  const bool is_other = compare.snapshot != compare_.snapshot;
  compare_ = compare;
  refresh_display();
  if (is_other) post_comparison();
}

void Studio::post_comparison() {
  if (compare_.snapshot >= snapshots_.size() || !picture_.image || picture_.kind != PictureKind::Refined) return;
  compare_job_.post({snapshots_[compare_.snapshot].image, picture_.image});
}

void Studio::want_point_spread(bool wanted) {
  if (wants_point_spread_ == wanted) return;
  wants_point_spread_ = wanted;
  post_point_spread();
}

void Studio::post_point_spread() {
  if (wants_point_spread_) point_spread_job_.post({document().values(), lens_, selection.light});
}

void Studio::want_colour_views() {
  if (!std::exchange(wants_colour_views_, true)) views_job_.post({});
}

void Studio::want_thumbnails() { thumbnail_job_.post({looks_, look_folders_.thumbnails}); }

}  // namespace contrejour::studio
