// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/frame_error.h"

#include <algorithm>

namespace contrejour::inline internal::adaptive {

std::vector<std::size_t> above_error_limit(std::vector<std::size_t> some, const std::vector<double>& error,
                                           double allowed) {
  std::stable_sort(some.begin(), some.end(), [&](std::size_t a, std::size_t b) { return error[a] < error[b]; });
  double sum = 0.0;
  const auto first = std::find_if(some.begin(), some.end(), [&](std::size_t k) { return (sum += error[k]) > allowed; });
  some.erase(some.begin(), first);
  std::sort(some.begin(), some.end());
  return some;
}

}  // namespace contrejour::inline internal::adaptive
