// SPDX-License-Identifier: Apache-2.0
#include "caller.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>

#include "device.h"

namespace contrejour::test {
namespace {

// The header's own declarations are Vulkan's.
static_assert(std::is_same_v<VulkanGetInstanceProcAddr, PFN_vkGetInstanceProcAddr>);
static_assert(std::is_same_v<decltype(VulkanHandles::device), VkDevice>);
static_assert(std::is_same_v<decltype(VulkanImage::image), VkImage>);
static_assert(std::is_same_v<decltype(VulkanSemaphore::semaphore), VkSemaphore>);
static_assert(kVulkanRgba32Float == VK_FORMAT_R32G32B32A32_SFLOAT &&
              kVulkanRgba16Float == VK_FORMAT_R16G16B16A16_SFLOAT);
static_assert(VulkanImage{}.layout_before == VK_IMAGE_LAYOUT_UNDEFINED);
static_assert(VulkanImage{}.layout_after == VK_IMAGE_LAYOUT_GENERAL);

using ImageUse = vk::ImageUsageFlagBits;
using BufferUse = vk::BufferUsageFlagBits;

VKAPI_ATTR VkBool32 VKAPI_CALL note_message(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                            VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* /*user*/) {
  add_message(data->pMessage);
  return VK_FALSE;
}

bool has_validation(const vk::raii::Context& loader) {
  return std::ranges::any_of(loader.enumerateInstanceLayerProperties(), [](const vk::LayerProperties& layer) {
    return std::string_view(layer.layerName) == "VK_LAYER_KHRONOS_validation";
  });
}

std::optional<std::uint32_t> family_that_computes(const vk::raii::PhysicalDevice& device) {
  const auto families = device.getQueueFamilyProperties();
  for (std::uint32_t k = 0; k < families.size(); ++k)
    if (families[k].queueFlags & vk::QueueFlagBits::eCompute) return k;
  return std::nullopt;
}

std::size_t numbers_of(const VulkanImage& image) {
  return 4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

std::size_t bytes_a_number(std::uint32_t format) { return format == kVulkanRgba16Float ? 2 : 4; }

vk::ImageMemoryBarrier between(const VulkanImage& image, std::uint32_t from, std::uint32_t to) {
  const vk::AccessFlags all = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;
  return {all,
          all,
          static_cast<vk::ImageLayout>(from),
          static_cast<vk::ImageLayout>(to),
          VK_QUEUE_FAMILY_IGNORED,
          VK_QUEUE_FAMILY_IGNORED,
          vk::Image(image.image),
          {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}};
}

void record_barrier(const vk::raii::CommandBuffer& commands, const vk::ImageMemoryBarrier& barrier) {
  const vk::PipelineStageFlags all = vk::PipelineStageFlagBits::eAllCommands;
  commands.pipelineBarrier(all, all, {}, {}, {}, barrier);
}

}  // namespace

std::unique_ptr<Caller> Caller::make(bool has_doubles) {
  std::unique_ptr<Caller> caller(new Caller());
  caller->library_ = SharedLibrary::open({"libvulkan.so.1", "vulkan-1.dll", "libvulkan.dylib"});
  if (!caller->library_) return nullptr;
  caller->loader_ = std::make_unique<vk::raii::Context>(
      reinterpret_cast<PFN_vkGetInstanceProcAddr>(caller->library_->function("vkGetInstanceProcAddr")));
  const vk::ApplicationInfo application("caller", 1, "caller", 1, VK_API_VERSION_1_3);
  vk::InstanceCreateInfo create({}, &application);
  const std::array<const char*, 1> layers{"VK_LAYER_KHRONOS_validation"}, extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
  const vk::ValidationFeatureEnableEXT synchronization = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT features(synchronization);
  const bool validates = has_validation(*caller->loader_);
  if (validates) create.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions).setPNext(&features);
  try {
    caller->instance_ = vk::raii::Instance(*caller->loader_, create);
  } catch (const std::exception&) {
    return nullptr;  // there is no driver
  }
  if (validates) {
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    caller->messenger_ = caller->instance_.createDebugUtilsMessengerEXT(
        {{}, Severity::eWarning | Severity::eError, vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation, note_message});
  }
  for (vk::raii::PhysicalDevice& physical : vk::raii::PhysicalDevices(caller->instance_)) {
    const auto family = family_that_computes(physical);
    if (!family || !physical.getFeatures().shaderFloat64) continue;
    caller->physical_ = std::move(physical);
    caller->family_ = *family;
    if (has_doubles) enable_vulkan_features(caller->features_);
    const float priority = 1.0F;
    const vk::DeviceQueueCreateInfo queue({}, *family, 1, &priority);
    vk::PhysicalDeviceTimelineSemaphoreFeatures timeline(VK_TRUE);
    caller->device_ =
        vk::raii::Device(caller->physical_, vk::DeviceCreateInfo({}, queue, {}, {}, &caller->features_, &timeline));
    caller->queue_ = vk::raii::Queue(caller->device_, *family, 0);
    return caller;
  }
  return nullptr;
}

VulkanHandles Caller::handles() const {
  VulkanHandles out;
  out.get_instance_proc_addr = loader_->getDispatcher()->vkGetInstanceProcAddr;
  out.instance = static_cast<VkInstance>(*instance_);
  out.api_version = VK_API_VERSION_1_3;
  out.physical_device = static_cast<VkPhysicalDevice>(*physical_);
  out.device = static_cast<VkDevice>(*device_);
  out.features = &static_cast<const VkPhysicalDeviceFeatures&>(features_);
  out.queue = static_cast<VkQueue>(*queue_);
  out.queue_family = family_;
  return out;
}

CallerMemory Caller::memory_for(const vk::MemoryRequirements& required, bool is_mapped) const {
  const auto types = physical_.getMemoryProperties();
  const vk::MemoryPropertyFlags visible =
      vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
  for (std::uint32_t k = 0; k < types.memoryTypeCount; ++k) {
    const bool is_fit = !is_mapped || (types.memoryTypes[k].propertyFlags & visible) == visible;
    if ((required.memoryTypeBits & (1U << k)) == 0 || !is_fit) continue;
    CallerMemory out{vk::raii::DeviceMemory(device_, vk::MemoryAllocateInfo(required.size, k))};
    if (is_mapped) out.mapped = static_cast<std::byte*>(out.memory.mapMemory(0, VK_WHOLE_SIZE));
    return out;
  }
  FAIL("no memory of the device is fit");
  return {};
}

CallerBuffer Caller::buffer(std::uint32_t format, std::uint64_t bytes, std::uint8_t fill) {
  CallerBuffer out;
  out.owned =
      vk::raii::Buffer(device_, vk::BufferCreateInfo({}, bytes, BufferUse::eTransferDst | BufferUse::eTransferSrc));
  out.memory = memory_for(out.owned.getMemoryRequirements(), true);
  out.owned.bindMemory(*out.memory.memory, 0);
  std::memset(out.memory.mapped, fill, bytes);
  out.buffer = {static_cast<VkBuffer>(*out.owned), format, bytes, 0};
  return out;
}

template <class Record>
void Caller::run(const Record& record) {
  const vk::raii::CommandPool pool(device_, vk::CommandPoolCreateInfo({}, family_));
  const vk::raii::CommandBuffers all(device_,
                                     vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1));
  const vk::raii::CommandBuffer& commands = all.front();
  commands.begin(vk::CommandBufferBeginInfo());
  record(commands);
  commands.end();
  queue_.submit(vk::SubmitInfo({}, {}, *commands));
  queue_.waitIdle();
}

CallerImage Caller::image(std::uint32_t format, int width, int height, float fill) {
  CallerImage out;
  const vk::Extent3D extent(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 1);
  out.owned = vk::raii::Image(
      device_, vk::ImageCreateInfo({}, vk::ImageType::e2D, static_cast<vk::Format>(format), extent, 1, 1,
                                   vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                                   ImageUse::eTransferDst | ImageUse::eTransferSrc | ImageUse::eSampled));
  out.memory = memory_for(out.owned.getMemoryRequirements(), false);
  out.owned.bindMemory(*out.memory.memory, 0);
  out.image = {static_cast<VkImage>(*out.owned),        format, width, height, 0, 0, VK_IMAGE_LAYOUT_GENERAL,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  run([&](const vk::raii::CommandBuffer& commands) {
    record_barrier(commands, between(out.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL));
    commands.clearColorImage(*out.owned, vk::ImageLayout::eGeneral,
                             vk::ClearColorValue(std::array<float, 4>{fill, fill, fill, fill}),
                             vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1));
  });
  return out;
}

std::vector<std::byte> Caller::bytes_of(const CallerImage& image) {
  const VulkanImage& from = image.image;
  const std::size_t bytes = bytes_a_number(from.format) * numbers_of(from);
  const CallerBuffer to = buffer(from.format, bytes, 0);
  run([&](const vk::raii::CommandBuffer& commands) {
    record_barrier(commands, between(from, from.layout_after, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL));
    const vk::BufferImageCopy copy(
        0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1}, {},
        {static_cast<std::uint32_t>(from.width), static_cast<std::uint32_t>(from.height), 1});
    commands.copyImageToBuffer(*image.owned, vk::ImageLayout::eTransferSrcOptimal, *to.owned, copy);
    record_barrier(commands, between(from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, from.layout_after));
  });
  return {to.memory.mapped, to.memory.mapped + bytes};
}

void Caller::wait_on_queue(vk::Semaphore semaphore) {
  const vk::PipelineStageFlags all = vk::PipelineStageFlagBits::eAllCommands;
  queue_.submit(vk::SubmitInfo(1, &semaphore, &all));
  queue_.waitIdle();
}

}  // namespace contrejour::test
