// SPDX-License-Identifier: Apache-2.0
#include "studio/core/thread_priority.h"

#if defined(__linux__)
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#elif defined(__APPLE__)
#include <pthread.h>
#elif defined(_WIN32)
#include <windows.h>
#endif

namespace contrejour::studio {

void lower_priority_of_this_thread() {
#if defined(__linux__)
  // Ten steps give a thread a tenth of the time of one at the usual priority that wants the same core (setpriority(2),
  // sched(7)). In Linux each thread has its own value, and a new thread has that of the one that starts it.
  constexpr int kSteps = 10;
  const auto thread = static_cast<id_t>(syscall(SYS_gettid));
  setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + kSteps);  // the system caps it
#elif defined(__APPLE__)
  pthread_set_qos_class_self_np(QOS_CLASS_UTILITY, 0);
#elif defined(_WIN32)
  SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL);
#endif
}

}  // namespace contrejour::studio
