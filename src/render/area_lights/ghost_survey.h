// SPDX-License-Identifier: Apache-2.0
// Surveys how the ghosts of lights with a size move and how large they are, and chooses, for each ghost, into how many
// pieces its light is divided.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "contrejour/frame_settings.h"
#include "optics/trace/by_wavelength.h"
#include "render/area_lights/piece_choice.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal::area {

// A light divided into `across` pieces along its longer side.
struct DividedLight {
  std::size_t light = 0;
  int across = 1;
  std::vector<LightPiece> pieces;     // a point light has one, without samples
  std::vector<PlannedLight> planned;  // one a piece
};

[[nodiscard]] std::vector<DividedLight> whole_lights(std::span<const Light> lights);
[[nodiscard]] std::vector<Light> points_of(std::span<const DividedLight> lights);  // directions of all pieces, in order

// One division of a light, with the ghosts that are drawn with it.
struct SurveyedLight {
  DividedLight parts;
  std::vector<std::size_t> ghosts;  // of the plan
  std::vector<double> light_fractions;  // one for each of `ghosts`: the fraction of its light in this division
  std::vector<GhostBlur> wholes;  // one for each of `ghosts`: with the light undivided
  std::vector<std::vector<GhostBlur>> blurs;  // by piece, then as in `ghosts`
};

struct SurveyedFrame {
  std::vector<SurveyedLight> lights;
  double peak = 0.0;  // about the level, a pixel's value, of the brightest parts of the picture
};

class GhostSurvey {
 public:
  // All arguments must outlive this object.
  GhostSurvey(const LensState& lens, const FramePlan& plan, std::span<const Light> lights,
              const FrameSettings& settings, const Context& context);

  // wholes: whole_lights() with their plans. Errors: Cancelled.
  [[nodiscard]] Result<SurveyedFrame> of(std::vector<DividedLight> wholes) const;

 private:
  using Cut = std::pair<std::size_t, int>;  // a light, and its pieces across
  struct PieceGhostIndex {  // a ghost of a piece
    std::size_t light = 0, piece = 0, ghost = 0;
  };
  [[nodiscard]] std::vector<GhostMotion> motions(std::span<const DividedLight> lights,
                                                 std::span<const PieceGhostIndex> indices) const;
  [[nodiscard]] GhostBlur blur(const DividedLight& light, const PieceGhostIndex& index,
                               const GhostMotion& motion) const;
  [[nodiscard]] double value_of(const PlannedLight& light, std::size_t ghost) const;
  [[nodiscard]] Result<std::vector<DividedLight>> cut(const std::set<Cut>& wanted) const;
  [[nodiscard]] std::vector<GhostOfArea> uncut(const std::vector<DividedLight>& wholes) const;
  [[nodiscard]] Result<void> examine_parts(std::span<GhostOfArea> ghosts, const std::vector<DividedLight>& wholes,
                                           const AreaBudget& budget) const;
  [[nodiscard]] Result<std::vector<SurveyedLight>> cut_as_chosen(std::span<const GhostOfArea> ghosts,
                                                                 std::vector<DividedLight> wholes) const;

  const LensState& lens_;
  const FramePlan& plan_;
  std::span<const Light> lights_;
  const FrameSettings& settings_;
  const Context& context_;
  StepsByWavelength steps_;
};

}  // namespace contrejour::inline internal::area
