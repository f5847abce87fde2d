// SPDX-License-Identifier: Apache-2.0
// A program with a Vulkan device of its own gets a flare as an image of that device: flare_image OUT.exr
// A game would sample the image where it composes its frame; this program copies it to a buffer and writes the pixels.
#include <cstdio>
#include <span>
#include <stdexcept>

#include <vulkan/vulkan_raii.hpp>

#include "contrejour/contrejour.h"
#include "contrejour/expert/vulkan_target.h"

namespace {

constexpr std::uint32_t kWidth = 320, kHeight = 180;
constexpr std::uint32_t kFamily = 0;  // draws and computes in nearly all drivers; missing_for_vulkan() says if not

template <class T>
T value_of(contrejour::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().to_string());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

struct Program {
  vk::raii::Context loader;
  vk::ApplicationInfo application{"flare_image", 1, nullptr, 0, VK_API_VERSION_1_3};
  vk::raii::Instance instance{loader, vk::InstanceCreateInfo({}, &application)};
  vk::raii::PhysicalDevice gpu = std::move(vk::raii::PhysicalDevices(instance).front());
  vk::PhysicalDeviceFeatures features = needed_features();
  float priority = 1.0F;
  vk::DeviceQueueCreateInfo queues{{}, kFamily, 1, &priority};
  vk::raii::Device device{gpu, vk::DeviceCreateInfo({}, queues, {}, {}, &features)};
  vk::raii::Queue queue{device, kFamily, 0};

  static vk::PhysicalDeviceFeatures needed_features() {
    vk::PhysicalDeviceFeatures needed;  // and those that the program itself needs
    contrejour::enable_vulkan_features(needed);
    return needed;
  }

  contrejour::VulkanHandles handles() const {
    const VkPhysicalDeviceFeatures& enabled = features;
    return {loader.getDispatcher()->vkGetInstanceProcAddr,
            *instance,
            application.apiVersion,
            *gpu,
            *device,
            &enabled,
            *queue,
            kFamily};
  }

  // Memory of the kind that is wanted, for an image or a buffer, bound to it.
  template <class Resource>
  vk::raii::DeviceMemory memory_of(Resource& resource, vk::MemoryPropertyFlags wanted) const {
    const vk::MemoryRequirements needs = resource.getMemoryRequirements();
    const auto types = gpu.getMemoryProperties();
    std::uint32_t k = 0;
    while ((needs.memoryTypeBits >> k & 1U) == 0 || (types.memoryTypes[k].propertyFlags & wanted) != wanted) ++k;
    vk::raii::DeviceMemory memory(device, vk::MemoryAllocateInfo(needs.size, k));
    resource.bindMemory(*memory, 0);
    return memory;
  }
};

// Draws the flare of one light into an image, which is then ready to be copied.
void draw_flare(const Program& program, vk::Image image) {
  using namespace contrejour;
  auto renderer = value_of(Renderer::create());
  value_of(renderer.set_vulkan_device(program.handles()));
  const LensState lens = value_of(configure_lens(value_of(find_lens("heliar")), {.f_number = 8.0}));
  value_of(renderer.set_lens(lens));
  FrameSettings settings;
  settings.frame = frame_on_sensor(lens, kWidth, kHeight);
  const Light light{.direction = direction_from_angles(0.15, 0.1), .value = {1000, 900, 800}};
  VulkanImage target{image, VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight};
  target.layout_after = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  const auto statistics = value_of(renderer.render_to_vulkan(std::span(&light, 1), settings, {.to = target}));
  std::printf("drawn by %s\n", statistics.device.c_str());
}

void run(const char* file) {
  const Program program;
  using Use = vk::ImageUsageFlagBits;
  vk::raii::Image image(
      program.device, vk::ImageCreateInfo({}, vk::ImageType::e2D, vk::Format::eR32G32B32A32Sfloat, {kWidth, kHeight, 1},
                                          1, 1, vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                                          Use::eTransferDst | Use::eTransferSrc));
  const auto image_memory = program.memory_of(image, {});
  draw_flare(program, *image);

  vk::raii::Buffer pixels(program.device, vk::BufferCreateInfo({}, sizeof(float) * 4 * kWidth * kHeight,
                                                               vk::BufferUsageFlagBits::eTransferDst));
  using Kind = vk::MemoryPropertyFlagBits;
  const auto memory = program.memory_of(pixels, Kind::eHostVisible | Kind::eHostCoherent);
  const vk::raii::CommandPool pool(program.device, vk::CommandPoolCreateInfo({}, kFamily));
  const vk::raii::CommandBuffers commands(program.device, {*pool, vk::CommandBufferLevel::ePrimary, 1});
  commands.front().begin(vk::CommandBufferBeginInfo());
  const vk::BufferImageCopy copy(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1}, {}, {kWidth, kHeight, 1});
  commands.front().copyImageToBuffer(*image, vk::ImageLayout::eTransferSrcOptimal, *pixels, copy);
  commands.front().pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost, {},
                                   vk::MemoryBarrier(vk::AccessFlagBits::eTransferWrite, vk::AccessFlagBits::eHostRead),
                                   {}, {});
  commands.front().end();
  program.queue.submit(vk::SubmitInfo({}, {}, *commands.front()));
  program.queue.waitIdle();
  const auto* const rgba = static_cast<const float*>(memory.mapMemory(0, VK_WHOLE_SIZE));
  contrejour::Image flare(kWidth, kHeight);
  for (std::size_t k = 0; k < flare.pixels.size(); ++k) flare.pixels[k] = rgba[k / 3 * 4 + k % 3];
  value_of(contrejour::write_exr(file, flare));
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count != 2) throw std::runtime_error("usage: flare_image OUT.exr");
    run(arguments[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
