// SPDX-License-Identifier: Apache-2.0
// Adds the starbursts of lights to the picture on the device, as add_starburst() adds them on the CPU: in single
// precision, to 2e-3 of each pixel's own value (docs/gpu.md). Lights are added in their order, so that the bits are the
// same each time. Failures are exceptions, as DeviceContext's. Thread-safety: one thread at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vulkan/device_context.h"
#include "vulkan/starburst_words.h"

namespace contrejour::inline internal::vulkan {

// The patterns that stay on the device from frame to frame, and the words at which they begin.
struct StarburstKept {
  std::vector<Starburst> patterns;
  std::vector<std::uint32_t> at;
};

class StarburstStage {
 public:
  // All must outlive the stage. The patterns are uploaded unless the device has them.
  StarburstStage(DeviceContext& device, const DeviceInfo& info, std::span<const PlacedStarburst> lights,
                 StarburstKept& kept);

  [[nodiscard]] std::uint64_t added() const { return fits_ ? lights_.size() : 0; }
  // Whether it adds all lights that the job has.
  [[nodiscard]] bool has_all() const { return lights_.empty() || fits_; }
  [[nodiscard]] std::uint64_t uploaded_bytes() const { return uploaded_bytes_; }
  // Adds the starbursts to Slot::Picture, which holds rows of the frame; part of a submission, after a barrier. Another
  // one follows the last dispatch.
  void draw(int width, int height, int first_row);

 private:
  [[nodiscard]] bool upload_patterns();
  [[nodiscard]] std::vector<std::uint32_t> patterns_of_lights() const;  // the words at which they begin
  [[nodiscard]] std::uint32_t count_of_lights() const { return static_cast<std::uint32_t>(lights_.size()); }
  void draw_about(StarburstParameters p, int pixels, std::uint32_t sharing);

  DeviceContext& device_;
  const DeviceInfo& info_;
  std::span<const PlacedStarburst> lights_;
  StarburstKept& kept_;
  bool fits_ = false;
  std::uint64_t uploaded_bytes_ = 0;
};

}  // namespace contrejour::inline internal::vulkan
