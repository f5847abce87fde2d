// SPDX-License-Identifier: Apache-2.0
// Errors of the library as Python's exceptions (contrejour/_errors.py).
#pragma once

#include <utility>

#include <pybind11/pybind11.h>

#include "contrejour/result.h"

namespace contrejour::python {

namespace py = pybind11;

// Thrown by the functions of the module; add_errors() makes it a Python exception.
struct LibraryError {
  Error error;
};

// The value, or the error as an exception.
template <class T>
T value_of(Result<T> result) {
  if (!result) throw LibraryError{std::move(result.error())};
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

void add_errors();

}  // namespace contrejour::python
