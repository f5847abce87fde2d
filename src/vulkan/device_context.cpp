// SPDX-License-Identifier: Apache-2.0
#include "vulkan/device_context.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

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
    case Slot::Patterns:
    case Slot::Starbursts:
    case Slot::Dirt: return Residence::Upload;
    default: return Residence::Device;
  }
}

constexpr double kNanoseconds = 1e9;  // a second
constexpr std::uint64_t kInvocationsAGroup = 64;
constexpr std::uint32_t kMostStages = 256;
constexpr std::size_t kMostIndirect = 256;  // dispatches of a submission that are counted
constexpr std::uint64_t kGroupCountBytes = 3 * sizeof(std::uint32_t);

}  // namespace

DeviceContext::DeviceContext(std::shared_ptr<OpenedDevice> opened, const DeviceInfo& info, const DeviceOptions& options)
    : opened_(std::move(opened)), info_(info), longest_wait_s_(options.longest_wait_s),
      before_submission_(options.before_submission) {
  make_sets();
  command_pool_ = device_.createCommandPool({vk::CommandPoolCreateFlagBits::eResetCommandBuffer, opened_->family()});
  commands_ = vk::raii::CommandBuffers(device_, {*command_pool_, vk::CommandBufferLevel::ePrimary, 1});
  fence_ = device_.createFence({});
  if (opened_->tick_ns() > 0.0) clock_ = device_.createQueryPool({{}, vk::QueryType::eTimestamp, kMostStages + 1});
  for (std::size_t k = 0; k < kSlots; ++k) buffers_.emplace_back(residence_of(k));
  opened_->add_context();
}

DeviceContext::~DeviceContext() { opened_->remove_context(); }

void DeviceContext::make_sets() {
  using Type = vk::DescriptorType;
  const std::array sizes{vk::DescriptorPoolSize(Type::eStorageBuffer, kSlots),
                         vk::DescriptorPoolSize(Type::eUniformTexelBuffer, kTexelSlots.size()),
                         vk::DescriptorPoolSize(Type::eUniformBufferDynamic, kPathSlots.size())};
  descriptor_pool_ = device_.createDescriptorPool(
      vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 2, sizes));
  const auto layouts = opened_->set_layouts();
  sets_ = vk::raii::DescriptorSets(device_, vk::DescriptorSetAllocateInfo(*descriptor_pool_, layouts));
}

std::uint64_t DeviceContext::most_of(Slot slot, std::uint64_t bytes_an_item) const {
  std::uint64_t most = info_.storage_range_bytes;
  for (const TexelSlot& texels : kTexelSlots)
    if (texels.slot == slot)
      most = std::min<std::uint64_t>(most, std::uint64_t{opened_->limits().maxTexelBufferElements} * texels.bytes);
  return most / bytes_an_item;
}

void DeviceContext::need(Slot slot, std::uint64_t bytes) {
  if (bytes > most_of(slot, 1))
    throw vk::OutOfDeviceMemoryError(fmt::format("a buffer of {} bytes is beyond the device's limit", bytes));
  if (at(slot).need(device_, opened_->memory(), bytes)) described_ = false;
}

void DeviceContext::need_fetched(std::uint64_t bytes) { fetched_.need(device_, opened_->memory(), bytes); }

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
        std::min<std::uint64_t>(at(texels.slot).bytes() / texels.bytes, opened_->limits().maxTexelBufferElements);
    const vk::BufferViewCreateInfo create({}, at(texels.slot).handle(), texels.format, 0, count * texels.bytes);
    const vk::BufferView view = *views_.emplace_back(device_, create);
    device_.updateDescriptorSets(
        vk::WriteDescriptorSet(*sets_.front(), binding++, 0, vk::DescriptorType::eUniformTexelBuffer, {}, {}, view),
        {});
  }
}

void DeviceContext::begin() {
  if (!described_) describe_buffers();
  if (counts_invocations_) indirect_groups_.need(device_, opened_->memory(), kGroupCountBytes * kMostIndirect);
  const vk::raii::CommandBuffer& commands = commands_.front();
  commands.reset();
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, opened_->pipeline_layout(), 0, *sets_.front(), {});
  set_path({});
  stages_.clear();
  indirect_group_sizes_.clear();
  if (*clock_ == vk::QueryPool{}) return;
  commands.resetQueryPool(*clock_, 0, kMostStages + 1);
  commands.writeTimestamp(vk::PipelineStageFlagBits::eTopOfPipe, *clock_, 0);
}

void DeviceContext::set_path(const std::array<std::uint32_t, kPathSlots.size()>& first_bytes) {
  commands_.front().bindDescriptorSets(vk::PipelineBindPoint::eCompute, opened_->pipeline_layout(), 1, *sets_.back(),
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
    stages_ms_.emplace_back(stages_[k], static_cast<double>(ticks[k + 1] - ticks[k]) * opened_->tick_ns() * 1e-6);
}

void DeviceContext::copy_group_counts(Shader shader, std::uint64_t byte) {
  if (indirect_group_sizes_.size() == kMostIndirect) return;
  commands_.front().copyBuffer(at(Slot::Indirect).handle(), indirect_groups_.handle(),
                               vk::BufferCopy(byte, kGroupCountBytes * indirect_group_sizes_.size(), kGroupCountBytes));
  indirect_group_sizes_.push_back(opened_->group_size_of(shader));
}

void DeviceContext::add_indirect_invocations() {
  const auto* const counts = indirect_groups_.read<std::array<std::uint32_t, 3>>();
  for (std::size_t k = 0; k < indirect_group_sizes_.size(); ++k)
    invocations_ += std::uint64_t{indirect_group_sizes_[k]} * counts[k][0] * counts[k][1] * counts[k][2];
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
  // The submissions of other contexts may come first.
  const double longest_s = longest_wait_s_ * opened_->contexts();
  const auto wait_ns = static_cast<std::uint64_t>(longest_s * kNanoseconds);
  if (device_.waitForFences(*fence_, VK_TRUE, wait_ns) == vk::Result::eTimeout)
    throw Hang(fmt::format("the device gave no answer for {} s", longest_s));
  read_clock();
  add_indirect_invocations();
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
  opened_->submit(info, *fence_);
}

void DeviceContext::copy(const Buffer& from, std::uint64_t from_byte, Slot to, std::uint64_t bytes) {
  commands_.front().copyBuffer(from.handle(), at(to).handle(), vk::BufferCopy(from_byte, 0, bytes));
}

void DeviceContext::keep(Slot slot, std::uint64_t bytes, std::uint64_t to_byte) {
  commands_.front().copyBuffer(at(slot).handle(), kept_rows_.handle(), vk::BufferCopy(0, to_byte, bytes));
}

void DeviceContext::fetch(Slot slot, std::uint64_t bytes, std::uint64_t to_byte) {
  commands_.front().copyBuffer(at(slot).handle(), fetched_.handle(), vk::BufferCopy(0, to_byte, bytes));
  fetched_bytes_ += bytes;
}

std::uint64_t DeviceContext::memory_bytes() const {
  std::uint64_t sum = fetched_.bytes() + kept_rows_.bytes() + sent_rows_.bytes() + indirect_groups_.bytes();
  for (const Buffer& buffer : buffers_) sum += buffer.bytes();
  return sum;
}

}  // namespace contrejour::inline internal::vulkan
