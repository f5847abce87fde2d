// SPDX-License-Identifier: Apache-2.0
// Adds to one number from several threads without synchronisation: ThreadSanitizer must report it. Built only with the
// thread sanitizer, to show that the annotations in base/tasks.cpp do not hide races of the library.
#include <cstdio>
#include <vector>

#include "base/tasks.h"
#include "support/tsan_suppressions.h"

int main() {
  contrejour::Context context;
  context.threads = 4;
  std::vector<int> work(1000, 1);
  int sum = 0;
  contrejour::parallel_for(work.size(), context, [&](std::size_t i) {
    for (int k = 0; k < 20000; ++k) work[i] ^= k;
    sum += work[i];
  });
  std::printf("%d\n", sum);
  return 0;
}
