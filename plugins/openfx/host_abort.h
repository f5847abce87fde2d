// SPDX-License-Identifier: Apache-2.0
// Computations that a host may abort. Thread-safety: all functions may be called at any time.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <vector>

namespace contrejour::openfx {

class AbortableRuns {
 public:
  using Work = std::function<void(const std::atomic<bool>& cancel)>;

  AbortableRuns() = default;
  AbortableRuns(const AbortableRuns&) = delete;
  AbortableRuns& operator=(const AbortableRuns&) = delete;
  ~AbortableRuns() = default;  // waits for what still runs

  // Runs the work on a thread of its own, while the calling thread, the host's, asks every few milliseconds whether to
  // stop: hosts know by the thread which render they are asked about, and the library's threads are not theirs.
  // Returns whether the work was done. If not, it was cancelled and may still be ending, so that it must own whatever
  // it touches; some methods take a few tenths of a second to end. What the work throws is thrown here.
  [[nodiscard]] bool run(const std::function<bool()>& host_aborts, Work work);

 private:
  struct Run {
    std::unique_ptr<std::atomic<bool>> cancel;
    std::future<void> done;
  };
  void leave(Run run);

  static constexpr std::size_t kMostEnding = 4;
  std::mutex mutex_;
  std::vector<Run> ending_;
};

}  // namespace contrejour::openfx
