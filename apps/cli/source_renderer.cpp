// SPDX-License-Identifier: Apache-2.0
#include "cli/source_renderer.h"

#include <utility>

#include <fmt/format.h>

#include "cli/console.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

Device device_of(const params::Values& values) {
  const std::string name = *values.text("device");
  return name == "vulkan" ? Device::Vulkan : name == "auto" ? Device::Auto : Device::Cpu;
}

}  // namespace

Result<SourceRenderer> renderer_of(const params::Values& values, const FlareSource& source) {
  if (const auto* flare = std::get_if<MeasuredFlare>(&source)) return SourceRenderer(*flare);
  auto renderer = Renderer::create(params::method_options(values), device_of(values));
  if (!renderer) return tl::unexpected(renderer.error());
  if (auto set = renderer->set_lens(std::get<LensState>(source)); !set) return tl::unexpected(set.error());
  if (!renderer->device_note().empty()) print_warnings({fmt::format("the CPU renders: {}", renderer->device_note())});
  return SourceRenderer(std::move(*renderer));
}

Result<Flare> render(SourceRenderer& renderer, std::span<const Light> lights, const FrameSettings& settings,
                     const Context& context) {
  if (auto* of_lens = std::get_if<Renderer>(&renderer)) return of_lens->render(lights, settings, context);
  return contrejour::render(std::get<MeasuredFlare>(renderer), lights, settings.frame, context);
}

}  // namespace contrejour::cli
