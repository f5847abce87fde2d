// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/pace.h"

#include <algorithm>
#include <ctime>
#include <numeric>

namespace contrejour::studio {
namespace {

constexpr std::size_t kMostKept = 100000;

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(part * static_cast<double>(values.size())))];
}

}  // namespace

void Pace::frame(double from_s, double to_s, double processor_s, double drawn_part) {
  if (frames_ms_.size() >= kMostKept) return;
  frames_ms_.push_back(1000 * (to_s - from_s));
  processor_ms_.push_back(1000 * processor_s);
  drawn_parts_.push_back(drawn_part);
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

double processor_time_s() {
#if defined(CLOCK_THREAD_CPUTIME_ID)
  timespec time{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0)
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
#endif
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void Pace::clear() { *this = Pace(); }

Pace::Summary Pace::summary() const {
  Summary s;
  s.frames = frames_ms_.size();
  s.pictures = latencies_ms_.size();
  s.frame_p50_ms = quantile(frames_ms_, 0.5);
  s.frame_p99_ms = quantile(frames_ms_, 0.99);
  s.frame_max_ms = quantile(frames_ms_, 1.0);
  s.processor_p50_ms = quantile(processor_ms_, 0.5);
  s.processor_p99_ms = quantile(processor_ms_, 0.99);
  if (s.frames > 0)
    s.drawn_part = std::accumulate(drawn_parts_.begin(), drawn_parts_.end(), 0.0) / static_cast<double>(s.frames);
  s.latency_p50_ms = quantile(latencies_ms_, 0.5);
  s.latency_p99_ms = quantile(latencies_ms_, 0.99);
  if (s.pictures > 1 && last_picture_s_ > first_picture_s_)
    s.pictures_per_s = static_cast<double>(s.pictures - 1) / (last_picture_s_ - first_picture_s_);
  return s;
}

}  // namespace contrejour::studio
