// SPDX-License-Identifier: Apache-2.0
#include "native/arrays.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace contrejour::python {
namespace {

constexpr py::ssize_t kLargestSide = std::numeric_limits<int>::max();

}  // namespace

py::array array_of(Image&& image) {
  auto pixels = std::make_unique<Pixels>(std::move(image.pixels));
  const float* const data = pixels->data();
  const py::capsule owner(pixels.get(), [](void* memory) { delete static_cast<Pixels*>(memory); });
  static_cast<void>(pixels.release());
  return py::array_t<float>({image.height, image.width, image.channels}, data, owner);
}

Image image_of(const PixelArray& pixels) {
  if (pixels.ndim() != 3 || pixels.shape(2) < 1 || pixels.shape(0) > kLargestSide || pixels.shape(1) > kLargestSide)
    throw py::value_error("a picture has the shape (height, width, channels)");
  const int channels = static_cast<int>(std::min<py::ssize_t>(3, pixels.shape(2)));
  Image image = Image::unwritten(static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)), channels);
  const auto all_channels = static_cast<std::size_t>(pixels.shape(2));
  const float* from = pixels.data();
  float* to = image.pixels.data();
  const std::size_t count = image.pixels.size() / static_cast<std::size_t>(channels);
  for (std::size_t k = 0; k < count; ++k, from += all_channels, to += channels) std::copy_n(from, channels, to);
  return image;
}

ImageView view_of(py::array& pixels) {
  const bool is_half = pixels.dtype().kind() == 'f' && pixels.itemsize() == 2;
  const bool is_float = pixels.dtype().kind() == 'f' && pixels.itemsize() == 4;
  if (!is_half && !is_float) throw py::type_error("out: the array's type is not float32 or float16");
  if (pixels.ndim() != 3 || pixels.shape(2) < 3 || pixels.shape(0) > kLargestSide || pixels.shape(1) > kLargestSide)
    throw py::value_error("out: the array's shape is not (height, width, 3 or more)");
  ImageView view;
  view.pixels = pixels.mutable_data();  // throws where the array is not writeable
  view.height = static_cast<int>(pixels.shape(0));
  view.width = static_cast<int>(pixels.shape(1));
  view.type = is_half ? PixelType::Half : PixelType::Float;
  view.row_step = pixels.strides(0);
  view.pixel_step = pixels.strides(1);
  view.channel_step = pixels.strides(2);
  return view;
}

py::ssize_t check_vectors(const VectorArray& vectors, const char* name) {
  if (vectors.ndim() == 2 && vectors.shape(1) == 3) return vectors.shape(0);
  throw py::value_error(std::string(name) + ": the array's shape is not (n, 3)");
}

}  // namespace contrejour::python
