// SPDX-License-Identifier: Apache-2.0
// What the stop transmits of a frame's ghosts, as FrameSettings requests it, for one lens.
// Thread-safety: prepare() from one thread; of() from any thread, afterwards.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/expert/iris_field.h"
#include "contrejour/frame_settings.h"
#include "render/planning/frame_plan.h"
#include "render/planning/render_cache.h"
#include "render/stop_patterns/stop_patterns.h"
#include "render/stop_patterns/stop_transmittance.h"
#include "render/stop_patterns/stop_wave.h"

namespace contrejour::inline internal {

class StopTransmittances {
 public:
  struct Request {
    Ghost ghost;
    double lambda_nm = 550;
    double spread_nm = 0;  // PlannedPass
    LightSource light;
  };

  // dirt: the lens's, with sharp shadows (FramePlan); null if it is clean. lens and cache must outlive this object.
  StopTransmittances(const LensState& lens, const FrameSettings& settings, std::shared_ptr<const DirtField> dirt,
                     RenderCache& cache);

  [[nodiscard]] bool on() const { return options_.mode != RingingMode::None || has_half_tones(); }
  // A picture's half-tones dim all of a ghost, in or out of focus, so that every ghost needs its stop pattern.
  [[nodiscard]] bool has_half_tones() const {
    return lens_.iris.field != nullptr && lens_.iris.field->has_half_tones();
  }

  // Whether the shadows of dirt have fringes.
  [[nodiscard]] bool has_fringed_dirt() const {
    return options_.mode != RingingMode::None && dirt_field_ && !dirt_field_->has_picture();
  }

  // The Fresnel number of the stop's edge in a ghost, approximately; infinite where the edge is sharp.
  [[nodiscard]] double fresnel_number(const Ghost& ghost, double lambda_nm, const LightSource& light) const;

  // The section that holds the patterns; null without ringing, and before prepare().
  [[nodiscard]] const std::shared_ptr<stop_patterns::StopPatterns>& patterns() const { return patterns_; }

  // Makes the stop patterns of these ghosts; all wavelengths of a ghost must be in one call. Returns false if
  // cancelled.
  bool prepare(std::span<const Request> requested, const Context& context);
  // The same for all ghosts and passes of a plan.
  bool prepare(const FramePlan& plan, const Context& context);

  // Makes the fringes of dirt's shadows; the iris's stop patterns are not needed. Returns false if cancelled.
  bool prepare_dirt(std::span<const Request> requested, const Context& context);

  // About the width of the fringes of dirt's shadows in its plane, at the last crossing of the stop; 0 without ringing.
  [[nodiscard]] double dirt_fringe_unit_mm(const Request& requested) const;

  [[nodiscard]] StopTransmittance of(const Ghost& ghost, double lambda_nm, const LightSource& light) const {
    return {pattern_of(ghost, lambda_nm, light), dirt_of(ghost, lambda_nm, light)};
  }
  // Null if the iris is sharp, or if the pattern was not prepared.
  [[nodiscard]] std::shared_ptr<const StopPattern> pattern_of(const Ghost& ghost, double lambda_nm,
                                                              const LightSource& light) const;
  // Null if the lens is clean; with sharp shadows if fringes were not prepared.
  [[nodiscard]] std::shared_ptr<const DirtShadows> dirt_of(const Ghost& ghost, double lambda_nm,
                                                           const LightSource& light) const;

 private:
  struct Key {
    Ghost ghost;
    double lambda_nm, light_distance_mm;  // along the axis
    friend auto operator<=>(const Key&, const Key&) = default;
  };
  [[nodiscard]] static Key key_of(const Ghost& ghost, double lambda_nm, const LightSource& light);
  [[nodiscard]] std::vector<stop_patterns::StopWave> waves_of(std::span<const Request> requested,
                                                              const Context& context) const;
  [[nodiscard]] bool is_sharp(double footprint, double fresnel_number) const;
  [[nodiscard]] double order(double lambda_nm) const;  // of the fractional transform
  [[nodiscard]] std::vector<stop_patterns::PlaneWave> dirt_waves(const Request& requested) const;
  bool prepare_fresnel(std::span<const Request> requested, const Context& context);
  bool prepare_hullin(std::span<const Request> requested, const Context& context);
  void add_half_tones(std::span<const Request> requested);

  const LensState& lens_;
  RingingOptions options_;
  double pixel_pitch_mm_;
  std::shared_ptr<const DirtField> dirt_field_;
  std::shared_ptr<const DirtShadows> sharp_dirt_;
  RenderCache& cache_;
  std::shared_ptr<const class IrisShape> iris_;
  std::shared_ptr<stop_patterns::StopPatterns> patterns_;
  std::map<Key, std::shared_ptr<const StopPattern>> stop_;
  std::map<Key, std::shared_ptr<const DirtShadows>> dirt_;
};

}  // namespace contrejour::inline internal
