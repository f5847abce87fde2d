// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_renderers.h"

#include <cassert>

namespace contrejour::cli {

Result<FrameRenderers> FrameRenderers::create(const FrameLens& lens, const params::Values& values, int in_flight) {
  auto first = FrameRenderer::create(lens, values);
  if (!first) return tl::unexpected(first.error());
  FrameRenderers renderers;
  const int others = has_device(first->get()) ? in_flight - 1 : 0;
  for (int k = 0; k < others; ++k) {
    auto other = first->another();
    if (!other) return tl::unexpected(other.error());
    renderers.add(std::move(*other));
  }
  renderers.add(std::move(*first));
  return renderers;
}

void FrameRenderers::add(FrameRenderer renderer) {
  free_.push_back(std::make_unique<FrameRenderer>(std::move(renderer)));
  ++count_;
}

std::unique_ptr<FrameRenderer> FrameRenderers::take() {
  const std::scoped_lock lock(*mutex_);
  assert(!free_.empty());
  std::unique_ptr<FrameRenderer> renderer = std::move(free_.back());
  free_.pop_back();
  return renderer;
}

void FrameRenderers::give_back(std::unique_ptr<FrameRenderer> renderer) {
  const std::scoped_lock lock(*mutex_);
  free_.push_back(std::move(renderer));
}

}  // namespace contrejour::cli
