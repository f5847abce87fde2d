// SPDX-License-Identifier: Apache-2.0
// What every renderer needs before it traces a ray: the ghosts, the wavelengths, and the factors from flux to pixel
// values. It is computed here once, so that selection, colour and radiometry are the same in all renderers.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/frame_settings.h"
#include "contrejour/render.h"
#include "optics/trace/by_wavelength.h"
#include "render/planning/applied_adjustment.h"
#include "render/planning/dirt_field.h"
#include "render/planning/layer_map.h"
#include "render/planning/planned_light.h"
#include "render/planning/render_cache.h"
#include "render/pupils/kept_pupils.h"
#include "render/radiometry/ghost_reflectances.h"
#include "render/radiometry/kept_fluxes.h"

namespace contrejour::inline internal {

struct GhostOfLight {
  std::size_t ghost = 0, light = 0;  // indices in the plan
};

struct FramePlan {
  std::vector<Ghost> ghosts;
  std::vector<AppliedAdjustment> adjustments;  // one for each ghost
  std::vector<PlannedLight> lights;
  bool adapts_passes = false;  // the lights' passes are as fine as any ghost may need; few ghosts need all
  // The passes of each pair, in the order of for_each_pair() (passes_by_need.h); empty: each pair has all passes of its
  // light.
  std::vector<std::vector<PlannedPass>> passes = {};
  TablesByWavelength tables;  // made on first use
  GhostReflectances reflectances;  // at every wavelength of the lights' passes
  std::shared_ptr<const DirtField> dirt = nullptr;  // null: the lens is clean
  std::shared_ptr<KeptFluxes> kept_fluxes = nullptr;  // sections of the cache, never null once it is planned
  std::shared_ptr<pupils::KeptPupils> kept_pupils = nullptr;
  // The ghosts' pupils, by ghost and then by light, if the selection had to find them; else empty.
  std::vector<pupils::GhostPupil> pupils = {};
  std::optional<double> skipped_flux;  // as RenderStatistics::ghosts_skipped_flux
  // The pairs of ghost and light that are drawn, in order of ghost, then light; empty: all pairs.
  std::vector<GhostOfLight> pairs = {};
  // A lower limit of the peak that errors are relative to, in pixel values: the picture may become part of a brighter
  // one.
  double min_peak = 0.0;
  // The fraction of the squared error asked for that this picture may make: it may be one of several that are added up.
  double error_fraction = 1.0;
  // If set, rows and columns that are farther than this many pixels from all light may be left out of the picture.
  std::optional<int> dark_margin_px;
  std::shared_ptr<const LayerMap> layers = nullptr;  // null: one picture

  // The layer of a pair; 0 without layers.
  [[nodiscard]] std::size_t layer_of(std::size_t ghost, std::size_t light) const {
    return layers ? layers->of(ghosts[ghost], lights[light].index) : 0;
  }
};

// Calls visit(ghost, light) for each pair that is drawn.
template <class Visit>
void for_each_pair(const FramePlan& plan, const Visit& visit) {
  for (const GhostOfLight& pair : plan.pairs) visit(pair.ghost, pair.light);
  if (!plan.pairs.empty()) return;
  for (std::size_t g = 0; g < plan.ghosts.size(); ++g)
    for (std::size_t k = 0; k < plan.lights.size(); ++k) visit(g, k);
}

// Calls visit(ghost, light, passes) for each pair that is drawn.
template <class Visit>
void for_each_pair_with_passes(const FramePlan& plan, const Visit& visit) {
  std::size_t pair = 0;
  for_each_pair(plan, [&](std::size_t g, std::size_t k) {
    visit(g, k, std::span<const PlannedPass>(plan.passes.empty() ? plan.lights[k].passes : plan.passes[pair++]));
  });
}

// What a frame is rendered from. All must outlive the rendering; the cache may have served earlier frames.
struct FrameRequest {
  const LensState& lens;
  std::span<const Light> lights;
  const FrameSettings& settings;
  RenderCache& cache;
  const LayerOptions* layers = nullptr;  // null: one picture
};

// Errors: InvalidArgument for settings out of range, Cancelled.
[[nodiscard]] Result<FramePlan> plan_frame(const FrameRequest& request, const Context& context);

// Plans more lights for a plan that contains their spectra. The only error is Cancelled.
[[nodiscard]] Result<std::vector<PlannedLight>> plan_more_lights(const FramePlan& plan, const LensState& lens,
                                                                 std::span<const Light> lights,
                                                                 const FrameSettings& settings, const Context& context);

// The image of a part of the frame, and where that part begins. The rest of the frame is dark.
struct DrawnImage {
  Image image;
  int left = 0, top = 0;
};

// The result of a method's drawing.
struct DrawnFlare {
  DrawnImage picture;  // without the plan's layers
  std::vector<DrawnImage> layers;  // one for each of the plan's layers; without pixels where it is dark
  RenderStatistics statistics;
};

// A request with its plan, which a method draws. The picture depends on the plan's ghosts, lights and gains and on the
// settings' frame and ringing, but not on settings.selection, scope, wavelengths and colour space.
struct PlannedFrame {
  const LensState& lens;
  const FramePlan& plan;
  const FrameSettings& settings;
  RenderCache& cache;
};

// A method with its options: draws what a plan lists.
using DrawPlan = std::function<Result<DrawnFlare>(const PlannedFrame& frame, const Context& context)>;

// All ghosts of a frame, without the lights' own images: one image of the whole frame, or layers.
struct GhostImages {
  Image image;
  std::vector<DrawnImage> layers;
  std::shared_ptr<const LayerMap> layer_map;  // null: one image
  RenderStatistics statistics;
};

// Plans, then draws; the statistics' phases begin with "plan". Errors: those of both.
[[nodiscard]] Result<GhostImages> render_planned(const DrawPlan& draw, const FrameRequest& frame,
                                                 const Context& context);

}  // namespace contrejour::inline internal
