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
  part.kept_fluxes = plan.kept_fluxes;
  part.kept_pupils = plan.kept_pupils;
  part.layers = plan.layers;
  return part;
}

// The sum of the blurred pictures of a layer, or of the whole frame.
struct LayerSum {
  explicit LayerSum(const Frame& frame) : pyramid(frame) {}
  ImagePyramid pyramid;
  bool is_lit = false;
};

// Renders the drawings in order, blurs each, and adds them up.
class AreaPainter {
 public:
  AreaPainter(const DrawPlan& draw, const PlannedFrame& frame, const Context& context)
      : draw_(draw), frame_(frame), context_(context),
        sums_(frame.plan.layers ? frame.plan.layers->count() : 1, LayerSum(frame.settings.frame)) {
    context_.progress = {};
  }

  Result<void> paint(const BlurredImage& image, double peak) {
    const LightPiece* const piece = image.piece.get();
    FrameSettings drawn = frame_.settings;
    FramePlan part = part_of(frame_.plan, image);
    PyramidFrame at;
    part.dark_margin_px = 0;
    part.min_peak = peak * std::exp2(2 * image.level);
    part.error_fraction = image.error_fraction;
    if (piece != nullptr) {
      const KernelExtent extent = extent_of(*piece, image.px_from_tangents);
      at = pyramid_of(image).frame_for(std::max(image.level, 0), extent);
      if (image.level < 0) at.moved = at.moved + image.window.moved;
      drawn.frame = at.frame;
      part.dark_margin_px = std::max(extent.left + extent.right, extent.up + extent.down);
    }
    auto flare = draw_({frame_.lens, part, drawn, frame_.cache}, context_);
    if (!flare) return tl::unexpected(flare.error());
    add(statistics_, flare->statistics);
    const auto start = Clock::now();
    if (!part.layers) add_to(sums_.front(), image, at, std::move(flare->picture), peak);
    for (std::size_t k = 0; k < flare->layers.size(); ++k)
      if (!flare->layers[k].image.pixels.empty()) add_to(sums_[k], image, at, std::move(flare->layers[k]), peak);
    ms_ += ms_since(start);
    return {};
  }

  GhostImages finish(double before_ms) && {
    const auto start = Clock::now();
    GhostImages ghosts;
    ghosts.layer_map = frame_.plan.layers;
    if (!ghosts.layer_map) ghosts.image = std::move(sums_.front().pyramid).flattened(context_);
    if (ghosts.layer_map) ghosts.layers.resize(sums_.size());
    for (std::size_t k = 0; k < ghosts.layers.size(); ++k)
      if (sums_[k].is_lit) ghosts.layers[k].image = std::move(sums_[k].pyramid).flattened(context_);
    RenderStatistics& stats = ghosts.statistics;
    stats = std::move(statistics_);
    stats.ghosts_rendered = static_cast<int>(frame_.plan.ghosts.size());
    stats.ghosts_skipped_flux = frame_.plan.skipped_flux;
    count_last(stats, "areas", before_ms + ms_ + ms_since(start));
    return ghosts;
  }

 private:
  // The pyramid that the image is drawn in: the frame's, or that of a window in fine pixels.
  [[nodiscard]] ImagePyramid pyramid_of(const BlurredImage& image) const {
    const Frame& frame = frame_.settings.frame;
    return ImagePyramid(image.level < 0 ? fine_frame(image.window, frame) : frame);
  }

  // Blurs a picture and adds it to a sum. at: where the picture lies in the pyramid, unless it stays sharp.
  void add_to(LayerSum& sum, const BlurredImage& image, const PyramidFrame& at, DrawnImage picture, double peak) {
    sum.is_lit = true;
    sum.pyramid.upsample_to(std::max(image.level, 0), context_);
    const PicturePart lit{picture.image, picture.left, picture.top};
    const Frame& frame = frame_.settings.frame;
    const bool is_whole = lit.image.width == frame.width && lit.image.height == frame.height;
    const double negligible = kNegligibleError * frame_.settings.area_error * peak;
    if (image.level < 0) {
      ImagePyramid fine = pyramid_of(image);
      fine.add(lit, at, make_kernel(*image.piece, image.px_from_tangents, at.moved),
               negligible * std::exp2(2 * image.level), context_);
      const Image spot = gathered(image.window, std::move(fine).flattened(context_));
      sum.pyramid.add_sharp(PicturePart{spot, image.window.left, image.window.top}, context_);
    } else if (image.piece)
      sum.pyramid.add(lit, at, make_kernel(*image.piece, image.px_from_tangents, at.moved), negligible, context_);
    else
      is_whole ? sum.pyramid.add_sharp(std::move(picture.image), context_) : sum.pyramid.add_sharp(lit, context_);
  }

  const DrawPlan& draw_;
  const PlannedFrame frame_;
  Context context_;
  std::vector<LayerSum> sums_;
  RenderStatistics statistics_;
  double ms_ = 0.0;
};

}  // namespace

Result<GhostImages> render_areas(const DrawPlan& draw, const FrameRequest& frame, const Context& context) {
  auto start = Clock::now();
  const auto& [lens, lights, settings, cache, layers] = frame;
  if (const auto good = check_error_bound(settings.area_error); !good) return tl::unexpected(good.error());
  for (const Light& light : lights)
    if (const auto ok = check_extent(light); !ok) return tl::unexpected(ok.error());
  std::vector<DividedLight> wholes = whole_lights(lights);
  const std::vector<Light> points = points_of(wholes);
  auto plan = plan_frame({lens, points, settings, cache, layers}, context);
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
  GhostImages ghosts = std::move(painter).finish(survey_ms);
  count_first(ghosts.statistics, "plan", plan_ms);
  return ghosts;
}

}  // namespace contrejour::inline internal
