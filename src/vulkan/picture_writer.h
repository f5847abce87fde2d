// SPDX-License-Identifier: Apache-2.0
// Writes a picture that is on the device to a caller's image or buffer, in one submission, some rows at a time where
// the device's buffers hold no more. Failures are exceptions, as DeviceContext's. Thread-safety: one thread at a time.
#pragma once

#include <cstdint>
#include <span>

#include "contrejour/expert/vulkan_target.h"
#include "vulkan/device_context.h"

namespace contrejour::inline internal::vulkan {

// A picture of three floats a pixel: in Slot::Picture, or row by row in a buffer of its own.
struct StoredPicture {
  int width = 0, height = 0;
  const Buffer* rows = nullptr;  // null: it is in Slot::Picture, as a whole
};

class PictureWriter {
 public:
  // most_rows: DeviceOptions::most_rows. All must outlive the writer.
  PictureWriter(DeviceContext& device, const DeviceInfo& info, int most_rows, const VulkanTarget& target);

  void write(const StoredPicture& picture);

 private:
  [[nodiscard]] int rows_a_band(const StoredPicture& picture) const;
  void convert(const StoredPicture& picture, int first_row, int rows);
  void copy_rows(const StoredPicture& picture, int first_row, int rows);
  void open();   // barriers: the image or buffer may be written
  void close();  // and was written

  DeviceContext& device_;
  const DeviceInfo& info_;
  int most_rows_;
  const VulkanTarget& target_;
  std::uint32_t format_, pixel_bytes_;
};

}  // namespace contrejour::inline internal::vulkan
