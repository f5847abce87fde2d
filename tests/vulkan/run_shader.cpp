// SPDX-License-Identifier: Apache-2.0
#include "run_shader.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>

#include <doctest/doctest.h>

#include "device.h"
#include "vulkan/buffer.h"
#include "vulkan/instance.h"

namespace contrejour::test {
namespace {

std::vector<std::uint32_t> words_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::vector<std::uint32_t> words(bytes.size() / 4);
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), 4 * words.size());
  return words;
}

// A device that computes; null in `device` where there is none.
struct ComputeDevice {
  explicit ComputeDevice(const vulkan::Instance& instance) {
    for (const DeviceInfo& info : instance.devices()) {
      if (!info.is_usable) continue;
      physical = &instance.physical(info.index);
      family = static_cast<std::uint32_t>(vulkan::compute_family(*physical));
      const float priority = 1.0F;
      const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
      device = vk::raii::Device(*physical, vk::DeviceCreateInfo({}, queue));
      return;
    }
  }
  const vk::raii::PhysicalDevice* physical = nullptr;
  std::uint32_t family = 0;
  vk::raii::Device device = nullptr;
};

// Runs one workgroup that writes to the buffer.
void dispatch(const ComputeDevice& on, const std::vector<std::uint32_t>& code, const vulkan::Buffer& buffer) {
  const vk::raii::Device& device = on.device;
  const vk::raii::ShaderModule shader(device, vk::ShaderModuleCreateInfo({}, code));
  const vk::DescriptorSetLayoutBinding binding(0, vk::DescriptorType::eStorageBuffer, 1,
                                               vk::ShaderStageFlagBits::eCompute);
  const vk::raii::DescriptorSetLayout set_layout(device, vk::DescriptorSetLayoutCreateInfo({}, binding));
  const vk::raii::PipelineLayout layout(device, vk::PipelineLayoutCreateInfo({}, *set_layout));
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *shader, "main");
  const vk::raii::Pipeline pipeline(device, nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout));
  const vk::DescriptorPoolSize size(vk::DescriptorType::eStorageBuffer, 1);
  const vk::raii::DescriptorPool pool(
      device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size));
  const vk::raii::DescriptorSets sets(device, vk::DescriptorSetAllocateInfo(*pool, *set_layout));
  const vk::DescriptorBufferInfo bound(buffer.handle(), 0, VK_WHOLE_SIZE);
  device.updateDescriptorSets(
      vk::WriteDescriptorSet(*sets.front(), 0, 0, vk::DescriptorType::eStorageBuffer, {}, bound), {});
  const vk::raii::CommandPool commands(device, vk::CommandPoolCreateInfo({}, on.family));
  const vk::raii::CommandBuffers all(device,
                                     vk::CommandBufferAllocateInfo(*commands, vk::CommandBufferLevel::ePrimary, 1));
  const vk::raii::CommandBuffer& command = all.front();
  command.begin(vk::CommandBufferBeginInfo());
  command.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
  command.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout, 0, *sets.front(), {});
  command.dispatch(1, 1, 1);
  const vk::MemoryBarrier written(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eHostRead);
  command.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader, vk::PipelineStageFlagBits::eHost, {}, written, {},
                          {});
  command.end();
  const vk::raii::Queue queue(device, on.family, 0);
  queue.submit(vk::SubmitInfo({}, {}, *command));
  queue.waitIdle();
}

}  // namespace

std::optional<std::vector<float>> run_shader(const std::string& spirv_file, const std::vector<float>& values) {
  const auto instance = vulkan::Instance::open(add_message);
  if (!instance) return std::nullopt;
  const ComputeDevice on(**instance);
  if (on.physical == nullptr) return std::nullopt;
  vulkan::Buffer buffer(vulkan::Residence::Download);
  buffer.need(on.device, on.physical->getMemoryProperties(), values.size() * sizeof(float));
  buffer.write(std::span<const float>(values));
  dispatch(on, words_of(spirv_file), buffer);
  const float* const written = buffer.read<float>();
  return std::vector<float>(written, written + values.size());
}

}  // namespace contrejour::test
