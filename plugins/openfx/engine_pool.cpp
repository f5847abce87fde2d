// SPDX-License-Identifier: Apache-2.0
#include "openfx/engine_pool.h"

#include <algorithm>
#include <utility>

namespace contrejour::openfx {

std::unique_ptr<FlareEngine> EnginePool::take(const void* instance) {
  const std::lock_guard lock(mutex_);
  if (idle_.empty()) return std::make_unique<FlareEngine>();
  auto found = std::ranges::find(idle_, instance, &Idle::last_instance);
  if (found == idle_.end()) --found;
  auto engine = std::move(found->engine);
  idle_.erase(found);
  return engine;
}

void EnginePool::give_back(std::unique_ptr<FlareEngine> engine, const void* instance) {
  std::unique_ptr<FlareEngine> surplus;  // destroyed without the lock
  const std::lock_guard lock(mutex_);
  idle_.push_back({std::move(engine), instance});
  if (idle_.size() <= kMostIdle) return;
  surplus = std::move(idle_.front().engine);
  idle_.erase(idle_.begin());
}

void EnginePool::clear() {
  std::vector<Idle> all;
  const std::lock_guard lock(mutex_);
  all.swap(idle_);
}

}  // namespace contrejour::openfx
