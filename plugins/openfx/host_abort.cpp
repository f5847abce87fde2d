// SPDX-License-Identifier: Apache-2.0
#include "openfx/host_abort.h"

#include <chrono>
#include <utility>

namespace contrejour::openfx {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kBetweenQuestions(10), kToEnd(30);

bool is_done(const std::future<void>& done, milliseconds within) {
  return done.wait_for(within) == std::future_status::ready;
}

}  // namespace

bool AbortableRuns::run(const std::function<bool()>& host_aborts, Work work) {
  auto cancel = std::make_unique<std::atomic<bool>>(false);
  auto done = std::async(std::launch::async, [work = std::move(work), flag = cancel.get()] { work(*flag); });
  while (!is_done(done, kBetweenQuestions)) {
    if (!host_aborts()) continue;
    *cancel = true;
    if (is_done(done, kToEnd)) break;
    leave({std::move(cancel), std::move(done)});
    return false;
  }
  done.get();
  return !*cancel;
}

// Cancelled work must not pile up while a user drags on and on.
void AbortableRuns::leave(Run run) {
  std::vector<Run> ended;  // whose ends are waited for without the lock
  const std::lock_guard lock(mutex_);
  std::erase_if(ending_, [](const Run& other) { return is_done(other.done, milliseconds(0)); });
  ending_.push_back(std::move(run));
  if (ending_.size() <= kMostEnding) return;
  ended.push_back(std::move(ending_.front()));
  ending_.erase(ending_.begin());
}

}  // namespace contrejour::openfx
