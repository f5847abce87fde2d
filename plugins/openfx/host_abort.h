// SPDX-License-Identifier: Apache-2.0
// A computation that ends soon after the host asks for it. Thread-safety: pure functions.
#pragma once

#include <atomic>
#include <functional>

namespace contrejour::openfx {

// Runs the work on a thread of its own, while the calling thread, the host's, asks every few milliseconds whether to
// stop: hosts know by the thread which render they are asked about, and the library's threads are not theirs. Returns
// when the work is done. What the work throws is thrown here.
void run_abortable(const std::function<bool()>& host_aborts,
                   const std::function<void(const std::atomic<bool>& cancel)>& work);

}  // namespace contrejour::openfx
