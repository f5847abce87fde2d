// SPDX-License-Identifier: Apache-2.0
#include "vulkan/device_context.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "vulkan/instance.h"
#include "vulkan/pipeline_file.h"

namespace contrejour::inline internal::vulkan {
namespace {

Residence residence_of(std::size_t slot) {
  switch (static_cast<Slot>(slot)) {
    case Slot::Floats:
    case Slot::Doubles:
    case Slot::Integers:
    case Slot::Tables:
    case Slot::Bounds: return Residence::Upload;
    case Slot::Counters:
    case Slot::Picture: return Residence::Download;
    default: return Residence::Device;
  }
}

constexpr std::uint64_t kGroup = 64;  // invocations of every shader's workgroup
constexpr double kNanoseconds = 1e9;  // a second

}  // namespace

DeviceContext::DeviceContext(const vk::raii::PhysicalDevice& physical, const DeviceInfo& info, double longest_wait_s,
                             std::function<void(std::uint64_t)> before_submission)
    : info_(info), longest_wait_s_(longest_wait_s), before_submission_(std::move(before_submission)),
      properties_(physical.getProperties()), memory_(physical.getMemoryProperties()) {
  const auto family = static_cast<std::uint32_t>(compute_family(physical));
  const float priority = 1.0F;
  const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
  vk::PhysicalDeviceFeatures features;
  features.shaderFloat64 = VK_TRUE;
  device_ = vk::raii::Device(physical, vk::DeviceCreateInfo({}, queue, {}, {}, &features));
  queue_ = device_.getQueue(family, 0);
  make_layouts();
  make_pipelines();
  command_pool_ = device_.createCommandPool({vk::CommandPoolCreateFlagBits::eResetCommandBuffer, family});
  commands_ = vk::raii::CommandBuffers(device_, {*command_pool_, vk::CommandBufferLevel::ePrimary, 1});
  fence_ = device_.createFence({});
  for (std::size_t k = 0; k < kSlots; ++k) buffers_.emplace_back(residence_of(k));
}

DeviceContext::~DeviceContext() {
  try {
    write_pipeline_file(properties_, cache_.getData());
  } catch (const std::exception&) {  // the next start compiles them again
  }
}

void DeviceContext::make_layouts() {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (std::uint32_t k = 0; k < kSlots; ++k)
    bindings.emplace_back(k, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute);
  set_layout_ = device_.createDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo({}, bindings));
  const vk::PushConstantRange pushed(vk::ShaderStageFlagBits::eCompute, 0, sizeof(Parameters));
  pipeline_layout_ = device_.createPipelineLayout(vk::PipelineLayoutCreateInfo({}, *set_layout_, pushed));
  const vk::DescriptorPoolSize size(vk::DescriptorType::eStorageBuffer, kSlots);
  descriptor_pool_ = device_.createDescriptorPool(
      vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size));
  sets_ = vk::raii::DescriptorSets(device_, {*descriptor_pool_, *set_layout_});
}

void DeviceContext::make_pipelines() {
  const std::vector<std::uint8_t> kept = read_pipeline_file(properties_);
  cache_ = device_.createPipelineCache(vk::PipelineCacheCreateInfo({}, kept.size(), kept.data()));
  for (std::size_t k = 0; k < kShaders; ++k) {
    const auto code = code_of(static_cast<Shader>(k));
    const vk::raii::ShaderModule module(device_, vk::ShaderModuleCreateInfo({}, code.size_bytes(), code.data()));
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main");
    pipelines_.push_back(
        device_.createComputePipeline(cache_, vk::ComputePipelineCreateInfo({}, stage, *pipeline_layout_)));
  }
}

void DeviceContext::need(Slot slot, std::uint64_t bytes) {
  if (bytes > info_.storage_range_bytes)
    throw vk::OutOfDeviceMemoryError(fmt::format("a buffer of {} bytes is beyond the device's limit", bytes));
  if (at(slot).need(device_, memory_, bytes)) described_ = false;
}

void DeviceContext::describe_buffers() {
  std::vector<vk::DescriptorBufferInfo> infos;
  for (std::size_t k = 0; k < kSlots; ++k) {
    need(static_cast<Slot>(k), 1);
    infos.emplace_back(buffers_[k].handle(), 0, VK_WHOLE_SIZE);
  }
  std::vector<vk::WriteDescriptorSet> writes;
  for (std::uint32_t k = 0; k < kSlots; ++k)
    writes.emplace_back(*sets_.front(), k, 0, 1, vk::DescriptorType::eStorageBuffer, nullptr, &infos[k]);
  device_.updateDescriptorSets(writes, {});
  described_ = true;
}

void DeviceContext::begin() {
  if (!described_) describe_buffers();
  const vk::raii::CommandBuffer& commands = commands_.front();
  commands.reset();
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline_layout_, 0, *sets_.front(), {});
}

void DeviceContext::dispatch(Shader shader, const Parameters& parameters, GroupCount groups) {
  if (groups.x == 0 || groups.y == 0) return;
  const vk::raii::CommandBuffer& commands = commands_.front();
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipelines_[static_cast<std::size_t>(shader)]);
  commands.pushConstants<Parameters>(*pipeline_layout_, vk::ShaderStageFlagBits::eCompute, 0, parameters);
  commands.dispatch(groups.x, groups.y, 1);
  invocations_ += kGroup * groups.x * groups.y;
}

void DeviceContext::clear(Slot slot, std::uint64_t first_byte, std::uint64_t bytes) {
  commands_.front().fillBuffer(at(slot).handle(), first_byte, bytes, 0);
}

void DeviceContext::barrier() {
  using Stage = vk::PipelineStageFlagBits;
  using Access = vk::AccessFlagBits;
  const vk::MemoryBarrier all(
      Access::eShaderWrite | Access::eTransferWrite,
      Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead | Access::eTransferWrite | Access::eHostRead);
  const auto work = Stage::eComputeShader | Stage::eTransfer;
  commands_.front().pipelineBarrier(work, work | Stage::eHost, {}, all, {}, {});
}

void DeviceContext::finish() {
  barrier();
  commands_.front().end();
  if (before_submission_) before_submission_(submissions_);
  ++submissions_;
  device_.resetFences(*fence_);
  queue_.submit(vk::SubmitInfo({}, {}, *commands_.front()), *fence_);
  const auto wait_ns = static_cast<std::uint64_t>(longest_wait_s_ * kNanoseconds);
  if (device_.waitForFences(*fence_, VK_TRUE, wait_ns) == vk::Result::eTimeout)
    throw Hang(fmt::format("the device gave no answer for {} s", longest_wait_s_));
}

std::vector<float> DeviceContext::finish_and_read(Slot slot, std::uint64_t floats) {
  Buffer copy(Residence::Download);
  copy.need(device_, memory_, floats * sizeof(float));
  commands_.front().copyBuffer(at(slot).handle(), copy.handle(), vk::BufferCopy(0, 0, floats * sizeof(float)));
  finish();
  const auto* const from = copy.read<float>();
  return {from, from + floats};
}

std::uint64_t DeviceContext::memory_bytes() const {
  std::uint64_t sum = 0;
  for (const Buffer& buffer : buffers_) sum += buffer.bytes();
  return sum;
}

}  // namespace contrejour::inline internal::vulkan
