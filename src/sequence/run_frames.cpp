// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/run_frames.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <mutex>

#include "base/tasks.h"

namespace contrejour {
namespace {

// The frames that failed in any stage, and the one at which the run ends for that reason.
class Failures {
 public:
  Failures(bool keep_going, const Context& context) : keep_going_(keep_going), context_(context) {}

  void add(std::size_t i, int frame, Error error) {
    const std::scoped_lock lock(mutex_);
    if (!keep_going_) end_.store(std::min(end_.load(), i));
    list_.push_back({frame, std::move(error)});
  }

  // False for the frames after a failure: those before it are finished.
  [[nodiscard]] bool goes_on_at(std::size_t i) const { return i < end_.load() && !context_.cancelled(); }

  [[nodiscard]] std::vector<FrameFailure> by_frame() && {
    std::stable_sort(list_.begin(), list_.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
    return std::move(list_);
  }

 private:
  bool keep_going_;
  const Context& context_;
  std::atomic<std::size_t> end_ = std::numeric_limits<std::size_t>::max();
  std::mutex mutex_;
  std::vector<FrameFailure> list_;
};

// The progress of the frames that are rendered, several at once: the mean of all frames' own, which never falls.
class SequenceProgress {
 public:
  SequenceProgress(const Context& whole, std::size_t count) : whole_(whole), count_(static_cast<double>(count)) {}

  // A frame's context: its progress is a part of the sequence's.
  [[nodiscard]] Context of_frame(std::size_t i) {
    Context context = whole_;
    if (whole_.progress) context.progress = [this, i](double done) { report(i, done); };
    return context;
  }

  // Also of a frame that failed, of which there is no more to come.
  void end(std::size_t i) {
    const std::scoped_lock lock(mutex_);
    rendering_.erase(i);
    ++ended_;
  }

 private:
  void report(std::size_t i, double done) {
    const std::scoped_lock lock(mutex_);
    rendering_[i] = done;
    double sum = static_cast<double>(ended_);
    for (const auto& [frame, part] : rendering_) sum += part;
    reported_ = std::max(reported_, sum / count_);
    whole_.progress(reported_);
  }

  const Context& whole_;
  double count_;
  std::mutex mutex_;
  std::map<std::size_t, double> rendering_;  // the parts of frames that are done
  std::size_t ended_ = 0;
  double reported_ = 0.0;
};

}  // namespace

Result<std::vector<FrameFailure>> run_stages(const std::vector<int>& frames, const FrameStages& stages,
                                             const RunFramesOptions& options, const Context& context) {
  Failures failures(options.keep_going, context);
  SequenceProgress progress(context, frames.size());
  // The data of the next stage; null for a frame that failed or was cancelled.
  const auto data_or_null = [&](std::size_t i, FrameData data) -> StageItem {
    if (data) return std::move(*data);
    if (!context.cancelled()) failures.add(i, frames[i], std::move(data.error()));
    return nullptr;
  };
  const Stage read = [&](std::size_t i, const StageItem&) -> StageItem {
    StageItem data = failures.goes_on_at(i) ? data_or_null(i, stages.read(frames[i])) : nullptr;
    if (!data) progress.end(i);
    return data;
  };
  const Stage render = [&](std::size_t i, const StageItem& item) -> StageItem {
    StageItem data =
        failures.goes_on_at(i) ? data_or_null(i, stages.render(frames[i], item.get(), progress.of_frame(i))) : nullptr;
    progress.end(i);
    return data;
  };
  const Stage write = [&](std::size_t i, const StageItem& item) -> StageItem {
    if (context.cancelled()) return nullptr;
    if (auto written = stages.write(frames[i], item.get()); !written && !context.cancelled())
      failures.add(i, frames[i], std::move(written.error()));
    return nullptr;
  };
  const auto at_least_1 = [](int number) { return static_cast<std::size_t>(std::max(1, number)); };
  const std::size_t held = at_least_1(options.max_frames_held);
  staged_pipeline(frames.size(), held, {read, render, write},
                  std::min(held, at_least_1(options.frames_rendered_at_once)));
  if (context.cancelled()) return interrupted();
  return std::move(failures).by_frame();
}

}  // namespace contrejour
