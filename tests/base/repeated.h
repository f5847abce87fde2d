// SPDX-License-Identifier: Apache-2.0
// Long texts that readers must refuse.
#pragma once

#include <string>

namespace contrejour {

inline std::string repeated(const std::string& piece, std::size_t times) {
  std::string out;
  for (std::size_t k = 0; k < times; ++k) out += piece;
  return out;
}

}  // namespace contrejour
