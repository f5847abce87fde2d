// SPDX-License-Identifier: Apache-2.0
#include "vulkan/opened_device.h"

#include <utility>

#include "vulkan/pipeline_file.h"
#include "vulkan/slots.h"

namespace contrejour::inline internal::vulkan {
namespace {

constexpr std::uint32_t kGeometryConstant = 0;  // the number of GEOMETRY in shaders/trace.glsl
constexpr std::uint32_t kPictureConstant = 1;  // that of HAS_PICTURE in shaders/stop/tables.glsl
constexpr std::uint32_t kInterpolationConstant = 2;  // that of INTERPOLATION in shaders/primitive.glsl
constexpr std::uint32_t kProcessorConstant = 3;  // that of ON_PROCESSOR in shaders/buffers.glsl
constexpr std::uint32_t kTileGroupConstant = 4;  // the workgroup of shaders/adaptive/raster.comp
constexpr std::uint32_t kPatternsConstant = 5;   // HAS_PATTERNS of shaders/adaptive/common.glsl
constexpr std::uint32_t kTileGroup = 256, kTileGroupOfProcessor = 32;

}  // namespace

OpenedDevice::OpenedDevice(std::shared_ptr<const Instance> instance, const DeviceInfo& info,
                           const DeviceOptions& options, std::shared_ptr<std::mutex> queue_mutex)
    : instance_(std::move(instance)), draws_as_processor_(info.kind == "processor" && !options.draws_as_gpu),
      properties_(instance_->physical(info.index).getProperties()),
      memory_(instance_->physical(info.index).getMemoryProperties()),
      queued_(instance_->physical(info.index), options.lent), queue_mutex_(std::move(queue_mutex)) {
  make_layouts();
  const std::vector<std::uint8_t> kept = read_pipeline_file(properties_);
  cache_ = device().createPipelineCache(vk::PipelineCacheCreateInfo({}, kept.size(), kept.data()));
  for (std::size_t k = 0; k < kPrograms; ++k) pipelines_.emplace_back(nullptr);
  if (instance_->physical(info.index).getQueueFamilyProperties()[queued_.family].timestampValidBits > 0)
    tick_ns_ = static_cast<double>(properties_.limits.timestampPeriod);
}

OpenedDevice::~OpenedDevice() {
  try {
    write_pipeline_file(properties_, cache_.getData());
  } catch (const std::exception&) {  // the next start compiles them again
  }
}

void OpenedDevice::make_layouts() {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (std::uint32_t k = 0; k < kSlots; ++k)
    bindings.emplace_back(k, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute);
  for (std::uint32_t k = kSlots; k < kSlots + kTexelSlots.size(); ++k)
    bindings.emplace_back(k, vk::DescriptorType::eUniformTexelBuffer, 1, vk::ShaderStageFlagBits::eCompute);
  set_layout_ = device().createDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo({}, bindings));
  bindings.clear();
  for (std::uint32_t k = 0; k < kPathSlots.size(); ++k)
    bindings.emplace_back(k, vk::DescriptorType::eUniformBufferDynamic, 1, vk::ShaderStageFlagBits::eCompute);
  path_layout_ = device().createDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo({}, bindings));
  const auto layouts = set_layouts();
  const vk::PushConstantRange pushed(vk::ShaderStageFlagBits::eCompute, 0, kPushedBytes);
  pipeline_layout_ = device().createPipelineLayout(vk::PipelineLayoutCreateInfo({}, layouts, pushed));
}

vk::raii::Pipeline OpenedDevice::compiled(Program program) const {
  const auto code = code_of(program.shader);
  const vk::raii::ShaderModule module(device(), vk::ShaderModuleCreateInfo({}, code.size_bytes(), code.data()));
  constexpr std::uint32_t kSize = sizeof(std::uint32_t);
  const std::array<std::uint32_t, 6> values{static_cast<std::uint32_t>(program.geometry),
                                            program.has_picture ? VK_TRUE : VK_FALSE,
                                            static_cast<std::uint32_t>(program.interpolation),
                                            draws_as_processor_ ? VK_TRUE : VK_FALSE,
                                            draws_as_processor_ ? kTileGroupOfProcessor : kTileGroup,
                                            program.has_patterns ? VK_TRUE : VK_FALSE};
  const std::array entries{vk::SpecializationMapEntry(kGeometryConstant, 0, kSize),
                           vk::SpecializationMapEntry(kPictureConstant, kSize, kSize),
                           vk::SpecializationMapEntry(kInterpolationConstant, 2 * kSize, kSize),
                           vk::SpecializationMapEntry(kProcessorConstant, 3 * kSize, kSize),
                           vk::SpecializationMapEntry(kTileGroupConstant, 4 * kSize, kSize),
                           vk::SpecializationMapEntry(kPatternsConstant, 5 * kSize, kSize)};
  const vk::SpecializationInfo constants(entries.size(), entries.data(), sizeof values, values.data());
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &constants);
  return device().createComputePipeline(cache_, vk::ComputePipelineCreateInfo({}, stage, *pipeline_layout_));
}

std::uint32_t OpenedDevice::group_size_of(Shader shader) const {
  switch (shader) {
    case Shader::AdaptiveRaster:
    case Shader::AdaptiveRasterPatterned:
    case Shader::AdaptiveRasterOccluded: return draws_as_processor_ ? kTileGroupOfProcessor : kTileGroup;
    case Shader::AdaptiveSearch:
    case Shader::AdaptiveMeasure:
    case Shader::AdaptiveMeasureOccluded:
    case Shader::AdaptiveBudget:
    case Shader::AdaptiveJoinParts: return 256;
    case Shader::AdaptiveCutSize:
    case Shader::ListSizes: return 1;
    default: return 64;
  }
}

vk::Pipeline OpenedDevice::pipeline_of(Program program) {
  const std::scoped_lock lock(pipelines_mutex_);
  vk::raii::Pipeline& pipeline = pipelines_[number_of(program)];
  if (*pipeline == vk::Pipeline{}) pipeline = compiled(program);
  return *pipeline;
}

void OpenedDevice::submit(const vk::SubmitInfo& work, vk::Fence fence) {
  const std::scoped_lock lock(*queue_mutex_);
  queued_.queue.submit(work, fence);
}

// It owns itself, so that it lives to the end of the process. The caller sees to it that this happens once.
void OpenedDevice::abandon(const std::shared_ptr<OpenedDevice>& device) {
  device->has_failed_ = true;
  device->is_abandoned_ = true;
  device->itself_ = device;
}

}  // namespace contrejour::inline internal::vulkan
