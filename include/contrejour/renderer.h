// SPDX-License-Identifier: Apache-2.0
// A renderer that lives from frame to frame: it keeps what frames have in common (reflectance tables, pupils, direct
// fluxes, starbursts, diffraction patterns, dirt, scratch memory) and writes into a caller's pixels. render.h renders
// one frame without it. What is kept never changes a picture: a frame is equal, bit for bit, to that of render().
// Errors: InvalidArgument, Cancelled; after either the renderer is usable as before. Thread-safety: one thread at a
// time uses a renderer; two renderers share nothing that one of them changes, and another() shares the device, which
// several threads may use.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "contrejour/context.h"
#include "contrejour/expert/flare_layers.h"
#include "contrejour/export.h"
#include "contrejour/frame_settings.h"
#include "contrejour/image_view.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/method_options.h"
#include "contrejour/render.h"

namespace contrejour {

struct VulkanHandles;
struct VulkanTarget;

// Frames are computed (docs/gpu.md) on the CPU; by Vulkan on a GPU; or there if possible, and else on the CPU.
enum class Device { Cpu, Vulkan, Auto };

// Where a frame goes.
struct FrameTarget {
  ImageView pixels;  // as large as settings.frame, which may be a region of a larger picture
  // Called once with a draft in the pixels, before the frame itself is rendered: the same flare by `adaptive` at an
  // RMS error of 0.02. Empty: no draft.
  std::function<void()> draft_is_ready = {};
  // The frame is rendered and not written, whatever the pixels: to measure it without copying it from a device.
  bool is_discarded = false;
};

class CONTREJOUR_API Renderer {
 public:
  // which: the device's index or a part of its name (list_devices); empty: the environment's CONTREJOUR_DEVICE, or the
  // first usable one. Errors: there is no such method; Unsupported, if Device::Vulkan has no usable device. Options out
  // of range are refused when a frame is rendered.
  [[nodiscard]] static Result<Renderer> create(MethodOptions method = AdaptiveOptions{}, Device device = Device::Cpu,
                                               const std::string& which = {});
  // A renderer with the same method, lens and device, for frames that another thread draws at the same time, which have
  // the same bits. On a device the two share the logical device, its queue and its pipelines, so that the device has
  // work while either prepares a frame (docs/gpu.md); each has buffers of its own, and keeps data of its own. Errors:
  // Unsupported, if the device fails. Thread-safety: as of the other functions; afterwards each has its own thread.
  [[nodiscard]] Result<Renderer> another() const;
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  // The lens of the frames that follow. Data that do not depend on the changes are kept.
  [[nodiscard]] Result<void> set_lens(LensState lens);
  // The method of the frames that follow.
  [[nodiscard]] Result<void> set_method(MethodOptions method);

  // The device of the frames that follow, as for create(); one that is open already stays so. Errors: Unsupported,
  // after which the CPU renders.
  [[nodiscard]] Result<void> set_device(Device device, const std::string& which = {});

  // Uses a Vulkan device of the caller for the frames that follow (expert/vulkan_target.h), until set_device() or
  // configure_renderer(). another() uses the queue from its own thread, one submission at a time. If it fails later, a
  // frame is an error. Errors: Unsupported, with the names of all that the device lacks; the CPU then renders.
  [[nodiscard]] Result<void> set_vulkan_device(const VulkanHandles& handles);

  // Whether a device draws the frames, as far as it can; false: all are drawn by the CPU.
  [[nodiscard]] bool has_device() const;

  // Why Device::Auto chose the CPU; empty: it did not. What a device cannot draw the CPU draws in any case, which
  // RenderStatistics::device states for each frame.
  [[nodiscard]] const std::string& device_note() const;

  // Errors: also that no lens was set.
  [[nodiscard]] Result<RenderStatistics> render(std::span<const Light> lights, const FrameSettings& settings,
                                                const FrameTarget& target, const Context& context = {});
  [[nodiscard]] Result<Flare> render(std::span<const Light> lights, const FrameSettings& settings,
                                     const Context& context = {});

  // Renders into an image or buffer of the device of set_vulkan_device(), whose work has finished when this returns.
  // A frame that the device cannot draw as a whole is drawn by the CPU and uploaded; RenderStatistics::device says so.
  // Errors: also a target that does not suit the frame. After an error the target and its semaphores are untouched,
  // unless the device was lost or gave no answer.
  [[nodiscard]] Result<RenderStatistics> render_to_vulkan(std::span<const Light> lights, const FrameSettings& settings,
                                                          const VulkanTarget& target, const Context& context = {});

  // The frame in layers, equal to those of the function of this name.
  [[nodiscard]] Result<LayeredFlare> render_layers(std::span<const Light> lights, const FrameSettings& settings,
                                                   const LayerOptions& options, const Context& context = {});

  // The approximate memory that is kept for the frames to come: up to 300 MB of pupils, fluxes and starbursts, and up
  // to 256 MB of the pixels of pictures and layers that were destroyed, all of which the last four frames used; and
  // what tables, patterns, dirt and scratch memory take.
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace contrejour
