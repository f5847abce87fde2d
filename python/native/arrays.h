// SPDX-License-Identifier: Apache-2.0
// NumPy's arrays and the library's images.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "contrejour/image.h"
#include "contrejour/image_view.h"

namespace contrejour::python {

namespace py = pybind11;

// float32 of shape (height, width, channels); other types are converted.
using PixelArray = py::array_t<float, py::array::c_style | py::array::forcecast>;
// float64 of shape (n, 3).
using VectorArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

// The image's own memory as an array of shape (height, width, channels), which owns it from then on.
[[nodiscard]] py::array array_of(Image&& image);

// A copy of the first three channels, or of all of an image with fewer. Errors: a shape that is no picture's.
[[nodiscard]] Image image_of(const PixelArray& pixels);

// A caller's float32 or float16 array of shape (height, width, 3 or more), of any strides, as it lies in memory.
// Errors: another type or shape; an array that is not writeable.
[[nodiscard]] ImageView view_of(py::array& pixels);

// The n rows of three numbers. Errors: another shape.
[[nodiscard]] py::ssize_t check_vectors(const VectorArray& vectors, const char* name);

}  // namespace contrejour::python
