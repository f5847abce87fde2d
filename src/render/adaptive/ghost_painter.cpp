// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/ghost_painter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/adaptive/budget/band_budget.h"
#include "render/adaptive/budget/fit_budget.h"
#include "render/adaptive/budget/wavelength_bands.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kLightLeft = 0.05;  // of a channel's absolute sum: for smaller sums a band's parts count equally
constexpr std::size_t kMostSamples = 13;  // wavelengths that are tried, at most
constexpr int kWorthBending = 2;     // quarterings that a bent box must be able to save

// The first rays of a band: the geometry of its middle wavelength with the light of all its passes.
RaySheet band_sheet(const FirstRays& rays, const Band& band, std::span<const PlannedPass> passes) {
  RaySheet sheet = rays.sheets[band.middle()];
  add_light(sheet, rays.transmission[band.middle()], passes[band.middle()].gain);
  for (std::size_t k = band.first; k < band.last; ++k)
    if (k != band.middle()) add_light(sheet, rays.transmission[k], passes[k].gain);
  return sheet;
}

std::vector<double> wavelengths_of(std::span<const PlannedPass> passes) {
  std::vector<double> lambda_nm;
  for (const PlannedPass& pass : passes) lambda_nm.push_back(pass.lambda_nm);
  return lambda_nm;
}

}  // namespace

GhostPainter::GhostPainter(GhostTracers& tracers, const IrisShape& iris, const Frame& frame, int deepest,
                           BoxCells& room, const GhostPatterns* patterns,
                           std::span<const std::shared_ptr<const DirtShadows>> dirt)
    : tracers_(tracers), samples_(wavelengths_of(tracers.passes()), kMostSamples), iris_(iris), frame_(frame),
      deepest_(deepest), patterns_(patterns), dirt_(dirt), room_(room) {}

// A part of a band's wavelengths, one of three at most: its middle pass, and its fraction of each channel's light.
struct GhostPainter::BandPart {
  std::size_t middle = 0;
  std::array<float, 3> channel{};
};

std::vector<GhostPainter::BandPart> GhostPainter::parts_of(const FirstRays& rays, const Band& band) const {
  const std::size_t passes = band.last - band.first, count = std::min<std::size_t>(passes, 3);
  std::vector<BandPart> parts(count);
  std::array<double, 3> sum{}, size{};
  std::vector<std::array<double, 3>> light(count);
  for (std::size_t part = 0; part < count; ++part) {
    const std::size_t from = band.first + part * passes / count, to = band.first + (part + 1) * passes / count;
    parts[part].middle = (from + to) / 2;
    for (std::size_t k = from; k < to; ++k) {
      const auto of_pass = light_of(rays, tracers_.passes(), k);
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

std::shared_ptr<const stop_patterns::BandDirt> GhostPainter::band_dirt(const FirstRays& rays, const Band& of) const {
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

std::shared_ptr<const stop_patterns::BandStopPattern> GhostPainter::band_pattern(const FirstRays& rays,
                                                                                 const Band& of) const {
  auto band = std::make_shared<stop_patterns::BandStopPattern>();
  for (const BandPart& part : parts_of(rays, of)) {
    const GhostPatterns::OfPass& pass = patterns_->by_pass[part.middle];
    band->add({pass.pattern, part.channel}, patterns_->range, pass.hull);
  }
  band->unseen = patterns_->unseen;
  if (const auto textures = band->textures(); !textures.empty()) band->texture = patterns_->patterns->band(textures);
  return band;
}

void GhostPainter::paint(const Rectangle& box, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out) {
  FirstRays rays = first_rays_within(budget, tracers_, samples_, box, frame_);
  if (const auto bent = bent_about(rays, box)) {
    tracers_.bend(bent->bend);
    rays = first_rays_within(budget, tracers_, samples_, bent->box, frame_);
  }
  paint(rays, with_mirror_image, budget, out);
  tracers_.bend({});
}

// A bent box about the same light, if rays fail in this box, which would otherwise be quartered. Dirt prevents it,
// since it is looked up by the position in the straight box.
std::optional<BentBox> GhostPainter::bent_about(const FirstRays& rays, const Rectangle& box) {
  const bool fail = std::ranges::any_of(rays.sheets, [](const RaySheet& sheet) { return sheet.failed > 0; });
  if (!fail || deepest_ < kWorthBending || !dirt_.empty() || !tracers_.light().symmetric || box.low.y != -box.high.y)
    return std::nullopt;
  std::vector<ClearanceGrid> grids{tracers_.clearance(0)};
  if (tracers_.passes().size() > 1) grids.push_back(tracers_.clearance(tracers_.passes().size() - 1));
  auto bent = bent_box(grids, box);
  for (const ClearanceGrid& grid : grids) tracers_.count(grid);
  return bent;
}

void GhostPainter::paint(const FirstRays& rays, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out) {
  const std::vector<Band> bands = bands_for(rays, tracers_.passes(), samples_, frame_.pixel_pitch_mm);
  BandPatterns patterns;
  std::vector<std::shared_ptr<const stop_patterns::BandDirt>> dirt;
  for (const Band& band : bands) {
    patterns.push_back(patterns_ != nullptr ? band_pattern(rays, band) : nullptr);
    dirt.push_back(!dirt_.empty() ? band_dirt(rays, band) : nullptr);
  }
  PatchFitter fitter(tracers_, frame_, deepest_, patterns_ != nullptr ? patterns_->unseen : 0.0);
  const ErrorBudget per_band = budget_per_band(budget, bands.size());
  const auto paint_all = [&](const BandSet& set,
                             std::span<const std::shared_ptr<const stop_patterns::BandStopPattern>> of_set,
                             std::span<const std::shared_ptr<const stop_patterns::BandDirt>> dirt_of_set,
                             const std::vector<FittedPart>& parts) {
    if (parts.empty()) return;
    Tessellator cells(iris_, frame_, per_band, kFewCells, room_, out);
    cells.set_sides_bend(tracers_.is_bent());
    for (std::size_t band = 0; band < set.size(); ++band) {
      cells.set_dirt(SeenDirt{dirt_of_set[band], &tracers_.light(), tracers_.plane_z_mm()});
      if (of_set[band]) cells.set_stop_pattern(of_set[band], tracers_.stop_times());
      paint_band(set, band, parts, cells);
    }
  };
  const auto fit_and_paint = [&](BandSet& set, std::span<const RaySheet> first, const BandPatterns& of_set,
                                 std::span<const std::shared_ptr<const stop_patterns::BandDirt>> dirt_of_set) {
    const FittedBox fitted = fitter.fit(set, first, rays.tolerance, of_set, with_mirror_image);
    paint_all(set, of_set, dirt_of_set, fitted.parts);
    paint_all(set, of_set, dirt_of_set, fitted.mirror_image);
  };
  if (rays.samples > 0) {
    BandSet all(tracers_, samples_, rays, bands);
    std::vector<RaySheet> sheets;
    for (std::size_t k = 0; k < rays.samples; ++k) sheets.push_back(rays.sheets[samples_[k]]);
    all.add_weights(sheets, PacketPrecision::Double);
    return fit_and_paint(all, sheets, patterns, dirt);
  }
  for (std::size_t k = 0; k < bands.size(); ++k) {
    BandSet one(tracers_, bands[k]);
    const RaySheet sheet = band_sheet(rays, bands[k], tracers_.passes());
    fit_and_paint(one, {&sheet, 1}, {patterns[k]}, std::span(dirt).subspan(k, 1));
  }
}

// Paints one of the set's bands.
void GhostPainter::paint_band(const BandSet& set, std::size_t band, std::span<const FittedPart> parts,
                              Tessellator& cells) {
  Patch patch;
  for (const FittedPart& part : parts) {
    if (!part.only_band)
      set.band_patch(part.patches, band, patch);
    else if (*part.only_band == band)
      patch = part.patches.front();
    else
      continue;
    cells.choose(patch, part.place);
  }
  cells.emit();
}

}  // namespace contrejour::inline internal::adaptive
