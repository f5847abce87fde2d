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
    case Slot::Bounds:
    case Slot::Items:
    case Slot::Starts:
    case Slot::Groups:
    case Slot::Patterns:
    case Slot::Starbursts:
    case Slot::Dirt: return Residence::Upload;
    default: return Residence::Device;
  }
}

constexpr double kNanoseconds = 1e9;  // a second
constexpr std::uint64_t kInvocationsAGroup = 64;
constexpr std::uint32_t kMostStages = 256;
constexpr std::uint32_t kGeometryConstant = 0;  // the number of GEOMETRY in shaders/trace.glsl
constexpr std::uint32_t kPictureConstant = 1;  // that of HAS_PICTURE in shaders/stop/tables.glsl
constexpr std::uint32_t kInterpolationConstant = 2;  // that of INTERPOLATION in shaders/primitive.glsl
constexpr std::uint32_t kProcessorConstant = 3;  // that of ON_PROCESSOR in shaders/buffers.glsl
constexpr std::uint32_t kTileGroupConstant = 4;  // the workgroup of shaders/adaptive/raster.comp
constexpr std::uint32_t kTileGroup = 256, kTileGroupOfProcessor = 32;

}  // namespace

DeviceContext::DeviceContext(const vk::raii::PhysicalDevice& physical, const DeviceInfo& info,
                             const DeviceOptions& options)
    : info_(info), longest_wait_s_(options.longest_wait_s), before_submission_(options.before_submission),
      properties_(physical.getProperties()), memory_(physical.getMemoryProperties()), queued_(physical, options.lent) {
  make_layouts();
  read_pipelines();
  command_pool_ = device_.createCommandPool({vk::CommandPoolCreateFlagBits::eResetCommandBuffer, queued_.family});
  commands_ = vk::raii::CommandBuffers(device_, {*command_pool_, vk::CommandBufferLevel::ePrimary, 1});
  fence_ = device_.createFence({});
  if (physical.getQueueFamilyProperties()[queued_.family].timestampValidBits > 0) {
    clock_ = device_.createQueryPool({{}, vk::QueryType::eTimestamp, kMostStages + 1});
    tick_ns_ = static_cast<double>(properties_.limits.timestampPeriod);
  }
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
  for (std::uint32_t k = kSlots; k < kSlots + kTexelSlots.size(); ++k)
    bindings.emplace_back(k, vk::DescriptorType::eUniformTexelBuffer, 1, vk::ShaderStageFlagBits::eCompute);
  set_layout_ = device_.createDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo({}, bindings));
  bindings.clear();
  for (std::uint32_t k = 0; k < kPathSlots.size(); ++k)
    bindings.emplace_back(k, vk::DescriptorType::eUniformBufferDynamic, 1, vk::ShaderStageFlagBits::eCompute);
  path_layout_ = device_.createDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo({}, bindings));
  const std::array layouts{*set_layout_, *path_layout_};
  const vk::PushConstantRange pushed(vk::ShaderStageFlagBits::eCompute, 0, kPushedBytes);
  pipeline_layout_ = device_.createPipelineLayout(vk::PipelineLayoutCreateInfo({}, layouts, pushed));
  using Type = vk::DescriptorType;
  const std::array sizes{vk::DescriptorPoolSize(Type::eStorageBuffer, kSlots),
                         vk::DescriptorPoolSize(Type::eUniformTexelBuffer, kTexelSlots.size()),
                         vk::DescriptorPoolSize(Type::eUniformBufferDynamic, kPathSlots.size())};
  descriptor_pool_ = device_.createDescriptorPool(
      vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 2, sizes));
  sets_ = vk::raii::DescriptorSets(device_, vk::DescriptorSetAllocateInfo(*descriptor_pool_, layouts));
}

void DeviceContext::read_pipelines() {
  const std::vector<std::uint8_t> kept = read_pipeline_file(properties_);
  cache_ = device_.createPipelineCache(vk::PipelineCacheCreateInfo({}, kept.size(), kept.data()));
  for (std::size_t k = 0; k < kPrograms; ++k) pipelines_.emplace_back(nullptr);
}

vk::Pipeline DeviceContext::pipeline_of(Program program) {
  vk::raii::Pipeline& pipeline = pipelines_[number_of(program)];
  if (*pipeline != vk::Pipeline{}) return *pipeline;
  const auto code = code_of(program.shader);
  const vk::raii::ShaderModule module(device_, vk::ShaderModuleCreateInfo({}, code.size_bytes(), code.data()));
  constexpr std::uint32_t kSize = sizeof(std::uint32_t);
  const bool is_processor = info_.kind == "processor";
  const std::array<std::uint32_t, 5> values{
      static_cast<std::uint32_t>(program.geometry), program.has_picture ? VK_TRUE : VK_FALSE,
      static_cast<std::uint32_t>(program.interpolation), is_processor ? VK_TRUE : VK_FALSE,
      is_processor ? kTileGroupOfProcessor : kTileGroup};
  const std::array entries{vk::SpecializationMapEntry(kGeometryConstant, 0, kSize),
                           vk::SpecializationMapEntry(kPictureConstant, kSize, kSize),
                           vk::SpecializationMapEntry(kInterpolationConstant, 2 * kSize, kSize),
                           vk::SpecializationMapEntry(kProcessorConstant, 3 * kSize, kSize),
                           vk::SpecializationMapEntry(kTileGroupConstant, 4 * kSize, kSize)};
  const vk::SpecializationInfo constants(entries.size(), entries.data(), sizeof values, values.data());
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &constants);
  pipeline = device_.createComputePipeline(cache_, vk::ComputePipelineCreateInfo({}, stage, *pipeline_layout_));
  return *pipeline;
}

std::uint64_t DeviceContext::most_of(Slot slot, std::uint64_t bytes_an_item) const {
  std::uint64_t most = info_.storage_range_bytes;
  for (const TexelSlot& texels : kTexelSlots)
    if (texels.slot == slot)
      most = std::min<std::uint64_t>(most, std::uint64_t{properties_.limits.maxTexelBufferElements} * texels.bytes);
  return most / bytes_an_item;
}

void DeviceContext::need(Slot slot, std::uint64_t bytes) {
  if (bytes > most_of(slot, 1))
    throw vk::OutOfDeviceMemoryError(fmt::format("a buffer of {} bytes is beyond the device's limit", bytes));
  if (at(slot).need(device_, memory_, bytes)) described_ = false;
}

void DeviceContext::need_fetched(std::uint64_t bytes) { fetched_.need(device_, memory_, bytes); }

void DeviceContext::describe_buffers() {
  for (const Slot slot : kPathSlots) need(slot, kPathRange);
  std::vector<vk::DescriptorBufferInfo> infos;
  for (std::size_t k = 0; k < kSlots; ++k) {
    need(static_cast<Slot>(k), 1);
    infos.emplace_back(buffers_[k].handle(), 0, VK_WHOLE_SIZE);
  }
  std::vector<vk::WriteDescriptorSet> writes;
  for (std::uint32_t k = 0; k < kSlots; ++k)
    writes.emplace_back(*sets_.front(), k, 0, 1, vk::DescriptorType::eStorageBuffer, nullptr, &infos[k]);
  device_.updateDescriptorSets(writes, {});
  describe_texels();
  std::uint32_t binding = 0;
  for (const Slot slot : kPathSlots) {
    const vk::DescriptorBufferInfo info(at(slot).handle(), 0, kPathRange);
    device_.updateDescriptorSets(
        vk::WriteDescriptorSet(*sets_.back(), binding++, 0, vk::DescriptorType::eUniformBufferDynamic, {}, info), {});
  }
  described_ = true;
}

void DeviceContext::describe_texels() {
  views_.clear();
  std::uint32_t binding = kSlots;
  for (const TexelSlot& texels : kTexelSlots) {
    const std::uint64_t count =
        std::min<std::uint64_t>(at(texels.slot).bytes() / texels.bytes, properties_.limits.maxTexelBufferElements);
    const vk::BufferViewCreateInfo create({}, at(texels.slot).handle(), texels.format, 0, count * texels.bytes);
    const vk::BufferView view = *views_.emplace_back(device_, create);
    device_.updateDescriptorSets(
        vk::WriteDescriptorSet(*sets_.front(), binding++, 0, vk::DescriptorType::eUniformTexelBuffer, {}, {}, view),
        {});
  }
}

void DeviceContext::begin() {
  if (!described_) describe_buffers();
  const vk::raii::CommandBuffer& commands = commands_.front();
  commands.reset();
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline_layout_, 0, *sets_.front(), {});
  set_path({});
  stages_.clear();
  if (*clock_ == vk::QueryPool{}) return;
  commands.resetQueryPool(*clock_, 0, kMostStages + 1);
  commands.writeTimestamp(vk::PipelineStageFlagBits::eTopOfPipe, *clock_, 0);
}

void DeviceContext::set_path(const std::array<std::uint32_t, kPathSlots.size()>& first_bytes) {
  commands_.front().bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline_layout_, 1, *sets_.back(),
                                       first_bytes);
}

void DeviceContext::end_stage(std::string name) {
  if (*clock_ == vk::QueryPool{} || stages_.size() == kMostStages) return;
  stages_.push_back(std::move(name));
  commands_.front().writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *clock_,
                                   static_cast<std::uint32_t>(stages_.size()));
}

void DeviceContext::read_clock() {
  stages_ms_.clear();
  if (stages_.empty()) return;
  const auto count = static_cast<std::uint32_t>(stages_.size() + 1);
  const auto [result, ticks] = clock_.getResults<std::uint64_t>(0, count, count * sizeof(std::uint64_t),
                                                                sizeof(std::uint64_t), vk::QueryResultFlagBits::e64);
  if (result != vk::Result::eSuccess) return;
  for (std::size_t k = 0; k < stages_.size(); ++k)
    stages_ms_.emplace_back(stages_[k], static_cast<double>(ticks[k + 1] - ticks[k]) * tick_ns_ * 1e-6);
}

void DeviceContext::clear(Slot slot, std::uint64_t first_byte, std::uint64_t bytes) {
  commands_.front().fillBuffer(at(slot).handle(), first_byte, bytes, 0);
}

GroupCount groups_of(std::uint64_t invocations, const DeviceInfo& info) {
  const std::uint64_t groups = (invocations + kInvocationsAGroup - 1) / kInvocationsAGroup;
  const std::uint64_t rows = (groups + info.groups_an_axis - 1) / info.groups_an_axis;
  if (rows == 0) return {0, 0};
  return {static_cast<std::uint32_t>((groups + rows - 1) / rows), static_cast<std::uint32_t>(rows)};
}

void DeviceContext::barrier() {
  using Stage = vk::PipelineStageFlagBits;
  using Access = vk::AccessFlagBits;
  const vk::MemoryBarrier all(Access::eShaderWrite | Access::eTransferWrite,
                              Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead |
                                  Access::eTransferWrite | Access::eIndirectCommandRead | Access::eHostRead);
  const auto work = Stage::eComputeShader | Stage::eTransfer;
  commands_.front().pipelineBarrier(work, work | Stage::eDrawIndirect | Stage::eHost, {}, all, {}, {});
}

void DeviceContext::finish(const QueueSemaphores& semaphores) {
  barrier();
  commands_.front().end();
  if (before_submission_) before_submission_(submissions_);
  ++submissions_;
  device_.resetFences(*fence_);
  submit(semaphores);
  const auto wait_ns = static_cast<std::uint64_t>(longest_wait_s_ * kNanoseconds);
  if (device_.waitForFences(*fence_, VK_TRUE, wait_ns) == vk::Result::eTimeout)
    throw Hang(fmt::format("the device gave no answer for {} s", longest_wait_s_));
  read_clock();
}

// A binary semaphore has no value, and its number is ignored.
void DeviceContext::submit(const QueueSemaphores& semaphores) {
  const auto& [wait, signal] = semaphores;
  const vk::Semaphore waits(wait.semaphore), signals(signal.semaphore);
  const vk::PipelineStageFlags stages = vk::PipelineStageFlagBits::eAllCommands;
  const std::uint32_t wait_count = waits ? 1 : 0, signal_count = signals ? 1 : 0;
  const vk::TimelineSemaphoreSubmitInfo values(wait_count, &wait.value, signal_count, &signal.value);
  const vk::CommandBuffer commands = *commands_.front();
  vk::SubmitInfo info(wait_count, &waits, &stages, 1, &commands, signal_count, &signals);
  if (wait_count + signal_count > 0) info.pNext = &values;
  queue_.submit(info, *fence_);
}

void DeviceContext::copy(const Buffer& from, std::uint64_t from_byte, Slot to, std::uint64_t bytes) {
  commands_.front().copyBuffer(from.handle(), at(to).handle(), vk::BufferCopy(from_byte, 0, bytes));
}

void DeviceContext::keep(Slot slot, std::uint64_t bytes, std::uint64_t to_byte) {
  commands_.front().copyBuffer(at(slot).handle(), kept_rows_.handle(), vk::BufferCopy(0, to_byte, bytes));
}

void DeviceContext::fetch(Slot slot, std::uint64_t bytes, std::uint64_t to_byte) {
  commands_.front().copyBuffer(at(slot).handle(), fetched_.handle(), vk::BufferCopy(0, to_byte, bytes));
}

std::uint64_t DeviceContext::memory_bytes() const {
  std::uint64_t sum = fetched_.bytes() + kept_rows_.bytes() + sent_rows_.bytes();
  for (const Buffer& buffer : buffers_) sum += buffer.bytes();
  return sum;
}

}  // namespace contrejour::inline internal::vulkan
