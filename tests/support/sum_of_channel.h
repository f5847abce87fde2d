// SPDX-License-Identifier: Apache-2.0
// The sum of a picture's channel.
#pragma once

#include "contrejour/image.h"

namespace contrejour::test {

inline double sum_of_channel(const Image& image, int channel) {
  double sum = 0.0;
  for (std::size_t k = static_cast<std::size_t>(channel); k < image.pixels.size(); k += 3) sum += image.pixels[k];
  return sum;
}

}  // namespace contrejour::test
