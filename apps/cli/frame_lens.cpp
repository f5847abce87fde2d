// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_lens.h"

#include <variant>

#include "cli/lens_choice.h"
#include "contrejour/expert/renderer_settings.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {

FrameLens::FrameLens(std::string name, FlareSource first, bool may_change)
    : name_(std::move(name)), first_source_(std::make_shared<const FlareSource>(std::move(first))),
      first_lens_(std::make_shared<const LensState>(geometry_of(*first_source_))), may_change_(may_change) {}

Result<FrameLens> FrameLens::create(const std::string& lens, const FrameValues& values, int first_frame,
                                    MeasuredUse use) {
  auto first = open_source(lens, values.at(first_frame), use);
  if (!first) return tl::unexpected(first.error());
  const bool may_change = values.may_change_lens() && std::holds_alternative<LensState>(*first);
  return FrameLens(lens, std::move(*first), may_change);
}

Result<std::shared_ptr<const LensState>> FrameLens::at(const params::Values& values) const {
  if (!may_change_) return first_lens_;
  auto prescription = prescription_of(name_);
  if (!prescription) return tl::unexpected(prescription.error());
  auto lens = params::lens_of(std::move(*prescription), values);
  if (!lens) return tl::unexpected(lens.error());
  return std::make_shared<const LensState>(std::move(*lens));
}

Result<FrameRenderer> FrameRenderer::create(const FrameLens& lens, const params::Values& values) {
  auto renderer = open_renderer(values, lens.first_source());
  if (!renderer) return tl::unexpected(renderer.error());
  return FrameRenderer(std::move(*renderer));
}

Result<FrameRenderer> FrameRenderer::another() const {
  auto renderer = contrejour::another(renderer_);
  if (!renderer) return tl::unexpected(renderer.error());
  return FrameRenderer(std::move(*renderer));
}

Result<void> FrameRenderer::set(const std::shared_ptr<const LensState>& lens, const params::Values& values) {
  auto* const renderer = std::get_if<Renderer>(&renderer_);
  if (renderer == nullptr) return {};
  if (auto set = configure_renderer(*renderer, values); !set) return set;
  if (lens == lens_) return {};
  lens_ = lens;
  return renderer->set_lens(*lens);
}

}  // namespace contrejour::cli
