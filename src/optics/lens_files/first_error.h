// The first thing that is wrong with a file: readers go on without it and stop when they can.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "contrejour/result.h"

namespace contrejour {

struct FirstError {
  std::string file;
  std::optional<Error> first;

  void fail(int line, std::string message, ErrorCode code = ErrorCode::Parse) {
    if (!first) first = Error{code, std::move(message), {file, line, 0}};
  }
};

}  // namespace contrejour
