#include "render/area/area_render.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/tasks.h"
#include "optics/trace/lens_steps.h"
#include "render/area/blur_classes.h"
#include "render/area/convolve.h"
#include "render/area/kernel.h"
#include "render/area/layers.h"
#include "render/interface/light_frame.h"
#include "render/interface/statistics.h"

namespace contrejour {
namespace {

using namespace area;

constexpr std::size_t kMostPieces = 24;  // of all lights, or as many as there are lights
constexpr double kLargestError = 0.1;  // of `adaptive`
constexpr double kUnseen = 0.1;        // of the frame's error, that blurs may leave out at any place

// Of many large lights in fewer pieces each, so that all together stay affordable.
std::vector<LightPiece> all_pieces(std::span<const Light> lights) {
  for (int most_across = kMostPiecesAcross;; --most_across) {
    std::vector<LightPiece> pieces;
    for (const Light& light : lights) {
      for (LightPiece& piece : pieces_of(light, most_across)) pieces.push_back(std::move(piece));
    }
    if (most_across == 1 || pieces.size() <= std::max(kMostPieces, lights.size())) return pieces;
  }
}

std::vector<Light> points_of(const std::vector<LightPiece>& pieces) {
  std::vector<Light> points;
  for (const LightPiece& piece : pieces) points.push_back(piece.point);
  return points;
}

// The plan for some of its ghosts and some lights.
FramePlan part_of(const FramePlan& plan, std::vector<Ghost> ghosts, std::vector<PlannedLight> lights) {
  FramePlan part;
  for (const Ghost& ghost : ghosts) {
    const auto at = std::find(plan.ghosts.begin(), plan.ghosts.end(), ghost) - plan.ghosts.begin();
    part.looks.push_back(plan.looks[static_cast<std::size_t>(at)]);
  }
  part.ghosts = std::move(ghosts);
  part.lights = std::move(lights);
  part.tables = plan.tables;
  part.dirt = plan.dirt;
  part.skipped_flux = plan.skipped_flux;
  return part;
}

double middle_wavelength(const PlannedLight& light) { return light.passes[light.passes.size() / 2].lambda_nm; }

// A pixel's value for an irradiance over the light's.
double value_of_irradiance(const PlannedLight& light, const Frame& frame) {
  Rgb gain{};
  for (const PlannedPass& pass : light.passes)
    for (std::size_t c = 0; c < 3; ++c) gain[c] += pass.gain[c];
  return *std::ranges::max_element(gain) * frame.pixel_pitch_mm * frame.pixel_pitch_mm;
}

// A picture of some ghosts of some lights, and the kernel that it is blurred by.
struct Drawing {
  std::vector<Ghost> ghosts;
  std::vector<PlannedLight> lights;
  const LightPiece* piece = nullptr;  // null: it is sharp
  int level = 0;
  LinearMap px_from_tangents;
  double room = 1.0;  // blur_classes.h
  double peak = 0.0;  // of the picture's pixels, about
};

// All drawings. The ghosts of points, and those too little blurred to show it, are left as they are.
std::vector<Drawing> drawings_of(const FramePlan& plan, const std::vector<LightPiece>& pieces, const LensState& lens,
                                 const RenderSettings& settings, const Context& context) {
  const Frame& frame = settings.frame;
  const double squares =
      settings.error * settings.error * frame.width * frame.height / static_cast<double>(pieces.size());
  std::vector<std::vector<GhostMotion>> motions(pieces.size());
  for (std::vector<GhostMotion>& one : motions) one.resize(plan.ghosts.size());
  std::vector<LightWindows> windows;
  for (const PlannedLight& light : plan.lights) windows.emplace_back(lens, light.source);
  std::map<double, LensSteps> steps;
  for (const PlannedLight& light : plan.lights)
    if (!light.passes.empty())
      steps.try_emplace(middle_wavelength(light), lens, *plan.tables.at(middle_wavelength(light)));
  parallel_for(pieces.size() * plan.ghosts.size(), context, [&](std::size_t k) {
    const std::size_t p = k / plan.ghosts.size(), g = k % plan.ghosts.size();
    if (pieces[p].samples.empty() || plan.lights[p].passes.empty()) return;
    motions[p][g] =
        ghost_motion(steps.at(middle_wavelength(plan.lights[p])), plan.ghosts[g], plan.lights[p].source, windows[p]);
  });
  std::vector<Drawing> drawings;
  Drawing points{plan.ghosts, {}, nullptr, 0, kNowhere, 1.0, 0.0};
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (pieces[p].samples.empty()) {
      points.lights.push_back(plan.lights[p]);
      continue;
    }
    for (BlurClass& made : blur_classes(plan.ghosts, motions[p], pieces[p], frame, squares))
      drawings.push_back({std::move(made.ghosts),
                          {plan.lights[p]},
                          made.is_sharp ? nullptr : &pieces[p],
                          made.level,
                          made.px_from_tangents,
                          made.room,
                          made.peak * value_of_irradiance(plan.lights[p], frame)});
  }
  if (!points.lights.empty() || drawings.empty()) drawings.push_back(std::move(points));
  // In the order that layers want them.
  const auto rank = [](const Drawing& d) { return d.piece == nullptr ? 1 : 2 * d.level; };
  std::stable_sort(drawings.begin(), drawings.end(),
                   [&](const Drawing& a, const Drawing& b) { return rank(a) > rank(b); });
  return drawings;
}

// Drawings one after the other, each blurred and added up.
class AreaPainter {
 public:
  AreaPainter(PlannedRenderer method, const LensState& lens, const FramePlan& plan, const RenderSettings& settings,
              const Context& context)
      : method_(method), lens_(lens), plan_(plan), settings_(settings), context_(context), layers_(settings.frame) {
    context_.progress = {};
  }

  Result<void> paint(const Drawing& drawing) {
    const LightPiece* const piece = drawing.piece;
    RenderSettings drawn = settings_;
    drawn.error = std::max(settings_.error, std::min(settings_.error * drawing.room, kLargestError));
    FramePlan part = part_of(plan_, drawing.ghosts, drawing.lights);
    LayerFrame at;
    part.dark_margin_px = 0;
    if (piece != nullptr) {
      const KernelReach reach = reach_of(*piece, drawing.px_from_tangents);
      at = layers_.frame_for(drawing.level, reach);
      drawn.frame = at.frame;
      part.dark_margin_px = std::max(reach.left + reach.right, reach.up + reach.down);
    }
    auto picture = method_(lens_, part, drawn, context_);
    if (!picture) return tl::unexpected(picture.error());
    add(statistics_, picture->statistics);
    const auto start = Clock::now();
    layers_.descend_to(drawing.level, context_);
    const PicturePart lit{picture->image, picture->left, picture->top};
    const bool is_whole = lit.image.width == drawn.frame.width && lit.image.height == drawn.frame.height;
    if (piece != nullptr)
      layers_.add(lit, at, make_kernel(*piece, drawing.px_from_tangents, at.moved),
                  kUnseen * settings_.error * drawing.peak, context_);
    else
      is_whole ? layers_.add_sharp(std::move(picture->image), context_) : layers_.add_sharp(lit, context_);
    ms_ += ms_since(start);
    return {};
  }

  Flare finish(double before_ms) && {
    const auto start = Clock::now();
    Flare flare{std::move(layers_).flattened(context_), std::move(statistics_)};
    RenderStatistics& stats = flare.statistics;
    stats.ghosts_rendered = static_cast<int>(plan_.ghosts.size());
    stats.ghosts_skipped_flux = plan_.skipped_flux;
    count_last(stats, "areas", before_ms + ms_ + ms_since(start));
    return flare;
  }

 private:
  PlannedRenderer method_;
  const LensState& lens_;
  const FramePlan& plan_;
  const RenderSettings& settings_;
  Context context_;
  Layers layers_;
  RenderStatistics statistics_;
  double ms_ = 0.0;
};

}  // namespace

Result<Flare> render_areas(PlannedRenderer method, const LensState& lens, std::span<const Light> lights,
                           const RenderSettings& settings, const Context& context) {
  auto start = Clock::now();
  for (const Light& light : lights)
    if (const auto ok = check_extent(light); !ok) return tl::unexpected(ok.error());
  const std::vector<LightPiece> pieces = all_pieces(lights);
  const auto plan = plan_frame(lens, points_of(pieces), settings, context);
  if (!plan) return tl::unexpected<Error>(plan.error());
  const double plan_ms = ms_since(start);

  start = Clock::now();
  Context quiet = context;
  quiet.progress = {};
  const std::vector<Drawing> drawings = drawings_of(*plan, pieces, lens, settings, quiet);
  if (context.cancelled()) return interrupted();
  const double drawings_ms = ms_since(start);

  AreaPainter painter(method, lens, *plan, settings, context);
  for (std::size_t k = 0; k < drawings.size(); ++k) {
    if (const auto painted = painter.paint(drawings[k]); !painted) return tl::unexpected(painted.error());
    if (context.cancelled()) return interrupted();
    if (context.progress) context.progress(static_cast<double>(k + 1) / static_cast<double>(drawings.size()));
  }
  Flare flare = std::move(painter).finish(drawings_ms);
  count_first(flare.statistics, "plan", plan_ms);
  return flare;
}

}  // namespace contrejour
