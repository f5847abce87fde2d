// SPDX-License-Identifier: Apache-2.0
// A long computation takes these from its caller: threads, cancelling, a progress report, and when to rest.
// The result is the same, bit for bit, for any number of threads. Thread-safety: `cancelled` and `progress`
// may be called from any worker thread, progress never from two at once.
#pragma once

#include <atomic>
#include <functional>

namespace contrejour {

struct Context {
  int threads = 0;                            // 0: all cores
  const std::atomic<bool>* cancel = nullptr;  // set it to stop; null: cannot be stopped
  std::function<void(double done)> progress = {};  // 0..1, rising; may be empty
  // While it is set, threads start no new part of the work, for 8 ms at most: so a program that renders in the
  // background can draw its window without waiting for a processor. Null: they never rest.
  const std::atomic<bool>* hold = nullptr;

  [[nodiscard]] bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
};

}  // namespace contrejour
