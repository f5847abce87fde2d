// SPDX-License-Identifier: Apache-2.0
// A frame whose lens or settings change while its shutter is open: what they are at each time (exposure.h).
#pragma once

#include <functional>
#include <memory>

#include "cli/animation_option.h"
#include "cli/frame_lens.h"
#include "contrejour/expert/exposure.h"

namespace contrejour::cli {

struct FrameMoment {
  std::shared_ptr<const LensState> lens;
  params::Values values;
};

class FrameExposure {
 public:
  // Null where nothing but lights changes while the shutter is open. `values` and `lens` outlive it.
  [[nodiscard]] static std::shared_ptr<const FrameExposure> create(const FrameValues& values, const FrameLens& lens,
                                                                   int frame);

  // The flare as `draw` draws it at each time by the renderer, which then has the lens and the method of that time.
  // error: as FrameSettings::area_error.
  using DrawMoment = std::function<Result<LayeredFlare>(const FrameMoment& moment, const Context& context)>;
  [[nodiscard]] Result<ExposedFlare> expose(const DrawMoment& draw, SourceRenderer& renderer, double error,
                                            const Context& context) const;

  [[nodiscard]] const FlareSource& source() const { return lens_.first_source(); }

 private:
  FrameExposure(const FrameValues& values, const FrameLens& lens, int frame)
      : values_(values), lens_(lens), frame_(frame) {}

  [[nodiscard]] Result<FrameMoment> at(const ExposureTimes& times) const;

  const FrameValues& values_;
  const FrameLens& lens_;
  int frame_;
};

}  // namespace contrejour::cli
