// SPDX-License-Identifier: Apache-2.0
#include "native/errors.h"

#include <exception>

namespace contrejour::python {
namespace {

const char* exception_name(ErrorCode code) {
  switch (code) {
    case ErrorCode::InvalidArgument: return "InvalidArgumentError";
    case ErrorCode::Parse: return "ParseError";
    case ErrorCode::Io: return "IoError";
    case ErrorCode::Unsupported: return "UnsupportedError";
    case ErrorCode::Cancelled: return "CancelledError";
  }
  return "Error";
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const LibraryError& library) {
    const py::object type = py::module_::import("contrejour._errors").attr(exception_name(library.error.code));
    PyErr_SetObject(type.ptr(), py::str(library.error.to_string()).ptr());
  }
}

}  // namespace

void add_errors() { py::register_exception_translator(translate); }

}  // namespace contrejour::python
