// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/item_renderer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/bundle/cell_raster.h"
#include "render/bundle/stopwatch.h"

namespace contrejour::inline internal::bundle {
namespace {

// Wavelengths that one item draws before they are added to the frame: fewer, larger additions.
constexpr std::size_t kPassesPerItem = 4;
// hullin2011 7.2 draws very anisotropic ghosts at a higher resolution: by this factor on each side.
constexpr int kFineness = 4;
// Gaps of less than two pixels between bands are not visible: a band whose light moves by less is not blurred.
constexpr double kInvisibleShift_px = 1.0;
// Bands are drawn as far beyond the frame as their light may move into it, but no farther than this.
constexpr double kWidestBorder_px = 256.0;

bool is_blurred(const BundleOptions& options, std::size_t bands) {
  return options.spectral_filter && bands > 1 && bands <= kMaxBlurredBands;
}

Frame finer(Frame frame, int factor) {
  for (int* size :
       {&frame.width, &frame.height, &frame.origin_x, &frame.origin_y, &frame.full_width, &frame.full_height}) {
    *size *= factor;
  }
  frame.pixel_pitch_mm /= factor;
  return frame;
}

// The frame with a border on all sides; its pixel (0, 0) is the original frame's (-border, -border).
Frame bordered(Frame frame, int border) {
  frame.width += 2 * border;
  frame.height += 2 * border;
  frame.origin_x -= border;
  frame.origin_y -= border;
  return frame;
}

PixelBox box_around(const std::vector<std::optional<FluxBox>>& layers) {
  PixelBox all;
  for (const auto& layer : layers) {
    if (!layer || layer->box().empty()) continue;
    const PixelBox b = layer->box();
    all = all.empty() ? b
                      : PixelBox{std::min(all.x0, b.x0), std::min(all.y0, b.y0), std::max(all.x1, b.x1),
                                 std::max(all.y1, b.y1)};
  }
  return all;
}

}  // namespace

std::vector<Item> items_of(const FramePlan& plan, const BundleOptions& options) {
  std::vector<Item> items;
  for_each_pair_with_passes(plan, [&](std::size_t g, std::size_t k, std::span<const PlannedPass> all) {
    const PlannedLight& light = plan.lights[k];
    const bool blurred = is_blurred(options, all.size());
    const std::size_t together = blurred ? all.size() : kPassesPerItem;
    for (std::size_t first = 0; first < all.size(); first += together) {
      items.push_back({plan.ghosts[g], &plan.adjustments[g], &light,
                       all.subspan(first, std::min(together, all.size() - first)), blurred, plan.layer_of(g, k)});
    }
  });
  return items;
}

ItemRenderer::ItemRenderer(const Item& item, const Frame& frame, const GridSource& source, const Context& context)
    : item_(item), options_(source.options), frame_(item.adjustment->placed(frame)), context_(context),
      grid_(source, frame.pixel_pitch_mm) {}

RenderedItem ItemRenderer::render() {
  RenderedItem out = merge(item_.are_blurred ? draw_and_blur() : draw_all());
  out.counts = grid_.counts();
  return out;
}

std::vector<ItemRenderer::Layer> ItemRenderer::draw_all() {
  std::vector<Layer> layers(item_.passes.size());
  for (std::size_t k = 0; k < layers.size() && !context_.cancelled(); ++k) {
    const auto pupil = grid_.find(item_.ghost, item_.light->source, item_.passes[k].lambda_nm, false);
    if (pupil) layers[k] = draw(*pupil, frame_);
  }
  return layers;
}

std::vector<ItemRenderer::Layer> ItemRenderer::draw_and_blur() {
  std::vector<std::size_t> order(item_.passes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return item_.passes[a].lambda_nm < item_.passes[b].lambda_nm; });
  std::vector<std::optional<GhostPupil>> pupils;
  std::vector<std::optional<MapFigures>> figures;
  for (const std::size_t k : order) {
    if (context_.cancelled()) return std::vector<Layer>(order.size());
    pupils.push_back(grid_.find(item_.ghost, item_.light->source, item_.passes[k].lambda_nm, true));
    figures.push_back(pupils.back() ? pupils.back()->figures : std::nullopt);
  }
  const auto motions = band_motions(figures, frame_);
  std::vector<Layer> layers(order.size());
  for (std::size_t k = 0; k < order.size() && !context_.cancelled(); ++k) {
    if (pupils[k]) layers[order[k]] = draw_blurred(*pupils[k], motions[k]);
  }
  return layers;
}

ItemRenderer::Layer ItemRenderer::draw_blurred(const GhostPupil& pupil, const std::optional<BandMotion>& motion) {
  const double shift_px = motion ? longest_shift_px(*motion, frame_) : 0.0;
  if (shift_px < kInvisibleShift_px) return draw(pupil, frame_);
  const int border = static_cast<int>(std::ceil(std::min(shift_px, kWidestBorder_px)));
  const FluxBox band = draw(pupil, bordered(frame_, border));
  const Stopwatch watch(grid_.counts().raster_ms);
  return blurred(band, *motion, frame_, {border, context_});
}

FluxBox ItemRenderer::draw(const GhostPupil& pupil, const Frame& frame) {
  grid_.trace(pupil);
  const Stopwatch watch(grid_.counts().raster_ms);
  const bool special = options_.anisotropic != BundleOptions::Anisotropic::Exact && is_very_anisotropic(*pupil.figures);
  const bool points = special && options_.anisotropic == BundleOptions::Anisotropic::Points;
  const bool fine = special && !points;
  const Frame drawn = fine ? finer(frame, kFineness) : frame;
  const IrisShape iris(pupil.iris);
  const double flux_of_light = item_.light->source.shared_flux() * pupil.stop.level();
  CellRaster raster(grid_.rays(), iris, drawn, flux_of_light, {options_.smooth_shading, points},
                    {.transmittance = pupil.stop,
                     .light = pupil.meridian.light,
                     .entrance_z_mm = pupil.plane_z_mm,
                     .rotation_rad = pupil.meridian.rotation_rad});
  FluxBox flux = raster.draw([&] { return context_.cancelled(); });
  grid_.counts().primitives += raster.primitives();
  return fine ? flux.coarser(kFineness) : std::move(flux);
}

RenderedItem ItemRenderer::merge(const std::vector<Layer>& layers) {
  const Stopwatch watch(grid_.counts().raster_ms);
  RenderedItem out;
  out.box = box_around(layers);
  const auto width = static_cast<std::size_t>(out.box.width());
  out.rgb.resize(3 * width * static_cast<std::size_t>(out.box.height()));
  for (std::size_t k = 0; k < layers.size(); ++k) {
    if (!layers[k] || layers[k]->box().empty()) continue;
    const PixelBox b = layers[k]->box();
    const Rgb gain = item_.adjustment->tinted(item_.passes[k].gain);
    const std::array<float, 3> g{static_cast<float>(gain[0]), static_cast<float>(gain[1]), static_cast<float>(gain[2])};
    for (int y = b.y0; y < b.y1; ++y) {
      float* to = out.rgb.data() +
                  3 * (static_cast<std::size_t>(y - out.box.y0) * width + static_cast<std::size_t>(b.x0 - out.box.x0));
      for (const float flux : layers[k]->row(y)) {
        for (std::size_t c = 0; c < 3; ++c) *to++ += g[c] * flux;
      }
    }
  }
  return out;
}

}  // namespace contrejour::inline internal::bundle
