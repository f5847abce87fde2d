// SPDX-License-Identifier: Apache-2.0
#include "image/exr_threads.h"

#include <algorithm>
#include <mutex>

#include <ImfThreading.h>

#include "base/tasks.h"

namespace contrejour::inline internal {

int exr_threads(const Context& context) {
  constexpr int kMaxThreads = 16;  // more compress faster than a disk writes
  const int threads = std::min(thread_count(context), kMaxThreads);
  if (threads <= 1) return 0;
  static std::mutex mutex;  // two files at once may both enlarge the pool
  const std::lock_guard lock(mutex);
  if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
  return threads;
}

}  // namespace contrejour::inline internal
