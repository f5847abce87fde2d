// SPDX-License-Identifier: Apache-2.0
#include "vulkan/picture_writer.h"

#include <algorithm>

#include "render/device/check_target.h"
#include "vulkan/layout.h"

namespace contrejour::inline internal::vulkan {
namespace {

using Access = vk::AccessFlagBits;
using WriterStage = vk::PipelineStageFlagBits;

// The parameters of rgba.comp, in their order.
struct RgbaParameters {
  std::uint32_t first = 0, count = 0, is_half = 0;
};

// A caller may have used its image or buffer in any way before, and may do so afterwards; the host may read a mapped
// buffer after the call.
constexpr vk::PipelineStageFlags kCallersStages = WriterStage::eAllCommands;
constexpr vk::AccessFlags kCallersAccess = Access::eMemoryRead | Access::eMemoryWrite;

// The image from one layout to another.
vk::ImageMemoryBarrier transition(const VulkanImage& image, vk::AccessFlags before, vk::AccessFlags after,
                                  vk::ImageLayout from, vk::ImageLayout to) {
  return {before,
          after,
          from,
          to,
          VK_QUEUE_FAMILY_IGNORED,
          VK_QUEUE_FAMILY_IGNORED,
          vk::Image(image.image),
          {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}};
}

}  // namespace

PictureWriter::PictureWriter(DeviceContext& device, const DeviceInfo& info, int most_rows, const VulkanTarget& target)
    : device_(device), info_(info), most_rows_(most_rows), target_(target),
      format_(std::visit([](const auto& to) { return to.format; }, target.to)), pixel_bytes_(pixel_bytes(format_)) {}

int PictureWriter::rows_a_band(const StoredPicture& picture) const {
  const std::uint64_t row_bytes =
      std::max<std::uint64_t>(pixel_bytes_, kPixelBytes) * static_cast<std::uint64_t>(picture.width);
  const int fitting = static_cast<int>(
      std::clamp<std::uint64_t>(info_.storage_range_bytes / row_bytes, 1, static_cast<std::uint64_t>(picture.height)));
  return most_rows_ > 0 ? std::min(fitting, most_rows_) : fitting;
}

void PictureWriter::open() {
  const vk::raii::CommandBuffer& commands = device_.commands();
  if (const auto* const image = std::get_if<VulkanImage>(&target_.to))
    commands.pipelineBarrier(
        kCallersStages, WriterStage::eTransfer, {}, {}, {},
        transition(*image, kCallersAccess, Access::eTransferWrite, static_cast<vk::ImageLayout>(image->layout_before),
                   vk::ImageLayout::eTransferDstOptimal));
  else
    commands.pipelineBarrier(kCallersStages, WriterStage::eTransfer, {},
                             vk::MemoryBarrier(kCallersAccess, Access::eTransferWrite), {}, {});
}

void PictureWriter::close() {
  const vk::raii::CommandBuffer& commands = device_.commands();
  if (const auto* const image = std::get_if<VulkanImage>(&target_.to))
    commands.pipelineBarrier(
        WriterStage::eTransfer, kCallersStages, {}, {}, {},
        transition(*image, Access::eTransferWrite, kCallersAccess, vk::ImageLayout::eTransferDstOptimal,
                   static_cast<vk::ImageLayout>(image->layout_after)));
  else
    commands.pipelineBarrier(WriterStage::eTransfer, kCallersStages | WriterStage::eHost, {},
                             vk::MemoryBarrier(Access::eTransferWrite, kCallersAccess | Access::eHostRead), {}, {});
}

void PictureWriter::convert(const StoredPicture& picture, int first_row, int rows) {
  const auto width = static_cast<std::uint64_t>(picture.width);
  const std::uint64_t pixels = width * static_cast<std::uint64_t>(rows);
  const std::uint64_t before = width * static_cast<std::uint64_t>(first_row);
  RgbaParameters p{static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(pixels),
                   format_ == kVulkanRgba16Float ? 1U : 0U};
  if (picture.rows != nullptr) {
    device_.copy(*picture.rows, kPixelBytes * before, Slot::Picture, kPixelBytes * pixels);
    device_.barrier();
    p.first = 0;
  }
  device_.dispatch(Shader::Rgba, p, groups_of(pixels, info_));
  device_.barrier();
}

void PictureWriter::copy_rows(const StoredPicture& picture, int first_row, int rows) {
  const vk::raii::CommandBuffer& commands = device_.commands();
  const vk::Buffer from = device_.at(Slot::Rays).handle();
  const auto width = static_cast<std::uint32_t>(picture.width);
  if (const auto* const image = std::get_if<VulkanImage>(&target_.to)) {
    const vk::BufferImageCopy copy(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                   {image->left, image->top + first_row, 0},
                                   {width, static_cast<std::uint32_t>(rows), 1});
    commands.copyBufferToImage(from, vk::Image(image->image), vk::ImageLayout::eTransferDstOptimal, copy);
  } else {
    const auto& to = std::get<VulkanBuffer>(target_.to);
    const std::uint64_t row_bytes = std::uint64_t{pixel_bytes_} * width;
    commands.copyBuffer(from, vk::Buffer(to.buffer),
                        vk::BufferCopy(0, to.offset_bytes + row_bytes * static_cast<std::uint64_t>(first_row),
                                       row_bytes * static_cast<std::uint64_t>(rows)));
  }
}

void PictureWriter::write(const StoredPicture& picture) {
  const int most = rows_a_band(picture);
  const auto pixels = static_cast<std::uint64_t>(picture.width) * static_cast<std::uint64_t>(most);
  device_.need(Slot::Rays, pixel_bytes_ * pixels);
  if (picture.rows != nullptr) device_.need(Slot::Picture, kPixelBytes * pixels);
  device_.begin();
  open();
  for (int row = 0; row < picture.height; row += most) {
    const int rows = std::min(most, picture.height - row);
    convert(picture, row, rows);
    copy_rows(picture, row, rows);
    device_.barrier();  // the next rows take the memory of these
  }
  close();
  device_.end_stage("hand over");
  device_.finish({target_.wait, target_.signal});
}

}  // namespace contrejour::inline internal::vulkan
