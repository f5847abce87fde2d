// What every renderer works out before its first ray: which ghosts, at which wavelengths, and by what factor
// flux becomes pixel values. So selection, colour and radiometry are the same in all of them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/frame_settings.h"
#include "contrejour/render.h"
#include "ghosts/pupils/ghost_pupil.h"
#include "optics/trace/by_wavelength.h"
#include "render/interface/dirt_field.h"
#include "render/interface/ghost_look.h"
#include "render/interface/planned_light.h"
#include "render/interface/reflected_share.h"
#include "render/interface/render_cache.h"

namespace contrejour {

struct GhostOfLight {
  std::size_t ghost = 0, light = 0;  // in the plan
};

struct FramePlan {
  std::vector<Ghost> ghosts;
  std::vector<GhostLook> looks;  // one a ghost
  std::vector<PlannedLight> lights;
  bool by_need = false;  // the lights' passes are as fine as any ghost may ask for; few ghosts need all
  // Those that each pair needs, as for_each_pair() goes through them (passes_by_need.h); empty: all of its light's.
  std::vector<std::vector<PlannedPass>> passes = {};
  TablesByWavelength tables;  // made when they are asked for
  ReflectedShares reflected;  // at every wavelength of the lights' passes
  std::shared_ptr<const DirtField> dirt = nullptr;  // null: the lens is clean
  // Where ghosts come through, by ghost and then by light, if selection had to find out; else empty.
  std::vector<pupils::GhostPupil> pupils = {};
  std::optional<double> skipped_flux;  // as RenderStatistics::ghosts_skipped_flux
  // Which ghosts of which lights are drawn, by rising ghost, then light; none: all of them.
  std::vector<GhostOfLight> pairs = {};
  // What errors may be relative to where the picture's own peak is lower: it becomes part of a brighter one. Pixel
  // values.
  double least_peak = 0.0;
  // May be left out of a picture: rows and columns beside all of its light, but for so many next to it.
  std::optional<int> dark_margin_px;
};

// Calls visit(ghost, light) for those that are drawn.
template <class Visit>
void for_each_pair(const FramePlan& plan, const Visit& visit) {
  for (const GhostOfLight& pair : plan.pairs) visit(pair.ghost, pair.light);
  if (!plan.pairs.empty()) return;
  for (std::size_t g = 0; g < plan.ghosts.size(); ++g)
    for (std::size_t k = 0; k < plan.lights.size(); ++k) visit(g, k);
}

// Calls visit(ghost, light, passes) in the same way.
template <class Visit>
void for_each_pair_with_passes(const FramePlan& plan, const Visit& visit) {
  std::size_t pair = 0;
  for_each_pair(plan, [&](std::size_t g, std::size_t k) {
    visit(g, k, std::span<const PlannedPass>(plan.passes.empty() ? plan.lights[k].passes : plan.passes[pair++]));
  });
}

// What a frame is rendered from. All must outlive the rendering; the cache may have served frames before.
struct FrameRequest {
  const LensState& lens;
  std::span<const Light> lights;
  const FrameSettings& settings;
  RenderCache& cache;
};

// Errors: InvalidArgument for settings out of range, Cancelled.
[[nodiscard]] Result<FramePlan> plan_frame(const FrameRequest& request, const Context& context);

// More lights for a plan that has their spectra. Cancelled is the one error.
[[nodiscard]] Result<std::vector<PlannedLight>> plan_more_lights(const FramePlan& plan, const LensState& lens,
                                                                 std::span<const Light> lights,
                                                                 const FrameSettings& settings, const Context& context);

// What a method draws: the part of the frame that begins there. All else is dark.
struct DrawnFlare {
  Image image;
  int left = 0, top = 0;
  RenderStatistics statistics;
};

// The same with its lights planned, for a method to draw. The picture depends on ghosts, lights and gains of the plan
// and on the settings' frame and ringing, no longer on settings.selection, scope, wavelengths and colour space.
struct PlannedFrame {
  const LensState& lens;
  const FramePlan& plan;
  const FrameSettings& settings;
  RenderCache& cache;
};

// A method with its options: draws what a plan says.
using DrawPlan = std::function<Result<DrawnFlare>(const PlannedFrame& frame, const Context& context)>;

// Plans, then draws; the statistics' phases begin with "plan". Errors: those of both.
[[nodiscard]] Result<Flare> render_planned(const DrawPlan& draw, const FrameRequest& frame, const Context& context);

}  // namespace contrejour
