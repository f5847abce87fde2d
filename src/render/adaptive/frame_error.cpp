#include "render/adaptive/frame_error.h"

#include <algorithm>

namespace contrejour::adaptive {

double even_share(std::vector<double> most, double allowed) {
  std::sort(most.begin(), most.end());
  double left = allowed;
  for (std::size_t k = 0; k < most.size(); ++k) {
    const double share = left / static_cast<double>(most.size() - k);
    if (most[k] >= share) return share;
    left -= most[k];
  }
  return allowed;
}

std::vector<std::size_t> worth_drawing(std::vector<std::size_t> some, const std::vector<double>& error,
                                       double allowed) {
  std::stable_sort(some.begin(), some.end(), [&](std::size_t a, std::size_t b) { return error[a] < error[b]; });
  double sum = 0.0;
  const auto first = std::find_if(some.begin(), some.end(), [&](std::size_t k) { return (sum += error[k]) > allowed; });
  some.erase(some.begin(), first);
  std::sort(some.begin(), some.end());
  return some;
}

}  // namespace contrejour::adaptive
