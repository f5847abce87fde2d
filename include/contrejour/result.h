// SPDX-License-Identifier: Apache-2.0
// Result<T>: a value, or an Error that names what is wrong, where, and what to do.
// No exception crosses a library edge; a ray that fails is data (trace.h), not an Error.
// Thread-safety: plain values.
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

#include "contrejour/export.h"

namespace contrejour {

enum class ErrorCode {
  InvalidArgument,  // a value out of its range
  Parse,            // a file that is not what its format says
  Io,               // cannot open, read or write
  Unsupported,      // understood, but not modelled
  Cancelled,        // the caller asked to stop
};

// A position in a user's file; line and column count from 1, 0 means unknown.
struct SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;
};

struct CONTREJOUR_API Error {
  ErrorCode code = ErrorCode::InvalidArgument;
  std::string message;  // what is wrong and what to do, no trailing newline
  SourcePosition position;

  // "file:line: message", without the parts that are unknown.
  [[nodiscard]] std::string to_string() const;
};

template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> failure(ErrorCode code, std::string message, SourcePosition position = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), std::move(position)});
}

[[nodiscard]] inline tl::unexpected<Error> invalid_argument(std::string message) {
  return failure(ErrorCode::InvalidArgument, std::move(message));
}

}  // namespace contrejour
