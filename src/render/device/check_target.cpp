// SPDX-License-Identifier: Apache-2.0
#include "render/device/check_target.h"

#include <fmt/format.h>

namespace contrejour::inline internal {
namespace {

constexpr std::uint32_t kUndefinedLayout = 0, kPreinitializedLayout = 8;  // VkImageLayout
constexpr std::uint64_t kCopyAlignment = 4;  // bytes: not all queues copy to other places of a buffer

Result<void> check_format(std::uint32_t format) {
  if (pixel_bytes(format) != 0) return {};
  return invalid_argument(
      fmt::format("a picture cannot be written in the VkFormat {}: use VK_FORMAT_R32G32B32A32_SFLOAT or "
                  "VK_FORMAT_R16G16B16A16_SFLOAT",
                  format));
}

Result<void> check_place(const VulkanImage& to, int width, int height) {
  if (to.image == nullptr) return invalid_argument("the Vulkan image to be written is null");
  if (const auto good = check_format(to.format); !good) return good;
  // Differences, since sums may be beyond the range of int.
  if (to.left < 0 || to.top < 0 || to.width < width || to.height < height || to.left > to.width - width ||
      to.top > to.height - height)
    return invalid_argument(fmt::format("a frame of {} x {} pixels at {}, {} exceeds the Vulkan image of {} x {}",
                                        width, height, to.left, to.top, to.width, to.height));
  if (to.layout_after == kUndefinedLayout || to.layout_after == kPreinitializedLayout)
    return invalid_argument("a Vulkan image cannot be left in VK_IMAGE_LAYOUT_UNDEFINED or _PREINITIALIZED");
  return {};
}

Result<void> check_place(const VulkanBuffer& to, int width, int height) {
  if (to.buffer == nullptr) return invalid_argument("the Vulkan buffer to be written is null");
  if (const auto good = check_format(to.format); !good) return good;
  if (to.offset_bytes % kCopyAlignment != 0)
    return invalid_argument(fmt::format("a picture begins at a multiple of {} bytes of a Vulkan buffer, not at {}",
                                        kCopyAlignment, to.offset_bytes));
  const std::uint64_t bytes =
      std::uint64_t{pixel_bytes(to.format)} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (to.size_bytes < bytes || to.offset_bytes > to.size_bytes - bytes)
    return invalid_argument(
        fmt::format("a frame of {} x {} pixels takes {} bytes, and the Vulkan buffer has {} from {}", width, height,
                    bytes, to.size_bytes, to.offset_bytes));
  return {};
}

}  // namespace

std::uint32_t pixel_bytes(std::uint32_t format) {
  return format == kVulkanRgba32Float ? 16 : format == kVulkanRgba16Float ? 8 : 0;
}

Result<void> check_target(const VulkanTarget& target, int width, int height) {
  return std::visit([&](const auto& to) { return check_place(to, width, height); }, target.to);
}

}  // namespace contrejour::inline internal
