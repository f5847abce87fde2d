// SPDX-License-Identifier: Apache-2.0
// Copies computed pixels into a large picture. If the picture exceeds the caches, stores bypass them, since they would
// first read the memory that is overwritten: on some processors rows of 6 KB of a frame of 25 MB take half to a third
// of the time.
#pragma once

#include <cstddef>

#include "contrejour/image.h"

namespace contrejour::inline internal {

// Thread-safety: one writer a thread. Its stores are visible to other threads after its destruction.
class PixelWriter {
 public:
  explicit PixelWriter(const Image& image);  // the destination of all writes
  ~PixelWriter();
  PixelWriter(const PixelWriter&) = delete;
  PixelWriter& operator=(const PixelWriter&) = delete;

  void write(const float* from, std::size_t count, float* to) const;
  void clear(std::size_t count, float* to) const;

 private:
  bool past_caches_;
};

}  // namespace contrejour::inline internal
