// SPDX-License-Identifier: Apache-2.0
// A buffer of a device with memory of its own, which grows and is kept from frame to frame.
// Thread-safety: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "vulkan/raii.h"

namespace contrejour::inline internal::vulkan {

enum class Residence : std::uint8_t {
  Device,    // never mapped
  Upload,    // written by the host, near the device where the two share memory
  Download,  // read by the host
};

class Buffer {
 public:
  explicit Buffer(Residence residence) : residence_(residence) {}

  // Makes the buffer at least this large; its contents are lost if it grows. Returns whether it grew.
  bool need(const vk::raii::Device& device, const vk::PhysicalDeviceMemoryProperties& memory, std::uint64_t bytes);

  template <class T>
  void write(std::span<const T> values) {
    if (!values.empty()) std::memcpy(mapped_, values.data(), values.size_bytes());
  }
  template <class T>
  [[nodiscard]] const T* read() const {
    return static_cast<const T*>(mapped_);
  }
  [[nodiscard]] vk::Buffer handle() const { return *buffer_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  Residence residence_;
  std::uint64_t bytes_ = 0;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Buffer buffer_ = nullptr;
  void* mapped_ = nullptr;
};

}  // namespace contrejour::inline internal::vulkan
