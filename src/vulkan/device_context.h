// SPDX-License-Identifier: Apache-2.0
// A logical device with all that lives from frame to frame: queue, pipelines, descriptors, buffers.
// Failures are exceptions of vulkan.hpp, or Hang; the caller turns them into error values.
// Thread-safety: one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "render/device/frame_device.h"
#include "vulkan/buffer.h"
#include "vulkan/layout.h"
#include "vulkan/shader.h"

namespace contrejour::inline internal::vulkan {

// A submission that did not end in time. Its device must not be destroyed: it may still run.
struct Hang : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// In the order of their bindings (shaders/bindings.glsl).
enum class Slot : std::uint8_t {
  Floats,
  Integers,
  Tables,
  Rays,
  Crossings,
  Sums,
  Counters,
  Picture,
  Bounds,
  Large,
  LargeCorners,
  Blocks,
  Doubles,
  Vertices,
};
inline constexpr std::size_t kSlots = 14;

struct GroupCount {
  std::uint32_t x = 1, y = 1;
};

class DeviceContext {
 public:
  DeviceContext(const vk::raii::PhysicalDevice& physical, const DeviceInfo& info, double longest_wait_s,
                std::function<void(std::uint64_t submission)> before_submission);
  ~DeviceContext();
  DeviceContext(const DeviceContext&) = delete;
  DeviceContext& operator=(const DeviceContext&) = delete;

  [[nodiscard]] Buffer& at(Slot slot) { return buffers_[static_cast<std::size_t>(slot)]; }
  // Makes a buffer large enough, and takes part in no submission meanwhile.
  void need(Slot slot, std::uint64_t bytes);
  template <class T>
  void upload(Slot slot, const std::vector<T>& values) {
    need(slot, values.size() * sizeof(T));
    at(slot).write(std::span<const T>(values));
  }

  // A submission: begin, any number of the others, finish.
  void begin();
  void dispatch(Shader shader, const Parameters& parameters, GroupCount groups);
  void clear(Slot slot, std::uint64_t first_byte, std::uint64_t bytes);
  void barrier();  // what follows sees what came before
  void finish();   // submits, and waits for the end
  // The same, with a copy of a buffer's first floats, which it returns.
  [[nodiscard]] std::vector<float> finish_and_read(Slot slot, std::uint64_t floats);

  [[nodiscard]] std::uint64_t submissions() const { return submissions_; }
  [[nodiscard]] std::uint64_t invocations() const { return invocations_; }
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  void make_layouts();
  void make_pipelines();
  void describe_buffers();

  DeviceInfo info_;
  double longest_wait_s_;
  std::function<void(std::uint64_t)> before_submission_;
  vk::PhysicalDeviceProperties properties_;
  vk::PhysicalDeviceMemoryProperties memory_;
  vk::raii::Device device_ = nullptr;
  vk::raii::Queue queue_ = nullptr;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout pipeline_layout_ = nullptr;
  vk::raii::PipelineCache cache_ = nullptr;
  std::vector<vk::raii::Pipeline> pipelines_;  // by Shader
  vk::raii::DescriptorPool descriptor_pool_ = nullptr;
  std::vector<vk::raii::DescriptorSet> sets_;  // one
  vk::raii::CommandPool command_pool_ = nullptr;
  std::vector<vk::raii::CommandBuffer> commands_;  // one
  vk::raii::Fence fence_ = nullptr;
  std::vector<Buffer> buffers_;  // by Slot
  bool described_ = false;
  std::uint64_t submissions_ = 0, invocations_ = 0;
};

}  // namespace contrejour::inline internal::vulkan
