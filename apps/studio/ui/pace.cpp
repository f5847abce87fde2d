// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/pace.h"

#include <algorithm>

namespace contrejour::studio {
namespace {

constexpr std::size_t kMostKept = 100000;

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(part * static_cast<double>(values.size())))];
}

}  // namespace

void Pace::frame(double from_s, double to_s) {
  if (frames_ms_.size() < kMostKept) frames_ms_.push_back(1000 * (to_s - from_s));
}

void Pace::changed(std::uint64_t revision, double input_s) {
  changes_.push_back({revision, input_s});
  if (changes_.size() > kMostKept) changes_.pop_front();
}

// Earlier revisions were passed over. Their inputs are answered by this picture, too; the latest one counts.
void Pace::shown(std::uint64_t revision, double now_s) {
  double input_s = -1;
  while (!changes_.empty() && changes_.front().revision <= revision) {
    input_s = changes_.front().input_s;
    changes_.pop_front();
  }
  if (input_s < 0 || latencies_ms_.size() >= kMostKept) return;
  if (latencies_ms_.empty()) first_picture_s_ = now_s;
  last_picture_s_ = now_s;
  latencies_ms_.push_back(1000 * (now_s - input_s));
}

void Pace::clear() { *this = Pace(); }

Pace::Summary Pace::summary() const {
  Summary s;
  s.frames = frames_ms_.size();
  s.pictures = latencies_ms_.size();
  s.frame_p50_ms = quantile(frames_ms_, 0.5);
  s.frame_p99_ms = quantile(frames_ms_, 0.99);
  s.frame_max_ms = quantile(frames_ms_, 1.0);
  s.latency_p50_ms = quantile(latencies_ms_, 0.5);
  s.latency_p99_ms = quantile(latencies_ms_, 0.99);
  if (s.pictures > 1 && last_picture_s_ > first_picture_s_)
    s.pictures_per_s = static_cast<double>(s.pictures - 1) / (last_picture_s_ - first_picture_s_);
  return s;
}

}  // namespace contrejour::studio
