// SPDX-License-Identifier: Apache-2.0
#include "render/polynomial/splat_ghosts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/split_mix.h"
#include "base/tasks.h"
#include "contrejour/expert/iris_field.h"
#include "contrejour/expert/polynomial_method.h"
#include "render/planning/adaptive_passes.h"
#include "render/planning/layer_images.h"
#include "render/polynomial/splat_band.h"

namespace contrejour::inline internal {
namespace {

using adaptive::Item;
using adaptive::Scene;
using splatting::Band;
using splatting::BandSplatter;
using splatting::SplattedBand;

constexpr int kPointsOfBand = 1 << 20;  // about the most that are drawn by one thread into one box of pixels

// items: in the order of the plan's pairs.
std::vector<Band> bands_of(const FramePlan& plan, const std::vector<Item>& items, int points) {
  std::vector<Band> bands;
  std::size_t pair = 0;
  std::uint64_t number = 0;
  const int rows = std::max(1, kPointsOfBand / points);
  for_each_pair_with_passes(plan, [&](std::size_t, std::size_t, std::span<const PlannedPass> passes) {
    const Item& item = items[pair++];
    for (const PlannedPass& pass : passes) {
      const std::uint64_t key = split_mix(++number * kSplitMixIncrement);
      if (item.boxes.empty()) continue;
      for (int row = 0; row < points; row += rows)
        bands.push_back({&item, &pass, key, row, std::min(row + rows, points)});
    }
  });
  return bands;
}

// Returns the light that was added: the sum over channels.
double add_to(Image& image, const SplattedBand& band, const Rgb& gain) {
  const std::array<float, 3> g{static_cast<float>(gain[0]), static_cast<float>(gain[1]), static_cast<float>(gain[2])};
  double sum = 0.0;
  const double* from = band.flux.data();
  for (int y = 0; y < band.height; ++y) {
    float* to = image.pixels.data() + image.index(band.left, band.top + y);
    for (int x = 0; x < band.width; ++x, ++from) {
      sum += *from;
      const auto flux = static_cast<float>(*from);
      for (std::size_t c = 0; c < 3; ++c) *to++ += g[c] * flux;
    }
  }
  return sum * (gain[0] + gain[1] + gain[2]);
}

}  // namespace

Result<void> check_splatting(const PlannedFrame& planned, int points) {
  constexpr int kMost = PolynomialRenderOptions::kMostPoints;
  if (points < 0 || points > kMost)
    return invalid_argument(fmt::format("the number of points a side is out of range; choose one up to {}", kMost));
  const auto refused = [](const char* what) {
    return failure(ErrorCode::Unsupported, fmt::format("random points cannot draw {}; leave `points` at 0", what));
  };
  if (planned.settings.ringing.mode != RingingMode::None) return refused("ringing");
  if (planned.plan.dirt) return refused("dirt");
  const auto& field = planned.lens.iris.field;
  if (field && field->has_half_tones()) return refused("an iris with half-tones");
  return {};
}

Result<DrawnFlare> splat_ghosts(const PlannedFrame& planned, int points, const pupils::FittedGhosts& fitted,
                                const Context& context) {
  const auto start = Clock::now();
  const Frame& frame = planned.settings.frame;
  Context quiet = context;
  quiet.progress = {};
  const auto plan = with_adaptive_passes(planned.plan, planned.lens, frame, quiet);
  if (!plan) return interrupted();
  const Scene scene{planned.lens, *plan,   StepsByWavelength(planned.lens, plan->tables), IrisShape(planned.lens.iris),
                    &fitted,      &context};
  adaptive::Work work;
  const std::vector<Item> items = find_items(scene, quiet, work);
  if (context.cancelled()) return interrupted();
  const double bound_ms = ms_since(start);

  DrawnFlare flare;
  RenderStatistics& stats = flare.statistics;
  stats.rays = work.rays;
  stats.surface_hits = work.surface_hits;
  LayerImages images(*plan, frame);
  const BandSplatter splatter(scene, frame, points);
  const std::vector<Band> bands = bands_of(*plan, items, points);
  double light = 0.0, traced = 0.0;
  const bool done = ordered_pipeline(
      bands.size(), context, [&](std::size_t k) { return splatter.draw(bands[k], context); },
      [&](std::size_t k, const SplattedBand& drawn) {
        const Item& item = *bands[k].item;
        const double added = add_to(images.at(item.layer), drawn, item.adjustment->tinted(bands[k].pass->gain));
        light += added;
        if (!item.is_fitted) traced += added;
        stats.rays += drawn.rays;
        stats.surface_hits += drawn.surface_hits;
        stats.primitives += drawn.lit;
      });
  if (!done || context.cancelled()) return interrupted();

  images.move_to(flare);
  stats.traced_flux = light > 0.0 ? traced / light : 0.0;
  stats.ghosts_rendered = static_cast<int>(plan->ghosts.size());
  stats.ghosts_skipped_flux = plan->skipped_flux;
  const double total_ms = ms_since(start);
  stats.time_ms = {{"bound", bound_ms}, {"points", total_ms - bound_ms}, {"total", total_ms}};
  return flare;
}

}  // namespace contrejour::inline internal
