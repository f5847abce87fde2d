// SPDX-License-Identifier: Apache-2.0
// Keeps the first error in a file: readers continue after it and stop where they can.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "contrejour/result.h"

namespace contrejour::inline internal {

struct FirstError {
  std::string file;
  std::optional<Error> first;

  void fail(int line, std::string message, ErrorCode code = ErrorCode::Parse) {
    if (!first) first = Error{code, std::move(message), {file, line, 0}};
  }
};

}  // namespace contrejour::inline internal
