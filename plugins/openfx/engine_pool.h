// SPDX-License-Identifier: Apache-2.0
// The engines that no frame is using. Each render takes one and gives it back, so that any number of instances render
// on any threads, without waiting for each other; and hosts that make an instance for each frame keep what frames have
// in common. Thread-safety: all functions may be called at any time.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "openfx/flare_engine.h"

namespace contrejour::openfx {

class EnginePool {
 public:
  // The engine that this instance used last, if it is idle; else the one given back last; else a new one.
  [[nodiscard]] std::unique_ptr<FlareEngine> take(const void* instance);
  void give_back(std::unique_ptr<FlareEngine> engine, const void* instance);
  void clear();

 private:
  static constexpr std::size_t kMostIdle = 4;  // each holds the scratch memory of a frame
  struct Idle {
    std::unique_ptr<FlareEngine> engine;
    const void* last_instance;
  };

  std::mutex mutex_;
  std::vector<Idle> idle_;  // the one given back last is at the end
};

}  // namespace contrejour::openfx
