// SPDX-License-Identifier: Apache-2.0
// Draws an AdaptiveJob in one submission: the device finds pupils, distributes the error, and decides how many rays and
// polygons there are; the host learns only whether the buffers sufficed. Failures are exceptions, as DeviceContext's.
// Thread-safety: one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "vulkan/adaptive_layout.h"
#include "vulkan/device_context.h"
#include "vulkan/layout.h"

namespace contrejour::inline internal::vulkan {

// Sizes of buffers that grow to the largest frame; smaller ones cost another try.
struct AdaptiveCapacity {
  std::uint64_t rays = std::uint64_t{1} << 19U;
  std::uint64_t polygons = std::uint64_t{1} << 18U;
  std::uint64_t corners = std::uint64_t{1} << 20U;
  std::uint64_t cut_cells = std::uint64_t{1} << 18U;
  std::uint64_t tile_entries = std::uint64_t{1} << 21U;
};

// The data that stay on the device from frame to frame, and the sizes of its buffers.
struct AdaptiveKept {
  AdaptiveCapacity capacity;
  std::shared_ptr<const DevicePaths> paths;  // that are uploaded; null: none
  std::vector<PathPlace> places;  // by path
  std::shared_ptr<const DevicePatterns> patterns;  // that are uploaded
};

class AdaptiveFrame {
 public:
  // All must outlive the frame.
  AdaptiveFrame(DeviceContext& device, const DeviceInfo& info, const AdaptiveJob& job, AdaptiveKept& kept);

  // Replaces the image's values. Returns early when the context is cancelled.
  DeviceWork draw(Image& image, const Context& context);

 private:
  [[nodiscard]] int rows_a_band() const;
  void upload_paths();
  void upload_patterns();
  void upload_items(const Frame& band);
  void need_buffers();
  void record();
  void clear_buffers();
  void search();
  void list_polygons();
  void fill_tiles();
  // Draws a band of rows into the image; returns false if a buffer did not suffice, after which the capacity is larger.
  [[nodiscard]] bool try_band(Image& image, int first_row);
  void grow();
  void dispatch(Shader shader, GroupCount groups) { device_.dispatch(shader, parameters_, groups); }
  void dispatch_indirect(Shader shader, std::uint64_t byte) { device_.dispatch_indirect(shader, parameters_, byte); }
  void dispatch_at(std::uint32_t level, Shader shader, GroupCount groups);
  [[nodiscard]] GroupCount rows_of(std::uint64_t groups) const;

  DeviceContext& device_;
  const DeviceInfo& info_;
  const AdaptiveJob& job_;
  AdaptiveKept& kept_;
  AdaptiveCapacity& capacity_;
  AdaptiveParameters parameters_;
  std::array<std::uint32_t, kAdaptiveCounters> counters_{};  // of the last try
  DeviceWork work_;
};

}  // namespace contrejour::inline internal::vulkan
