// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/area_render.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/tasks.h"
#include "render/area_lights/area_survey.h"
#include "render/area_lights/convolve.h"
#include "render/area_lights/drawings.h"
#include "render/area_lights/kernel.h"
#include "render/area_lights/layers.h"
#include "render/planning/error_bound.h"
#include "render/planning/statistics.h"

namespace contrejour::inline internal {
namespace {

using namespace area;

constexpr double kUnseen = 0.1;  // of the frame's error: what blurring may leave out at any pixel

// The part of the plan that one drawing needs.
FramePlan part_of(const FramePlan& plan, const Drawing& drawing) {
  FramePlan part;
  std::map<std::size_t, std::size_t> places;
  for (const GhostOfLight& pair : drawing.pairs) places.try_emplace(pair.ghost, 0);
  for (auto& [ghost, place] : places) {
    place = part.ghosts.size();
    part.ghosts.push_back(plan.ghosts[ghost]);
    part.looks.push_back(plan.looks[ghost]);
  }
  for (const GhostOfLight& pair : drawing.pairs) part.pairs.push_back({places.at(pair.ghost), pair.light});
  std::ranges::sort(part.pairs, {}, [](const GhostOfLight& pair) { return std::pair(pair.ghost, pair.light); });
  part.lights = drawing.lights;
  part.by_need = plan.by_need;
  part.tables = plan.tables;
  part.reflected = plan.reflected;
  part.dirt = plan.dirt;
  return part;
}

// Renders the drawings in order, blurs each, and adds them up.
class AreaPainter {
 public:
  AreaPainter(const DrawPlan& draw, const PlannedFrame& frame, const Context& context)
      : draw_(draw), frame_(frame), context_(context), layers_(frame.settings.frame) {
    context_.progress = {};
  }

  Result<void> paint(const Drawing& drawing, double peak) {
    const LightPiece* const piece = drawing.piece.get();
    FrameSettings drawn = frame_.settings;
    FramePlan part = part_of(frame_.plan, drawing);
    LayerFrame at;
    part.dark_margin_px = 0;
    part.least_peak = peak * std::exp2(2 * drawing.level);
    if (piece != nullptr) {
      const KernelReach reach = reach_of(*piece, drawing.px_from_tangents);
      at = layers_.frame_for(drawing.level, reach);
      drawn.frame = at.frame;
      part.dark_margin_px = std::max(reach.left + reach.right, reach.up + reach.down);
    }
    auto picture = draw_({frame_.lens, part, drawn, frame_.cache}, context_);
    if (!picture) return tl::unexpected(picture.error());
    add(statistics_, picture->statistics);
    const auto start = Clock::now();
    layers_.descend_to(drawing.level, context_);
    const PicturePart lit{picture->image, picture->left, picture->top};
    const bool is_whole = lit.image.width == drawn.frame.width && lit.image.height == drawn.frame.height;
    if (piece != nullptr)
      layers_.add(lit, at, make_kernel(*piece, drawing.px_from_tangents, at.moved),
                  kUnseen * frame_.settings.area_error * peak, context_);
    else
      is_whole ? layers_.add_sharp(std::move(picture->image), context_) : layers_.add_sharp(lit, context_);
    ms_ += ms_since(start);
    return {};
  }

  Flare finish(double before_ms) && {
    const auto start = Clock::now();
    Flare flare{std::move(layers_).flattened(context_), std::move(statistics_)};
    RenderStatistics& stats = flare.statistics;
    stats.ghosts_rendered = static_cast<int>(frame_.plan.ghosts.size());
    stats.ghosts_skipped_flux = frame_.plan.skipped_flux;
    count_last(stats, "areas", before_ms + ms_ + ms_since(start));
    return flare;
  }

 private:
  const DrawPlan& draw_;
  const PlannedFrame frame_;
  Context context_;
  Layers layers_;
  RenderStatistics statistics_;
  double ms_ = 0.0;
};

}  // namespace

Result<Flare> render_areas(const DrawPlan& draw, const FrameRequest& frame, const Context& context) {
  auto start = Clock::now();
  const auto& [lens, lights, settings, cache] = frame;
  if (const auto good = check_error_bound(settings.area_error); !good) return tl::unexpected(good.error());
  for (const Light& light : lights)
    if (const auto ok = check_extent(light); !ok) return tl::unexpected(ok.error());
  std::vector<PartedLight> wholes = whole_lights(lights);
  const std::vector<Light> points = points_of(wholes);
  auto plan = plan_frame({lens, points, settings, cache}, context);
  if (!plan) return tl::unexpected<Error>(plan.error());
  for (std::size_t k = 0; k < wholes.size(); ++k) wholes[k].planned = {plan->lights[k]};
  const double plan_ms = ms_since(start);

  start = Clock::now();
  Context quiet = context;
  quiet.progress = {};
  const auto survey = AreaSurvey(lens, *plan, lights, settings, quiet).of(std::move(wholes));
  if (!survey) return tl::unexpected(survey.error());
  const std::vector<Drawing> drawings = drawings_of(*survey, settings);
  if (context.cancelled()) return interrupted();
  const double survey_ms = ms_since(start);

  AreaPainter painter(draw, {lens, *plan, settings, cache}, context);
  for (std::size_t k = 0; k < drawings.size(); ++k) {
    if (const auto painted = painter.paint(drawings[k], survey->peak); !painted) return tl::unexpected(painted.error());
    if (context.cancelled()) return interrupted();
    if (context.progress) context.progress(static_cast<double>(k + 1) / static_cast<double>(drawings.size()));
  }
  Flare flare = std::move(painter).finish(survey_ms);
  count_first(flare.statistics, "plan", plan_ms);
  return flare;
}

}  // namespace contrejour::inline internal
