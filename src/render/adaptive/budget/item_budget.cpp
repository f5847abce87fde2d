// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/item_budget.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kBoundSlack = 8.5,
                 kBoundSlackAt = 0.003;  // by how much bounds exceed errors, and the error for which that holds
constexpr double kFew = 16.0;  // added to the number of items
constexpr double kRaysOfOne = 20.0;  // rays in the preview frame that count as one item
// The fraction of its squared error that an item with stop patterns may make: cells come closer to their bounds there.
constexpr double kPatternedFraction = 0.75;
constexpr double kNegligibleLevel = 3e-5;  // of the peak: four stops brighter it is a two-thousandth
// The fraction of the frame's squared error that the squared light of all negligible items may make. Their error is
// less, since preview quality is within a tenth of their light.
constexpr double kNegligibleFraction = 0.05;

// Errors above the frame's peak count less (peak_limited_weight), since pictures are compared with samples clipped
// there. That holds on average along an outline, few of whose pixels are darker than the peak. A ghost of a few pixels
// has no average: each pixel that its border crosses runs from 0 to the ghost's level, and below the peak all of that
// counts, so that displacements show as flicker. Small ghosts have few cells, so that drawing them better costs little.
double peak_for(const ItemEstimate& estimate, double peak) {
  constexpr double kSmall_px = 16.0;  // area of a ghost half of whose level counts
  const double size = std::max(estimate.area_px, 0.0) / kSmall_px;
  return std::max(peak, estimate.level / (1.0 + size * size));
}

}  // namespace

// The error that one item may make. Errors of different items have either sign and fall at different pixels, so they
// add in squares; and most cells stay far below the bound that they are held to. The budgets of all items may therefore
// add up to kBoundSlack^2 sqrt(E / kBoundSlackAt) times the squared error that the frame is allowed. How far cells stay
// below their bounds differs from ghost to ghost, which a few items do not average out (kFew). More cells come near
// their bounds in items whose first rays fail, which take more rays in the preview frame, and where a smaller error is
// asked for. The constants were found by measuring random frames (docs/physics/adaptive/items-and-budget.md).
ErrorBudget budget_per_item(const FrameError& allowed, const std::vector<ItemEstimate>& estimates) {
  double items = kFew;
  for (const ItemEstimate& estimate : estimates) items += std::max(estimate.rays / kRaysOfOne, 1.0);
  const double slack = kBoundSlack * kBoundSlack * std::sqrt(allowed.error / kBoundSlackAt);
  return {slack * allowed.squared() / items, allowed.peak, {}};
}

ErrorBudget budget_of(const ItemEstimate& estimate, bool has_fringes, bool is_negligible, const ErrorBudget& per_item) {
  ErrorBudget of_item = per_item;
  of_item.about = estimate;
  of_item.peak = peak_for(estimate, per_item.peak);
  if (has_fringes) of_item.squared_error *= kPatternedFraction;
  if (is_negligible) of_item.squared_error = std::numeric_limits<double>::infinity();
  return of_item;
}

std::vector<bool> negligible_items(const std::vector<ItemEstimate>& estimates, const FrameError& allowed) {
  std::vector<bool> negligible(estimates.size());
  std::vector<std::size_t> dim;
  std::vector<double> squared(estimates.size());
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const ItemEstimate& estimate = estimates[k];
    if (!(estimate.area_px > 0.0) || estimate.level > kNegligibleLevel * allowed.peak) continue;
    squared[k] = estimate.level * estimate.level * estimate.area_px;
    negligible[k] = true;
    dim.push_back(k);
  }
  for (const std::size_t k : above_error_limit(std::move(dim), squared, kNegligibleFraction * allowed.squared()))
    negligible[k] = false;
  return negligible;
}

double faintest_peak(const FramePlan& plan, const Frame& frame) {
  constexpr double kFaintest = 1e-9;  // irradiance on the sensor over that of the light
  double gain = 0.0;
  for (const PlannedLight& light : plan.lights)
    for (const PlannedPass& pass : light.passes) gain = std::max(gain, *std::ranges::max_element(pass.gain));
  return std::max(kFaintest * gain * frame.pixel_pitch_mm * frame.pixel_pitch_mm,
                  static_cast<double>(std::numeric_limits<float>::min()));
}

}  // namespace contrejour::inline internal::adaptive
