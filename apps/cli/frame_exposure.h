// SPDX-License-Identifier: Apache-2.0
// A frame whose lens or settings change while its shutter is open: what they are at each time (exposure.h).
#pragma once

#include <functional>
#include <memory>
#include <vector>

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

  using DrawMoment = std::function<Result<LayeredFlare>(const FrameMoment& moment, const Context& context)>;
  using LightsOfMoment = std::function<Result<std::vector<Light>>(const FrameMoment& moment)>;
  struct Scene {
    LightsOfMoment lights;  // as draw() gives them to the renderer
    DrawMoment draw;
  };
  // The flare as it is drawn at each time by the renderer, which then has the lens, the method and the motion of that
  // time. error: as FrameSettings::area_error.
  [[nodiscard]] Result<ExposedFlare> expose(const Scene& scene, SourceRenderer& renderer, double error,
                                            const Context& context) const;

  [[nodiscard]] const FlareSource& source() const { return lens_.first_source(); }

 private:
  FrameExposure(const FrameValues& values, const FrameLens& lens, int frame)
      : values_(values), lens_(lens), frame_(frame) {}

  [[nodiscard]] Result<FrameMoment> at(const ExposureTimes& times) const;
  [[nodiscard]] Result<bool> can_blur(const Scene& scene) const;
  [[nodiscard]] Result<void> set_motion(Renderer& renderer, const Scene& scene, const FrameMoment& moment,
                                        const ExposureTimes& times) const;

  const FrameValues& values_;
  const FrameLens& lens_;
  int frame_;
};

}  // namespace contrejour::cli
