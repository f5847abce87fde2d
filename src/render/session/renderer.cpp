// SPDX-License-Identifier: Apache-2.0
#include "contrejour/renderer.h"

#include <optional>
#include <utility>

#include "contrejour/expert/check_lens.h"
#include "render/device/kept_device.h"
#include "render/session/registry.h"
#include "render/session/render_frame.h"

namespace contrejour {
namespace {

constexpr double kDraftError = 0.02;
constexpr double kDraftProgress = 0.2;  // fraction of the whole progress

Context rest_of(const Context& whole, double from) {
  Context rest = whole;
  if (whole.progress) rest.progress = [&whole, from](double done) { whole.progress(from + (1.0 - from) * done); };
  return rest;
}

// Writes a flare to the caller's pixels. Its own memory then serves the session's next frame.
Result<RenderStatistics> write_out(Flare flare, const ImageView& to, const Context& context) {
  if (const auto written = write_pixels(flare.image, to, context); !written) return tl::unexpected(written.error());
  return std::move(flare.statistics);
}

tl::unexpected<Error> no_lens() { return invalid_argument("a renderer has no lens yet: call set_lens() first"); }

}  // namespace

struct Renderer::State {
  MethodOptions method;
  std::optional<LensState> lens = std::nullopt;
  RenderCache cache = {};
  std::optional<std::pair<Device, std::string>> device = std::pair(Device::Cpu, std::string());  // none: a lent one
  std::string device_note = {};

  [[nodiscard]] Result<Flare> render(const MethodOptions& by, std::span<const Light> lights,
                                     const FrameSettings& settings, const Context& context) {
    if (!lens) return no_lens();
    return render_frame(by, {*lens, lights, settings, cache}, context);
  }

  [[nodiscard]] Result<LayeredFlare> render_layers(std::span<const Light> lights, const FrameSettings& settings,
                                                   const LayerOptions& options, const Context& context) {
    if (!lens) return no_lens();
    return render_frame_layers(method, {*lens, lights, settings, cache, &options}, context);
  }
};

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Result<Renderer> Renderer::create(MethodOptions method, Device device, const std::string& which) {
  if (const auto known = known_method(method.name()); !known) return tl::unexpected(known.error());
  Renderer renderer(std::make_unique<State>(State{std::move(method)}));
  if (const auto set = renderer.set_device(device, which); !set) return tl::unexpected(set.error());
  return renderer;
}

Result<Renderer> Renderer::another() const {
  Renderer renderer(std::make_unique<State>(State{state_->method, state_->lens}));
  renderer.state_->device = state_->device;
  renderer.state_->device_note = state_->device_note;
  const auto own = state_->cache.find<KeptDevice>();
  if (!own) return renderer;
  KeptDevice& kept = *renderer.state_->cache.section<KeptDevice>({});
  kept.is_required = own->is_required;
  if (own->device) {
    auto device = own->device->another();
    if (!device) return tl::unexpected(device.error());
    kept.device = std::move(*device);
  }
  return renderer;
}

Result<void> Renderer::set_device(Device device, const std::string& which) {
  if (state_->device == std::pair(device, which)) return {};
  KeptDevice& kept = *state_->cache.section<KeptDevice>({});
  kept.device = nullptr;
  kept.is_required = device == Device::Vulkan;
  state_->device = std::pair(Device::Cpu, std::string());
  state_->device_note.clear();
  if (device != Device::Cpu) {
    auto opened = open_frame_device({.which = which});
    if (!opened && device == Device::Vulkan) return tl::unexpected(opened.error());
    if (opened)
      kept.device = std::move(*opened);
    else
      state_->device_note = opened.error().message;
  }
  state_->device = std::pair(device, which);
  return {};
}

Result<void> Renderer::set_vulkan_device(const VulkanHandles& handles) {
  if (auto to_cpu = set_device(Device::Cpu); !to_cpu) return to_cpu;
  auto opened = open_frame_device({.lent = handles});
  if (!opened) return tl::unexpected(opened.error());
  KeptDevice& kept = *state_->cache.section<KeptDevice>({});
  kept.device = std::move(*opened);
  kept.is_required = true;
  state_->device.reset();
  return {};
}

bool Renderer::has_device() const {
  const auto kept = state_->cache.find<KeptDevice>();
  return kept && kept->device;
}

const std::string& Renderer::device_note() const { return state_->device_note; }

Result<void> Renderer::set_lens(LensState lens) {
  if (auto good = check_lens(lens); !good) return tl::unexpected(good.error());
  state_->lens = std::move(lens);
  return {};
}

Result<void> Renderer::set_method(MethodOptions method) {
  if (const auto known = known_method(method.name()); !known) return tl::unexpected(known.error());
  state_->method = std::move(method);
  return {};
}

Result<RenderStatistics> Renderer::render(std::span<const Light> lights, const FrameSettings& settings,
                                          const FrameTarget& target, const Context& context) {
  state_->cache.next_frame();
  const Frame& frame = settings.frame;
  if (const auto good = check_view(target.pixels, frame.width, frame.height); !target.is_discarded && !good)
    return tl::unexpected(good.error());
  Context quiet = context;
  quiet.progress = {};
  double drafted = 0.0;
  if (target.draft_is_ready && !target.is_discarded) {
    auto draft = state_->render(AdaptiveOptions{kDraftError}, lights, settings, quiet);
    if (!draft) return tl::unexpected(draft.error());
    if (const auto written = write_out(std::move(*draft), target.pixels, quiet); !written) return written;
    target.draft_is_ready();
    drafted = kDraftProgress;
  }
  KeptDevice& kept = *state_->cache.section<KeptDevice>({});
  kept.use = target.is_discarded ? PictureUse::Discarded : PictureUse::Read;
  auto flare = state_->render(state_->method, lights, settings, rest_of(context, drafted));
  kept.use = PictureUse::Read;
  if (!flare) return tl::unexpected(flare.error());
  if (target.is_discarded) return std::move(flare->statistics);
  return write_out(std::move(*flare), target.pixels, quiet);
}

Result<RenderStatistics> Renderer::render_to_vulkan(std::span<const Light> lights, const FrameSettings& settings,
                                                    const VulkanTarget& target, const Context& context) {
  if (state_->device) return invalid_argument("the renderer has no Vulkan device of yours: call set_vulkan_device()");
  if (!state_->lens) return no_lens();
  state_->cache.next_frame();
  return render_frame_to(state_->method, {*state_->lens, lights, settings, state_->cache}, target, context);
}

Result<Flare> Renderer::render(std::span<const Light> lights, const FrameSettings& settings, const Context& context) {
  state_->cache.next_frame();
  return state_->render(state_->method, lights, settings, context);
}

Result<LayeredFlare> Renderer::render_layers(std::span<const Light> lights, const FrameSettings& settings,
                                             const LayerOptions& options, const Context& context) {
  state_->cache.next_frame();
  return state_->render_layers(lights, settings, options, context);
}

std::size_t Renderer::memory_bytes() const { return state_->cache.memory_bytes(); }

}  // namespace contrejour
