// SPDX-License-Identifier: Apache-2.0
// A logical device with what all its frames share: queue, layouts, pipelines.
// Failures are exceptions of vulkan.hpp. Thread-safety: several threads at a time.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "render/device/frame_device.h"
#include "vulkan/instance.h"
#include "vulkan/lent_device.h"
#include "vulkan/raii.h"
#include "vulkan/shader.h"

namespace contrejour::inline internal::vulkan {

class OpenedDevice {
 public:
  // queue_mutex: of a lent queue, which is the same whenever its device is opened.
  OpenedDevice(std::shared_ptr<const Instance> instance, const DeviceInfo& info, const DeviceOptions& options,
               std::shared_ptr<std::mutex> queue_mutex);
  ~OpenedDevice();
  OpenedDevice(const OpenedDevice&) = delete;
  OpenedDevice& operator=(const OpenedDevice&) = delete;

  [[nodiscard]] const vk::raii::Device& device() const { return queued_.device.object; }
  [[nodiscard]] std::uint32_t family() const { return queued_.family; }
  [[nodiscard]] const vk::PhysicalDeviceLimits& limits() const { return properties_.limits; }
  [[nodiscard]] const vk::PhysicalDeviceMemoryProperties& memory() const { return memory_; }
  [[nodiscard]] double tick_ns() const { return tick_ns_; }  // of the queue's clock; 0: it has none
  // The invocations of a shader's workgroup: the local sizes that the files of shaders state.
  [[nodiscard]] std::uint32_t group_size_of(Shader shader) const;
  // The layouts of the set of all buffers, and of that of the path.
  [[nodiscard]] std::array<vk::DescriptorSetLayout, 2> set_layouts() const { return {*set_layout_, *path_layout_}; }
  [[nodiscard]] vk::PipelineLayout pipeline_layout() const { return *pipeline_layout_; }

  // Compiles a program when it is used first, for which other threads wait.
  [[nodiscard]] vk::Pipeline pipeline_of(Program program);
  void submit(const vk::SubmitInfo& work, vk::Fence fence);

  // The contexts that use the device.
  void add_context() { ++contexts_; }
  void remove_context() { --contexts_; }
  [[nodiscard]] int contexts() const { return contexts_; }

  // After a failure no further frame is begun on this device. An abandoned one may still run and is never destroyed,
  // nor is anything that was made on it, whoever else refers to it.
  void set_failed() { has_failed_ = true; }
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  static void abandon(const std::shared_ptr<OpenedDevice>& device);
  [[nodiscard]] bool is_abandoned() const { return is_abandoned_; }

 private:
  void make_layouts();
  [[nodiscard]] vk::raii::Pipeline compiled(Program program) const;

  std::shared_ptr<const Instance> instance_;
  bool draws_as_processor_;  // with code for processors
  vk::PhysicalDeviceProperties properties_;
  vk::PhysicalDeviceMemoryProperties memory_;
  QueuedDevice queued_;
  std::shared_ptr<std::mutex> queue_mutex_;
  double tick_ns_ = 0.0;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr, path_layout_ = nullptr;
  vk::raii::PipelineLayout pipeline_layout_ = nullptr;
  vk::raii::PipelineCache cache_ = nullptr;
  std::mutex pipelines_mutex_;
  std::vector<vk::raii::Pipeline> pipelines_;  // by program; null until it is used
  std::atomic<int> contexts_ = 0;
  std::atomic<bool> has_failed_ = false, is_abandoned_ = false;
  std::shared_ptr<OpenedDevice> itself_;  // once it is abandoned
};

}  // namespace contrejour::inline internal::vulkan
