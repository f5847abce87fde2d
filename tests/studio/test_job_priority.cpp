// SPDX-License-Identifier: Apache-2.0
// Threads of jobs: those that render have a lower priority than the window.
#include <algorithm>
#include <optional>

#if defined(__linux__)
#include <sys/resource.h>
#endif

#include <doctest/doctest.h>

#include "studio/core/latest_job.h"

namespace contrejour::studio {
namespace {

TEST_CASE("jobs that render leave the interface the processor") {
#if defined(__linux__)
  const int usual = getpriority(PRIO_PROCESS, 0);
  const auto priority_in = [](JobPriority priority) {
    LatestJob<int, int> job([](const int&, auto& control) { control.publish(getpriority(PRIO_PROCESS, 0)); }, {},
                            priority);
    job.post(1);
    std::optional<int> answer;
    while (!answer) answer = job.take();
    return *answer;
  };
  CHECK(priority_in(JobPriority::Interface) == usual);
  CHECK(priority_in(JobPriority::Background) == std::min(19, usual + 10));
#endif
}

}  // namespace
}  // namespace contrejour::studio
