// SPDX-License-Identifier: Apache-2.0
#include "contrejour/result.h"

namespace contrejour {

std::string Error::to_string() const {
  std::string text;
  if (!position.file.empty()) {
    text = position.file + ":";
    if (position.line > 0) text += std::to_string(position.line) + ":";
    text += " ";
  }
  return text + message;
}

}  // namespace contrejour
