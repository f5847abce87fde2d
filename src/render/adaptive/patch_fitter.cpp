// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/patch_fitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "render/adaptive/budget/cell_choice.h"
#include "render/adaptive/budget/fit_budget.h"
#include "render/adaptive/budget/patterned_boxes.h"
#include "render/adaptive/budget/preview.h"
#include "render/adaptive/cells/box_cells.h"
#include "render/adaptive/cells/ray_map_names.h"
#include "render/ray_maps/illuminated_region.h"
#include "render/ray_maps/lobatto_cells.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr std::array kNodes{kMinNodes, 9, 17};
static_assert(kMaxDepth + kNextToFailure + kMaxMeshDepth <= MeshPosition::kMaxDepth);
constexpr double kNoFit = std::numeric_limits<double>::infinity();

// The estimated error of a patch over its tolerance.
double misfit(const Patch& patch, const Tolerance& tolerance) {
  const PatchError e = estimated_error(patch);
  return std::max({e.position_px / tolerance.position_px, e.stop / tolerance.stop, e.rim / (2.0 * tolerance.stop),
                   e.weight / tolerance.weight});
}

bool all_arrive(std::span<const LobattoRays> ray_sets) {
  return std::all_of(ray_sets.begin(), ray_sets.end(), [](const LobattoRays& ray_set) { return ray_set.failed == 0; });
}

bool gets_through(const LobattoRays& ray_set, std::size_t node) {
  const auto passes = [&](const auto& at) { return std::hypot(at[0][node], at[1][node]) <= 1.0F; };
  return ray_set.relative_height[node] <= 1.0F && std::ranges::all_of(ray_set.stop, passes);
}

// By how much linear interpolation to a ray's two neighbours on the sensor misses it: four times the error that linear
// interpolation between neighbours makes. 0 at the box's border and beside rays that fail.
double bend_mm(const LobattoRays& ray_set, std::size_t node, std::size_t step, const std::vector<double>& points) {
  const auto n = static_cast<std::size_t>(ray_set.nodes);
  const std::size_t along = step == 1 ? node % n : node / n;
  if (along == 0 || along + 1 == n) return 0.0;
  const std::size_t before = node - step, after = node + step;
  if (!ray_set.arrives(before) || !ray_set.arrives(node) || !ray_set.arrives(after)) return 0.0;
  const double t = (points[along] - points[along - 1]) / (points[along + 1] - points[along - 1]);
  const auto off = [&](const std::vector<float>& at) {
    return static_cast<double>(at[node]) - (1.0 - t) * static_cast<double>(at[before]) -
           t * static_cast<double>(at[after]);
  };
  return std::hypot(off(ray_set.sensor_x_mm), off(ray_set.sensor_y_mm));
}

// The area of the entrance in which linear interpolation between rays would lose light or misplace it by more than
// this: next to rays that fail, and where the rays' map is bent.
double area_not_linear_mm2(const LobattoRays& ray_set, double most_mm) {
  const LobattoCells cells(ray_set);
  const std::vector<double>& points = lobatto_points(ray_set.nodes);
  const auto n = static_cast<std::size_t>(ray_set.nodes);
  double sum_mm2 = 0.0;
  for (std::size_t first = 0; first < cells.end(); ++first) {
    if (!cells.has(first)) continue;
    const auto corners = cells.corners(first);
    if (std::ranges::none_of(corners, [&](std::size_t k) { return gets_through(ray_set, k); })) continue;
    const auto is_off = [&](std::size_t k) {
      return std::isinf(ray_set.relative_height[k]) || bend_mm(ray_set, k, 1, points) > 4.0 * most_mm ||
             bend_mm(ray_set, k, n, points) > 4.0 * most_mm;
    };
    if (std::ranges::any_of(corners, is_off)) sum_mm2 += cells.entrance_mm2(first);
  }
  return sum_mm2;
}

// The worst misfit of three bands: those between them are blends of the same patches.
double misfit(const BandSet& bands, std::span<const Patch> patches, const Tolerance& tolerance) {
  Patch patch;
  double worst = 0.0;
  const std::size_t step = std::max<std::size_t>(1, (bands.size() - 1) / 2);
  for (std::size_t band = 0; band < bands.size(); band += step) {
    bands.band_patch(patches, band, patch);
    worst = std::max(worst, misfit(patch, tolerance));
  }
  return worst;
}

}  // namespace

FittedBox PatchFitter::fit(BandSet& bands, std::span<const LobattoRays> first, const Tolerance& tolerance,
                           const BandPatterns& patterns, bool with_mirror_image) {
  FittedBox out;
  const Fitting fitting{bands, tolerance, patterns, out.parts, with_mirror_image ? &out.mirror_image : nullptr};
  const BoxPart part = whole(first.front().box);
  double first_misfit = kNoFit;
  if (all_arrive(first)) {
    std::vector<Patch> patches = bands.make_patches(first, frame_);
    first_misfit = misfit(bands, patches, tolerance);
    if (first_misfit <= 1.0) {
      keep(part.position, first, std::move(patches), fitting);
      return out;
    }
  }
  fit(part, first_misfit, fitting);
  return out;
}

// A box that no other box adjoins.
PatchFitter::BoxPart PatchFitter::whole(const Rectangle& box, int depth) {
  const MeshPosition position{boxes_, is_symmetric(box) ? boxes_ : boxes_ + 1};
  boxes_ += 2;
  return {box, position, depth};
}

bool PatchFitter::is_symmetric(const Rectangle& box) const {
  return tracers_.light().symmetric && box.low.y == -box.high.y;
}

PacketPrecision PatchFitter::precision_for(const Rectangle& box, const Tolerance& tolerance) const {
  const bool coarse = tolerance.position_px * frame_.pixel_pitch_mm > 2.0 * kFloatError_mm;
  const Vec2 size = box.high - box.low;
  return coarse && std::min(size.x, size.y) > kFloatBox_mm ? PacketPrecision::Float : PacketPrecision::Double;
}

// first_misfit: that of kMinNodes nodes, if known.
void PatchFitter::fit(const BoxPart& part, std::optional<double> first_misfit, const Fitting& fitting) {
  BandSet& bands = fitting.bands;
  const Rectangle& box = part.box;
  double before = first_misfit.value_or(kNoFit);
  for (std::size_t k = first_misfit ? 1 : 0; k < kNodes.size(); ++k) {
    const PacketPrecision precision = precision_for(box, fitting.tolerance);
    std::vector<LobattoRays> ray_sets = bands.trace(box, kNodes[k], precision);
    const std::optional<double> level = level_behind(ray_sets, fitting);
    if (level && *level < negligible_level_) return;
    const bool negligible = level && *level < kNegligibleLevels * negligible_level_;
    const double looser = level ? std::clamp(fitting.tolerance.level / *level, 1.0, kMaxLoosening) : 1.0;
    const auto illuminated = illuminated_region(ray_sets, tracers_.light(), frame_, fitting.mirror_image != nullptr);
    if (!illuminated) return;
    const bool last_part = part.depth >= max_depth_;
    if (!last_part && area_of(*illuminated) < kWorthShrinking * area_of(box))
      return fit(whole(*illuminated, part.depth + 1), std::nullopt, fitting);
    const bool last = k + 1 == kNodes.size();
    const double misplaced_mm = kMisplaced * fitting.tolerance.position_px * frame_.pixel_pitch_mm;
    const bool arrive = all_arrive(ray_sets);
    if (!arrive && !last_part && !negligible) break;
    if (!arrive && !negligible && area_not_linear_mm2(ray_sets.front(), misplaced_mm) > fitting.tolerance.lost_mm2) {
      if (!last) continue;
      if (part.depth < max_depth_ + kNextToFailure) break;
    }
    bands.add_weights(ray_sets, precision);
    if (!arrive) return fit_between_rays(part, ray_sets, fitting);
    std::vector<Patch> patches = bands.make_patches(ray_sets, frame_);
    const double now = misfit(bands, patches, fitting.tolerance) / looser;
    if (now <= 1.0 || negligible || (last && last_part))
      return keep(part.position, ray_sets, std::move(patches), fitting);
    // Errors fall by a constant factor for a constant number of further nodes; the next step adds twice as many.
    const double next = now * (now / before) * (now / before);
    if (next > kHopeless && !last_part) break;
    before = now;
  }
  fit_quarters(part, fitting);
}

// patches: those of the ray sets.
void PatchFitter::keep(const MeshPosition& position, std::span<const LobattoRays> ray_sets, std::vector<Patch> patches,
                       const Fitting& fitting) const {
  fitting.parts.push_back({position, std::move(patches), fitting.only_band});
  if (fitting.mirror_image == nullptr) return;
  std::vector<LobattoRays> others;
  for (const LobattoRays& ray_set : ray_sets) others.push_back(mirrored(ray_set));
  fitting.mirror_image->push_back({position.mirrored(), fitting.bands.make_patches(others, frame_), fitting.only_band});
}

// Interpolates linearly between the rays that arrive, for each band by itself, since rays fail at different points.
void PatchFitter::fit_between_rays(const BoxPart& part, std::span<const LobattoRays> ray_sets, const Fitting& fitting) {
  if (fitting.bands.size() == 1 && ray_sets.size() == 1) {
    const auto add_cells = [&](const LobattoRays& ray_set, std::vector<FittedPart>& parts) {
      for (Patch& patch : patches_of_cells(ray_set, tracers_.light(), frame_))
        parts.push_back({whole(patch.box).position, {std::move(patch)}, fitting.only_band.value_or(0)});
    };
    add_cells(ray_sets.front(), fitting.parts);
    if (fitting.mirror_image != nullptr) add_cells(mirrored(ray_sets.front()), *fitting.mirror_image);
    return;
  }
  for (std::size_t k = 0; k < fitting.bands.size(); ++k) {
    BandSet alone = fitting.bands.alone(k);
    fit(part, std::nullopt,
        {alone, fitting.tolerance, fitting.patterns.subspan(k, 1), fitting.parts, fitting.mirror_image, k});
  }
}

// In a box that is its own mirror image, the quarters on one side of the axis determine the others.
void PatchFitter::fit_quarters(const BoxPart& part, const Fitting& fitting) {
  const Rectangle& box = part.box;
  const Vec2 middle = (box.low + box.high) * 0.5;
  const bool symmetric = is_symmetric(box);
  Fitting of_quarter = fitting;
  if (symmetric) of_quarter.mirror_image = &fitting.parts;
  for (const std::size_t q : {2U, 3U, 0U, 1U}) {
    const bool right = q % 2 != 0, upper = q / 2 != 0;
    if (symmetric && !upper) return;
    const Rectangle quarter{{right ? middle.x : box.low.x, upper ? middle.y : box.low.y},
                            {right ? box.high.x : middle.x, upper ? box.high.y : middle.y}};
    fit({quarter, part.position.quarter(q), part.depth + 1}, std::nullopt, of_quarter);
  }
}

// An estimate of the brightest pixel of a box, or of its mirror image, behind a stop pattern. Empty where it is not
// used: the iris is sharp, there are several bands, or no four neighbouring rays all arrive.
std::optional<double> PatchFitter::level_behind(std::span<const LobattoRays> ray_sets, const Fitting& fitting) const {
  const BandSet& bands = fitting.bands;
  if (fitting.patterns.front() == nullptr || bands.size() > 1 || ray_sets.size() > 1) return std::nullopt;
  Rgb gain{};
  for (std::size_t k = bands.band(0).first; k < bands.band(0).last; ++k)
    for (std::size_t c = 0; c < 3; ++c) gain[c] += tracers_.passes()[k].gain[c];
  const double pixel_mm2 = frame_.pixel_pitch_mm * frame_.pixel_pitch_mm;
  const double scale = std::max({std::abs(gain[0]), std::abs(gain[1]), std::abs(gain[2])}) * pixel_mm2;
  const double enough = std::max(fitting.tolerance.level, kNegligibleLevels * negligible_level_);
  const auto brightest =
      brightest_transmitted(ray_sets.front(), fitting.mirror_image != nullptr, *fitting.patterns.front(),
                            tracers_.stop_times(), tracers_.light(), enough / scale);
  return brightest ? std::optional(*brightest * scale) : std::nullopt;
}

}  // namespace contrejour::inline internal::adaptive
