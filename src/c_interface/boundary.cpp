// SPDX-License-Identifier: Apache-2.0
#include "c_interface/boundary.h"

#include <exception>
#include <new>
#include <string>

namespace contrejour::inline internal {
namespace {

// The longest beginning of a text that fits and does not end within a character of several bytes.
std::size_t length_that_fits(std::string_view text, std::size_t size) {
  if (text.size() <= size) return text.size();
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return size;
}

void write_error(cj_error* to, cj_status status, SourcePosition position, std::string_view message) noexcept {
  if (to == nullptr || to->struct_size < sizeof(cj_error)) return;
  to->status = status;
  to->line = position.line;
  to->column = position.column;
  const std::size_t length = length_that_fits(message, CJ_MESSAGE_SIZE - 1);
  std::memcpy(to->message, message.data(), length);
  to->message[length] = '\0';
}

}  // namespace

cj_status status_of(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::InvalidArgument: return CJ_INVALID_ARGUMENT;
    case ErrorCode::Parse: return CJ_PARSE;
    case ErrorCode::Io: return CJ_IO;
    case ErrorCode::Unsupported: return CJ_UNSUPPORTED;
    case ErrorCode::Cancelled: return CJ_CANCELLED;
  }
  return CJ_INTERNAL;
}

void describe_failure(cj_error* to, cj_status status, const Error& error) noexcept {
  try {
    write_error(to, status, error.position, error.to_string());
  } catch (...) {
    write_error(to, status, {}, "no memory to describe the error");
  }
}

cj_status status_of_exception(cj_error* to) noexcept {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    write_error(to, CJ_OUT_OF_MEMORY, {}, "there is not enough memory; give a smaller picture or fewer rays");
    return CJ_OUT_OF_MEMORY;
  } catch (const std::exception& exception) {
    write_error(to, CJ_INTERNAL, {}, exception.what());
  } catch (...) {
    write_error(to, CJ_INTERNAL, {}, "an unknown exception; please report this error");
  }
  return CJ_INTERNAL;
}

}  // namespace contrejour::inline internal

const char* cj_status_name(cj_status status) {
  switch (status) {
    case CJ_OK: return "ok";
    case CJ_INVALID_ARGUMENT: return "invalid argument";
    case CJ_PARSE: return "parse";
    case CJ_IO: return "io";
    case CJ_UNSUPPORTED: return "unsupported";
    case CJ_CANCELLED: return "cancelled";
    case CJ_OUT_OF_MEMORY: return "out of memory";
    case CJ_INTERNAL: return "internal";
    default: return "unknown status";
  }
}
