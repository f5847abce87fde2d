// SPDX-License-Identifier: Apache-2.0
#include "vulkan/buffer.h"

#include <algorithm>
#include <array>

namespace contrejour::inline internal::vulkan {
namespace {

using Flag = vk::MemoryPropertyFlagBits;

// The kinds of memory for a residence, the best first.
std::array<vk::MemoryPropertyFlags, 3> preferences(Residence residence) {
  const vk::MemoryPropertyFlags visible = Flag::eHostVisible | Flag::eHostCoherent;
  switch (residence) {
    case Residence::Device: return {Flag::eDeviceLocal, {}, {}};
    case Residence::Upload: return {visible | Flag::eDeviceLocal, visible, visible};
    case Residence::Download: return {visible | Flag::eHostCached, visible, visible};
  }
  return {};
}

std::uint32_t memory_type(const vk::PhysicalDeviceMemoryProperties& memory, std::uint32_t allowed,
                          Residence residence) {
  for (const vk::MemoryPropertyFlags wanted : preferences(residence)) {
    for (std::uint32_t k = 0; k < memory.memoryTypeCount; ++k)
      if ((allowed & (1U << k)) != 0 && (memory.memoryTypes[k].propertyFlags & wanted) == wanted) return k;
  }
  throw vk::OutOfDeviceMemoryError("no memory of the device is fit for a buffer");
}

// Buffers grow by whole steps, so that frames of about the same size use the same buffers. Larger ones are as large as
// they are, since a device limits how far a shader may read.
constexpr std::uint64_t kStep = 64U << 10U, kStepsUpTo = 64U << 20U;  // bytes

}  // namespace

bool Buffer::need(const vk::raii::Device& device, const vk::PhysicalDeviceMemoryProperties& memory,
                  std::uint64_t bytes) {
  bytes = std::max<std::uint64_t>(bytes, 1);
  if (bytes < kStepsUpTo) bytes = (bytes + kStep - 1) / kStep * kStep;
  if (bytes <= bytes_) return false;
  // The old memory is freed first: both together may not fit.
  buffer_ = nullptr;
  memory_ = nullptr;
  bytes_ = 0;
  using Usage = vk::BufferUsageFlagBits;
  const vk::BufferUsageFlags usage = Usage::eStorageBuffer | Usage::eUniformBuffer | Usage::eUniformTexelBuffer |
                                     Usage::eTransferSrc | Usage::eTransferDst | Usage::eIndirectBuffer;
  buffer_ = vk::raii::Buffer(device, vk::BufferCreateInfo({}, bytes, usage));
  const vk::MemoryRequirements required = buffer_.getMemoryRequirements();
  const std::uint32_t type = memory_type(memory, required.memoryTypeBits, residence_);
  memory_ = vk::raii::DeviceMemory(device, vk::MemoryAllocateInfo(required.size, type));
  buffer_.bindMemory(*memory_, 0);
  mapped_ = residence_ == Residence::Device ? nullptr : memory_.mapMemory(0, VK_WHOLE_SIZE);
  bytes_ = bytes;
  return true;
}

}  // namespace contrejour::inline internal::vulkan
