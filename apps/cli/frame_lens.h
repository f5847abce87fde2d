// SPDX-License-Identifier: Apache-2.0
// The lens (or the measured flare) and the renderer of a sequence, which change only where a frame's values do.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "cli/animation_option.h"
#include "cli/source_choice.h"
#include "contrejour/expert/source_renderer.h"
#include "contrejour/lens.h"

namespace contrejour::cli {

class FrameLens {
 public:
  // Prints the warnings of the lens as configured for the first frame.
  [[nodiscard]] static Result<FrameLens> create(const std::string& lens, const FrameValues& values, int first_frame,
                                                MeasuredUse use);

  [[nodiscard]] const FlareSource& first_source() const { return *first_source_; }

  // The lens with a frame's values; the same object where the values do not change it.
  [[nodiscard]] Result<std::shared_ptr<const LensState>> at(const params::Values& values) const;

 private:
  FrameLens(std::string name, FlareSource first, bool may_change);

  std::string name_;
  std::shared_ptr<const FlareSource> first_source_;
  std::shared_ptr<const LensState> first_lens_;
  bool may_change_;
};

class FrameRenderer {
 public:
  [[nodiscard]] static Result<FrameRenderer> create(const FrameLens& lens, const params::Values& values);

  // Takes a frame's lens and method; a measured flare has neither.
  [[nodiscard]] Result<void> set(const std::shared_ptr<const LensState>& lens, const params::Values& values);
  [[nodiscard]] SourceRenderer& get() { return renderer_; }
  // The same again, for frames that another thread draws at the same time.
  [[nodiscard]] Result<FrameRenderer> another() const;

 private:
  explicit FrameRenderer(SourceRenderer renderer) : renderer_(std::move(renderer)) {}

  SourceRenderer renderer_;
  std::shared_ptr<const LensState> lens_;
};

}  // namespace contrejour::cli
