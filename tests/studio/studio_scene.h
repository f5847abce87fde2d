// SPDX-License-Identifier: Apache-2.0
// A scene that is quick to render, and waiting for a studio without a window.
#pragma once

#include <chrono>
#include <thread>

#include "studio/core/studio.h"

namespace contrejour::studio {

inline Document small_scene() {
  return *with_value(*with_value(first_document(), "size", "96x64"), "starburst", "off");
}

inline void run_until_idle(Studio& studio) {
  using namespace std::chrono_literals;
  const auto start = std::chrono::steady_clock::now();
  do {
    studio.update();
    std::this_thread::sleep_for(1ms);
  } while (!studio.is_idle() && std::chrono::steady_clock::now() - start < 60s);
  studio.update();
}

}  // namespace contrejour::studio
