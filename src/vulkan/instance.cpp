// SPDX-License-Identifier: Apache-2.0
#include "vulkan/instance.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "vulkan/layout.h"
#include "vulkan/slots.h"

namespace contrejour::inline internal::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::uint32_t kGroupSize = 256, kSharedBytes = 24 << 10U;  // of the largest shader (adaptive/measure.comp)
constexpr std::uint64_t kSmallestRange = std::uint64_t{64} << 20U;
constexpr std::uint32_t kFewestTexels = 1U << 24U;

VKAPI_ATTR VkBool32 VKAPI_CALL pass_message(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                            VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* listener) {
  (*static_cast<const Instance::OnMessage*>(listener))(data->pMessage);
  return VK_FALSE;
}

std::string kind_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu: return "discrete GPU";
    case vk::PhysicalDeviceType::eIntegratedGpu: return "integrated GPU";
    case vk::PhysicalDeviceType::eVirtualGpu: return "virtual GPU";
    case vk::PhysicalDeviceType::eCpu: return "processor";
    default: return "other";
  }
}

// Why a device cannot be used; empty: it can.
std::string reason_against(const vk::raii::PhysicalDevice& device, const vk::PhysicalDeviceLimits& limits) {
  const std::uint32_t version = device.getProperties().apiVersion;
  if (version < VK_API_VERSION_1_3)
    return fmt::format("its driver has Vulkan {}.{}, and 1.3 is needed", VK_API_VERSION_MAJOR(version),
                       VK_API_VERSION_MINOR(version));
  if (compute_family(device) < 0) return "it has no queue that computes";
  if (!device.getFeatures().shaderFloat64) return "its shaders have no double precision, which small pupils need";
  // All shaders share one set of buffers, which counts as a whole.
  if (const std::uint32_t most =
          std::min(limits.maxPerStageDescriptorStorageBuffers, limits.maxDescriptorSetStorageBuffers);
      most < kSlots)
    return fmt::format("its shaders take {} buffers, and {} are needed", most, kSlots);
  if (const std::uint32_t most = std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
      most < kGroupSize)
    return fmt::format("its workgroups hold {} invocations, and {} are needed", most, kGroupSize);
  if (limits.maxComputeSharedMemorySize < kSharedBytes)
    return fmt::format("its workgroups share {} bytes of memory, and {} are needed", limits.maxComputeSharedMemorySize,
                       kSharedBytes);
  if (limits.maxStorageBufferRange < kSmallestRange)
    return fmt::format("its buffers end at {} MiB, and {} MiB are needed", limits.maxStorageBufferRange >> 20U,
                       kSmallestRange >> 20U);
  if (limits.maxTexelBufferElements < kFewestTexels)
    return fmt::format("its shaders read {} texels of a buffer, and {} are needed", limits.maxTexelBufferElements,
                       kFewestTexels);
  if (limits.maxUniformBufferRange < kPathRange)
    return fmt::format("its uniform buffers end at {} bytes, and {} are needed", limits.maxUniformBufferRange,
                       kPathRange);
  return {};
}

DeviceInfo info_of(const vk::raii::PhysicalDevice& device, int index) {
  const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties,
                                           vk::PhysicalDeviceSubgroupProperties>();
  const auto& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
  const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  const vk::PhysicalDeviceLimits& limits = properties.limits;
  DeviceInfo info;
  info.index = index;
  info.name = std::string_view(properties.deviceName);
  info.kind = kind_of(properties.deviceType);
  info.driver = fmt::format("{} {}", std::string_view(driver.driverName), std::string_view(driver.driverInfo));
  info.reason = reason_against(device, limits);
  info.is_usable = info.reason.empty();
  const auto memory = device.getMemoryProperties();
  for (std::uint32_t k = 0; k < memory.memoryHeapCount; ++k)
    if (memory.memoryHeaps[k].flags & vk::MemoryHeapFlagBits::eDeviceLocal)
      info.memory_bytes = std::max<std::uint64_t>(info.memory_bytes, memory.memoryHeaps[k].size);
  info.storage_range_bytes = limits.maxStorageBufferRange;
  info.shared_memory_bytes = limits.maxComputeSharedMemorySize;
  info.groups_an_axis =
      *std::min_element(limits.maxComputeWorkGroupCount.begin(), limits.maxComputeWorkGroupCount.end());
  info.group_size = limits.maxComputeWorkGroupInvocations;
  info.subgroup_size = chain.get<vk::PhysicalDeviceSubgroupProperties>().subgroupSize;
  info.has_doubles = device.getFeatures().shaderFloat64 != VK_FALSE;
  return info;
}

bool has_layer(const vk::raii::Context& loader, std::string_view name) {
  return std::ranges::any_of(loader.enumerateInstanceLayerProperties(), [&](const vk::LayerProperties& layer) {
    return std::string_view(layer.layerName) == name;
  });
}

std::unique_ptr<SharedLibrary> open_loader() {
#if defined(_WIN32)
  auto library = SharedLibrary::open({"vulkan-1.dll"});
#elif defined(__APPLE__)
  auto library = SharedLibrary::open({"libvulkan.dylib", "libvulkan.1.dylib"});
#else
  auto library = SharedLibrary::open({"libvulkan.so.1", "libvulkan.so"});
#endif
  if (!library) throw std::runtime_error("the Vulkan loader is not installed");
  return library;
}

PFN_vkGetInstanceProcAddr function_finder(const SharedLibrary& loader) {
  void* const found = loader.function("vkGetInstanceProcAddr");
  if (found == nullptr) throw std::runtime_error("the Vulkan loader has no vkGetInstanceProcAddr");
  return reinterpret_cast<PFN_vkGetInstanceProcAddr>(found);
}

PFN_vkGetInstanceProcAddr function_finder(const VulkanHandles& lent) { return lent.get_instance_proc_addr; }

}  // namespace

int compute_family(const vk::raii::PhysicalDevice& device) {
  const auto families = device.getQueueFamilyProperties();
  const auto found = std::ranges::find_if(
      families, [](const auto& family) { return bool(family.queueFlags & vk::QueueFlagBits::eCompute); });
  return found == families.end() ? -1 : static_cast<int>(found - families.begin());
}

Instance::Instance(OnMessage on_message)
    : on_message_(std::move(on_message)), library_(open_loader()), loader_(function_finder(*library_)) {
  const vk::ApplicationInfo application("contrejour", 1, "contrejour", 1, VK_API_VERSION_1_3);
  vk::InstanceCreateInfo create({}, &application);
  const bool validates = on_message_ && has_layer(loader_, kValidationLayer);
  const std::array<const char*, 1> layers{kValidationLayer}, extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
  const vk::ValidationFeatureEnableEXT enabled = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT features(enabled);
  if (validates) {
    create.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions).setPNext(&features);
  }
  instance_.object = vk::raii::Instance(loader_, create);
  if (validates) listen();
  physical_ = vk::raii::PhysicalDevices(instance_.object);
}

Instance::Instance(const VulkanHandles& lent) : loader_(function_finder(lent)) {
  instance_.lend(vk::raii::Instance(loader_, lent.instance));
  physical_.emplace_back(instance_.object, lent.physical_device);
}

bool Instance::has_physical(VkPhysicalDevice device) const {
  return std::ranges::any_of(vk::raii::PhysicalDevices(instance_.object),
                             [&](const vk::raii::PhysicalDevice& one) { return *one == vk::PhysicalDevice(device); });
}

void Instance::listen() {
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  const vk::DebugUtilsMessengerCreateInfoEXT create({}, Severity::eWarning | Severity::eError,
                                                    vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation, pass_message,
                                                    &on_message_);
  messenger_ = vk::raii::DebugUtilsMessengerEXT(instance_.object, create);
}

Result<std::unique_ptr<Instance>> Instance::open(const OnMessage& on_message) {
  try {
    return std::unique_ptr<Instance>(new Instance(on_message));
  } catch (const std::exception& error) {
    return failure(
        ErrorCode::Unsupported,
        fmt::format("there is no Vulkan here ({}): install a driver for the GPU and the Vulkan loader", error.what()));
  }
}

Result<std::unique_ptr<Instance>> Instance::borrow(const VulkanHandles& lent) {
  try {
    return std::unique_ptr<Instance>(new Instance(lent));
  } catch (const std::exception& error) {
    return failure(ErrorCode::Unsupported, fmt::format("the instance cannot be used: {}", error.what()));
  }
}

std::vector<DeviceInfo> Instance::devices() const {
  std::vector<DeviceInfo> all;
  for (std::size_t k = 0; k < physical_.size(); ++k) all.push_back(info_of(physical_[k], static_cast<int>(k)));
  return all;
}

}  // namespace contrejour::inline internal::vulkan
