// SPDX-License-Identifier: Apache-2.0
#include "openfx/host_abort.h"

#include <chrono>
#include <future>

namespace contrejour::openfx {

void run_abortable(const std::function<bool()>& host_aborts,
                   const std::function<void(const std::atomic<bool>& cancel)>& work) {
  constexpr std::chrono::milliseconds kBetweenQuestions(10);
  std::atomic<bool> cancel = false;
  auto done = std::async(std::launch::async, [&] { work(cancel); });
  while (done.wait_for(kBetweenQuestions) != std::future_status::ready)
    if (host_aborts()) cancel = true;
  done.get();
}

}  // namespace contrejour::openfx
