// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/area_render.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/tasks.h"
#include "render/area_lights/blurred_images.h"
#include "render/area_lights/convolve.h"
#include "render/area_lights/ghost_survey.h"
#include "render/area_lights/image_pyramid.h"
#include "render/area_lights/kernel.h"
#include "render/planning/error_bound.h"
#include "render/planning/statistics.h"

namespace contrejour::inline internal {
namespace {

using namespace area;

constexpr double kNegligibleError = 0.1;  // of the frame's error: what blurring may leave out at any pixel

// The part of the plan that one drawing needs.
FramePlan part_of(const FramePlan& plan, const BlurredImage& image) {
  FramePlan part;
  std::map<std::size_t, std::size_t> indices;
  for (const GhostOfLight& pair : image.pairs) indices.try_emplace(pair.ghost, 0);
  for (auto& [ghost, position] : indices) {
    position = part.ghosts.size();
    part.ghosts.push_back(plan.ghosts[ghost]);
    part.adjustments.push_back(plan.adjustments[ghost]);
  }
  for (const GhostOfLight& pair : image.pairs) part.pairs.push_back({indices.at(pair.ghost), pair.light});
  std::ranges::sort(part.pairs, {}, [](const GhostOfLight& pair) { return std::pair(pair.ghost, pair.light); });
  part.lights = image.lights;
  part.adapts_passes = plan.adapts_passes;
  part.tables = plan.tables;
  part.reflectances = plan.reflectances;
  part.dirt = plan.dirt;
  return part;
}

// Renders the drawings in order, blurs each, and adds them up.
class AreaPainter {
 public:
  AreaPainter(const DrawPlan& draw, const PlannedFrame& frame, const Context& context)
      : draw_(draw), frame_(frame), context_(context), pyramid_(frame.settings.frame) {
    context_.progress = {};
  }

  Result<void> paint(const BlurredImage& image, double peak) {
    const LightPiece* const piece = image.piece.get();
    FrameSettings drawn = frame_.settings;
    FramePlan part = part_of(frame_.plan, image);
    PyramidFrame at;
    part.dark_margin_px = 0;
    part.min_peak = peak * std::exp2(2 * image.level);
    if (piece != nullptr) {
      const KernelExtent extent = extent_of(*piece, image.px_from_tangents);
      at = pyramid_.frame_for(image.level, extent);
      drawn.frame = at.frame;
      part.dark_margin_px = std::max(extent.left + extent.right, extent.up + extent.down);
    }
    auto picture = draw_({frame_.lens, part, drawn, frame_.cache}, context_);
    if (!picture) return tl::unexpected(picture.error());
    add(statistics_, picture->statistics);
    const auto start = Clock::now();
    pyramid_.upsample_to(image.level, context_);
    const PicturePart lit{picture->image, picture->left, picture->top};
    const bool is_whole = lit.image.width == drawn.frame.width && lit.image.height == drawn.frame.height;
    if (piece != nullptr)
      pyramid_.add(lit, at, make_kernel(*piece, image.px_from_tangents, at.moved),
                   kNegligibleError * frame_.settings.area_error * peak, context_);
    else
      is_whole ? pyramid_.add_sharp(std::move(picture->image), context_) : pyramid_.add_sharp(lit, context_);
    ms_ += ms_since(start);
    return {};
  }

  Flare finish(double before_ms) && {
    const auto start = Clock::now();
    Flare flare{std::move(pyramid_).flattened(context_), std::move(statistics_)};
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
  ImagePyramid pyramid_;
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
  std::vector<DividedLight> wholes = whole_lights(lights);
  const std::vector<Light> points = points_of(wholes);
  auto plan = plan_frame({lens, points, settings, cache}, context);
  if (!plan) return tl::unexpected<Error>(plan.error());
  for (std::size_t k = 0; k < wholes.size(); ++k) wholes[k].planned = {plan->lights[k]};
  const double plan_ms = ms_since(start);

  start = Clock::now();
  Context quiet = context;
  quiet.progress = {};
  const auto survey = GhostSurvey(lens, *plan, lights, settings, quiet).of(std::move(wholes));
  if (!survey) return tl::unexpected(survey.error());
  const std::vector<BlurredImage> images = blurred_images(*survey, settings);
  if (context.cancelled()) return interrupted();
  const double survey_ms = ms_since(start);

  AreaPainter painter(draw, {lens, *plan, settings, cache}, context);
  for (std::size_t k = 0; k < images.size(); ++k) {
    if (const auto painted = painter.paint(images[k], survey->peak); !painted) return tl::unexpected(painted.error());
    if (context.cancelled()) return interrupted();
    if (context.progress) context.progress(static_cast<double>(k + 1) / static_cast<double>(images.size()));
  }
  Flare flare = std::move(painter).finish(survey_ms);
  count_first(flare.statistics, "plan", plan_ms);
  return flare;
}

}  // namespace contrejour::inline internal
