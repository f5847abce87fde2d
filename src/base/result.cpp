// SPDX-License-Identifier: Apache-2.0
#include "contrejour/result.h"

namespace contrejour {

std::string Error::to_string() const {
  std::string text;
  if (!place.file.empty()) {
    text = place.file + ":";
    if (place.line > 0) text += std::to_string(place.line) + ":";
    text += " ";
  }
  return text + message;
}

}  // namespace contrejour
