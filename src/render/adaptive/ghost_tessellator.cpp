// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/ghost_tessellator.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/adaptive/budget/band_budget.h"
#include "render/adaptive/budget/fit_budget.h"
#include "render/adaptive/budget/wavelength_bands.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kLightLeft = 0.05;  // of a channel's absolute sum: for smaller sums a band's parts count equally
constexpr std::size_t kMaxSamples = 13;  // wavelengths that are tried, at most
constexpr int kWorthCurving = 2;     // quarterings that a curved box must be able to save

// The first rays of a band: the geometry of its middle wavelength with the light of all its passes.
LobattoRays band_rays(const FirstRays& rays, const Band& band, std::span<const PlannedPass> passes) {
  LobattoRays ray_set = rays.ray_sets[band.middle()];
  add_light(ray_set, rays.transmission[band.middle()], passes[band.middle()].gain);
  for (std::size_t k = band.first; k < band.last; ++k)
    if (k != band.middle()) add_light(ray_set, rays.transmission[k], passes[k].gain);
  return ray_set;
}

std::vector<double> wavelengths_of(std::span<const PlannedPass> passes) {
  std::vector<double> lambda_nm;
  for (const PlannedPass& pass : passes) lambda_nm.push_back(pass.lambda_nm);
  return lambda_nm;
}

}  // namespace

GhostTessellator::GhostTessellator(GhostTracers& tracers, const IrisShape& iris, const Frame& frame, int max_depth,
                                   BoxCells& scratch, const GhostPatterns* patterns,
                                   std::span<const std::shared_ptr<const DirtShadows>> dirt)
    : tracers_(tracers), samples_(wavelengths_of(tracers.passes()), kMaxSamples), iris_(iris), frame_(frame),
      max_depth_(max_depth), patterns_(patterns), dirt_(dirt), scratch_(scratch) {}

// A part of a band's wavelengths, one of three at most: its middle pass, and its fraction of each channel's light.
struct GhostTessellator::BandPart {
  std::size_t middle = 0;
  std::array<float, 3> channel{};
};

std::vector<GhostTessellator::BandPart> GhostTessellator::parts_of(const FirstRays& rays, const Band& band) const {
  const std::size_t passes = band.last - band.first, count = std::min<std::size_t>(passes, 3);
  std::vector<BandPart> parts(count);
  Rgb sum{}, size{};
  std::vector<Rgb> light(count);
  for (std::size_t part = 0; part < count; ++part) {
    const std::size_t from = band.first + part * passes / count, to = band.first + (part + 1) * passes / count;
    parts[part].middle = (from + to) / 2;
    for (std::size_t k = from; k < to; ++k) {
      const Rgb of_pass = light_of(rays, tracers_.passes(), k);
      for (std::size_t c = 0; c < 3; ++c) light[part][c] += of_pass[c];
    }
    for (std::size_t c = 0; c < 3; ++c) sum[c] += light[part][c], size[c] += std::abs(light[part][c]);
  }
  for (std::size_t part = 0; part < count; ++part)
    for (std::size_t c = 0; c < 3; ++c)
      parts[part].channel[c] = static_cast<float>(
          std::abs(sum[c]) > kLightLeft * size[c] ? light[part][c] / sum[c] : 1.0 / static_cast<double>(count));
  return parts;
}

std::shared_ptr<const stop_patterns::BandDirt> GhostTessellator::band_dirt(const FirstRays& rays,
                                                                           const Band& of) const {
  auto band = std::make_shared<stop_patterns::BandDirt>();
  if (dirt_.size() == 1) {
    band->parts.push_back({dirt_.front().get()});
    return band;
  }
  for (const BandPart& part : parts_of(rays, of)) {
    const DirtShadows* const shadows = dirt_[part.middle].get();
    if (band->parts.empty() || band->parts.back().shadows != shadows) {
      band->parts.push_back({shadows, part.channel});
    } else {
      for (std::size_t c = 0; c < 3; ++c) band->parts.back().channel[c] += part.channel[c];
    }
  }
  return band;
}

std::shared_ptr<const stop_patterns::BandStopPattern> GhostTessellator::band_pattern(const FirstRays& rays,
                                                                                     const Band& of) const {
  auto band = std::make_shared<stop_patterns::BandStopPattern>();
  for (const BandPart& part : parts_of(rays, of)) {
    const GhostPatterns::OfPass& pass = patterns_->by_pass[part.middle];
    band->add({pass.pattern, part.channel}, patterns_->range, pass.bounding_polygon);
  }
  band->negligible_level = patterns_->negligible_level;
  if (const auto textures = band->textures(); !textures.empty()) band->texture = patterns_->patterns->band(textures);
  return band;
}

void GhostTessellator::tessellate(const Rectangle& box, bool with_mirror_image, const ErrorBudget& budget,
                                  PolygonList& out) {
  FirstRays rays = first_rays_within(budget, tracers_, samples_, box, frame_);
  if (const auto curved = curved_about(rays, box)) {
    tracers_.curve(curved->curve);
    rays = first_rays_within(budget, tracers_, samples_, curved->box, frame_);
  }
  tessellate(rays, with_mirror_image, budget, out);
  tracers_.curve({});
}

// A curved box about the same light, if rays fail in this box, which would otherwise be quartered. Dirt prevents it,
// since it is looked up by the position in the straight box.
std::optional<CurvedBox> GhostTessellator::curved_about(const FirstRays& rays, const Rectangle& box) {
  const bool fail = std::ranges::any_of(rays.ray_sets, [](const LobattoRays& ray_set) { return ray_set.failed > 0; });
  if (!fail || max_depth_ < kWorthCurving || !dirt_.empty() || !tracers_.light().symmetric || box.low.y != -box.high.y)
    return std::nullopt;
  std::vector<ClearanceGrid> grids{tracers_.clearance(0)};
  if (tracers_.passes().size() > 1) grids.push_back(tracers_.clearance(tracers_.passes().size() - 1));
  auto curved = curved_box(grids, box);
  for (const ClearanceGrid& grid : grids) tracers_.count(grid);
  return curved;
}

void GhostTessellator::tessellate(const FirstRays& rays, bool with_mirror_image, const ErrorBudget& budget,
                                  PolygonList& out) {
  const std::vector<Band> bands = bands_for(rays, tracers_.passes(), samples_, frame_.pixel_pitch_mm, budget.pieces);
  BandPatterns patterns;
  std::vector<std::shared_ptr<const stop_patterns::BandDirt>> dirt;
  for (const Band& band : bands) {
    patterns.push_back(patterns_ != nullptr ? band_pattern(rays, band) : nullptr);
    dirt.push_back(!dirt_.empty() ? band_dirt(rays, band) : nullptr);
  }
  PatchFitter fitter(tracers_, frame_, max_depth_, patterns_ != nullptr ? patterns_->negligible_level : 0.0);
  const ErrorBudget per_band = budget_per_band(budget, bands.size());
  const auto tessellate_all = [&](const BandSet& set,
                                  std::span<const std::shared_ptr<const stop_patterns::BandStopPattern>> of_set,
                                  std::span<const std::shared_ptr<const stop_patterns::BandDirt>> dirt_of_set,
                                  const std::vector<FittedPart>& parts) {
    if (parts.empty()) return;
    Tessellator cells(iris_, frame_, per_band, kFewCells, scratch_, out);
    cells.set_curved_sides(tracers_.is_curved());
    cells.stop_with(context_);
    for (std::size_t band = 0; band < set.size(); ++band) {
      cells.set_dirt(DirtView{dirt_of_set[band], &tracers_.light(), tracers_.plane_z_mm()});
      if (of_set[band]) cells.set_stop_pattern(of_set[band], tracers_.stop_times());
      tessellate_band(set, band, parts, cells);
    }
  };
  const auto fit_and_tessellate = [&](BandSet& set, std::span<const LobattoRays> first, const BandPatterns& of_set,
                                      std::span<const std::shared_ptr<const stop_patterns::BandDirt>> dirt_of_set) {
    const FittedBox fitted = fitter.fit(set, first, rays.tolerance, of_set, with_mirror_image);
    tessellate_all(set, of_set, dirt_of_set, fitted.parts);
    tessellate_all(set, of_set, dirt_of_set, fitted.mirror_image);
  };
  if (rays.samples > 0) {
    BandSet all(tracers_, samples_, rays, bands);
    std::vector<LobattoRays> ray_sets;
    for (std::size_t k = 0; k < rays.samples; ++k) ray_sets.push_back(rays.ray_sets[samples_[k]]);
    all.add_weights(ray_sets, PacketPrecision::Double);
    return fit_and_tessellate(all, ray_sets, patterns, dirt);
  }
  for (std::size_t k = 0; k < bands.size(); ++k) {
    BandSet one(tracers_, bands[k], light_of_band(rays, bands[k], tracers_.passes(), bands.size()));
    const LobattoRays ray_set = band_rays(rays, bands[k], tracers_.passes());
    fit_and_tessellate(one, {&ray_set, 1}, {patterns[k]}, std::span(dirt).subspan(k, 1));
  }
}

// Paints one of the set's bands.
void GhostTessellator::tessellate_band(const BandSet& set, std::size_t band, std::span<const FittedPart> parts,
                                       Tessellator& cells) const {
  Patch patch;
  for (const FittedPart& part : parts) {
    if (context_ != nullptr && context_->cancelled()) break;  // emit() clears the cells, which are scratch memory
    if (!part.only_band)
      set.band_patch(part.patches, band, patch);
    else if (*part.only_band == band)
      patch = part.patches.front();
    else
      continue;
    cells.choose(patch, part.position);
  }
  cells.emit();
}

}  // namespace contrejour::inline internal::adaptive
