// SPDX-License-Identifier: Apache-2.0
// The rows of a picture, divided among as many threads as the machine has.
#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace contrejour::demo {

template <class Fill>
void for_each_row(int height, const Fill& fill) {
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const auto fill_rows = [&](int first) {
    for (int y = first; y < height; y += threads) fill(y);
  };
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(fill_rows, t);
  fill_rows(0);
  for (std::thread& other : others) other.join();
}

}  // namespace contrejour::demo
