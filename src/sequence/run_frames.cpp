// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/run_frames.h"

#include <algorithm>
#include <atomic>
#include <limits>
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

// A frame's context: its progress is a part of the sequence's.
Context frame_context(const Context& whole, std::size_t i, std::size_t count) {
  Context context = whole;
  if (whole.progress)
    context.progress = [&whole, i, count](double done) {
      whole.progress((static_cast<double>(i) + done) / static_cast<double>(count));
    };
  return context;
}

}  // namespace

Result<std::vector<FrameFailure>> run_stages(const std::vector<int>& frames, const FrameStages& stages,
                                             const RunFramesOptions& options, const Context& context) {
  Failures failures(options.keep_going, context);
  // The data of the next stage; null for a frame that failed or was cancelled.
  const auto data_or_null = [&](std::size_t i, FrameData data) -> StageItem {
    if (data) return std::move(*data);
    if (!context.cancelled()) failures.add(i, frames[i], std::move(data.error()));
    return nullptr;
  };
  const Stage read = [&](std::size_t i, const StageItem&) -> StageItem {
    return failures.goes_on_at(i) ? data_or_null(i, stages.read(frames[i])) : nullptr;
  };
  const Stage render = [&](std::size_t i, const StageItem& item) -> StageItem {
    if (!failures.goes_on_at(i)) return nullptr;
    return data_or_null(i, stages.render(frames[i], item.get(), frame_context(context, i, frames.size())));
  };
  const Stage write = [&](std::size_t i, const StageItem& item) -> StageItem {
    if (context.cancelled()) return nullptr;
    if (auto written = stages.write(frames[i], item.get()); !written && !context.cancelled())
      failures.add(i, frames[i], std::move(written.error()));
    return nullptr;
  };
  staged_pipeline(frames.size(), static_cast<std::size_t>(std::max(1, options.max_frames_held)), {read, render, write});
  if (context.cancelled()) return interrupted();
  return std::move(failures).by_frame();
}

}  // namespace contrejour
