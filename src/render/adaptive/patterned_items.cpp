// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/patterned_items.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/tasks.h"
#include "render/stop_patterns/stop_pattern.h"

namespace contrejour::inline internal::adaptive {
namespace {

// Fractions of the frame's squared error: for ghosts that stay sharp, and for small fringes that the others leave out.
constexpr double kSharpFraction = 0.6, kRippleFraction = 0.5;
// The squared difference of a straight edge's profile from the sharp one, integrated, in units 1 / sqrt(2 F).
constexpr double kEdgeError = 0.3;
// A pattern is truncated where it is dimmer than kBoundingRipple of the dimmest fringe, with at most kBoundingFlux of
// its light beyond.
constexpr double kBoundingRipple = 0.5, kBoundingFlux = 0.003;
constexpr std::size_t kMaxPatterns = 8;  // of a ghost's wavelengths
constexpr double kNegligibleError = 0.01;  // fraction of the error that all pixels may have
constexpr double kOutline = 1.5;  // length of an outline over that of a disc of the same area
// Pixels along an outline that cost as much as its coverage and cells, and the least error that a pixel of fringes must
// remove, over the square of the dimmest fringe. Found by measuring.
constexpr double kMargin_px = 8.0, kWorth = 0.8;
// fraction of kRippleFraction that remains, even if many ghosts keep sharp rims
constexpr double kMinRippleFraction = 0.5;

// The rim of an item: its visible level, and the factor from squared errors summed over t (EdgeProfile) to squared
// errors summed over pixels.
struct Rim {
  double level = 0.0, weight = 0.0;
  double stop_area = 0.0;  // the same factor for patterns, summed over the stop's plane in stop radii
  double fringe_unit_px = 0.0;  // width of t = 1 across the rim
};

Rim rim_of(const ItemEstimate& estimate, double peak, double fresnel_number) {
  const double visible = estimate.level * peak_limited_weight(estimate.level, peak);
  // The unit is R / sqrt(2 F), the outline 2 pi R, the area pi R^2.
  const double per_unit = std::sqrt(2.0 * std::max(fresnel_number, 0.5));
  return {visible, kOutline * visible * visible * 2.0 * estimate.area_px / per_unit,
          visible * visible * estimate.area_px / std::numbers::pi,
          std::sqrt(estimate.area_px / std::numbers::pi) / per_unit};
}

// The squared difference between an item's fringes and its sharp rim, summed over its pixels.
double fringe_error(const Rim& rim) { return kEdgeError * rim.weight; }

// The stop patterns of all passes. A pass whose fringes are not visible takes those of the next one, slightly wider.
// Null if none is visible.
std::shared_ptr<GhostPatterns> patterns_of(const StopTransmittances& stops, const Item& item) {
  auto all = std::make_shared<GhostPatterns>();
  all->patterns = stops.patterns();
  for (const PlannedPass& pass : passes_with_patterns(item.light->passes))
    all->by_pass.push_back({stops.pattern_of(item.ghost, pass.lambda_nm, item.light->source), {}});
  const auto visible = [](const GhostPatterns::OfPass& pass) { return pass.pattern != nullptr; };
  const auto any = std::find_if(all->by_pass.rbegin(), all->by_pass.rend(), visible);
  if (any == all->by_pass.rend()) return nullptr;
  auto next = any->pattern;
  for (auto at = all->by_pass.rbegin(); at != all->by_pass.rend(); ++at) {
    if (at->pattern == nullptr) at->pattern = next;
    next = at->pattern;
  }
  return all;
}

// An item whose stop patterns are to be drawn.
struct Drawn {
  std::shared_ptr<GhostPatterns> patterns;
  Rim rim;
};

const StopPattern& middle_pattern(const Drawn& item) {
  return *item.patterns->by_pass[item.patterns->by_pass.size() / 2].pattern;
}

// The profile of fringes along edges at the middle wavelength; null where the iris has a whole pattern.
const stop_patterns::EdgeProfile* edge_profile(const Drawn& item) {
  const auto* const edge = middle_pattern(item).edges();
  return edge != nullptr ? &edge->profile() : nullptr;
}

// The dimmest fringes that are drawn, as a level: the same for all items, since a pixel of fringes costs the same
// everywhere. All fringes that are left out together make the allowed error.
double dimmest_fringe(const std::vector<Drawn>& items, double allowed) {
  const auto error = [&](double dimmest) {
    double sum = 0.0;
    for (const Drawn& item : items) {
      if (!item.patterns || !(item.rim.level > 0.0)) continue;
      const double ripple = dimmest / item.rim.level;
      if (const auto* const profile = edge_profile(item))
        sum += item.rim.weight * profile->squared_error(profile->range_above(ripple));
      if (const auto* const texture = middle_pattern(item).texture())
        sum += item.rim.stop_area * texture->squared_beyond(texture->radius_above(ripple));
    }
    return sum;
  };
  double low = 0.0, high = 0.0;
  for (const Drawn& item : items) high = std::max(high, item.rim.level);
  constexpr int kHalvings = 24;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (error(middle) > allowed ? high : low) = middle;
  }
  return low;
}

// Returns whether fringes down to the dimmest level remove enough error for the cost of their pixels and of those along
// the outline.
bool is_above_error_limit(const Drawn& item, const stop_patterns::EdgeProfile& profile, double dimmest) {
  const double ripple = dimmest / item.rim.level;
  const auto range = profile.range_above(ripple);
  const double taken = profile.squared_error({0.0, 0.0}) - profile.squared_error(range);
  const double units = range.level - range.dark + kMargin_px / std::max(item.rim.fringe_unit_px, 1e-9);
  return taken >= kWorth * ripple * ripple * units;
}

// Removes the stop patterns of items whose fringes reduce the error by too little for their cost; the error of that is
// subtracted from what fringes may make. Returns the level of the dimmest fringes that are drawn.
double drop_small(std::vector<Drawn>& items, double allowed) {
  const double dimmest = dimmest_fringe(items, allowed);
  double sharp = 0.0;
  for (Drawn& item : items) {
    if (!item.patterns || !(item.rim.level > 0.0)) continue;
    const stop_patterns::EdgeProfile* const profile = edge_profile(item);
    if (profile == nullptr || is_above_error_limit(item, *profile, dimmest)) continue;
    sharp += item.rim.weight * profile->squared_error({0.0, 0.0});
    item.patterns = nullptr;
  }
  return sharp > 0.0 ? dimmest_fringe(items, std::max(allowed - sharp, kMinRippleFraction * allowed)) : dimmest;
}

// Sets how far from the edges fringes are drawn: to where they become dimmer than `dimmest`.
void set_range(const Drawn& item, double dimmest) {
  GhostPatterns& patterns = *item.patterns;
  const double ripple = dimmest / item.rim.level;
  for (GhostPatterns::OfPass& pass : patterns.by_pass) {
    double outer_radius = pass.pattern->outer_radius();
    if (const auto* const edge = pass.pattern->edges()) {
      const auto range = edge->profile().range_above(ripple);
      patterns.range = {std::min(patterns.range.dark, range.dark), std::max(patterns.range.level, range.level)};
      outer_radius = 1.0 - range.dark * edge->fringe_unit();
    } else if (const auto* const texture = pass.pattern->texture()) {
      outer_radius = std::max(texture->radius_above(ripple), 1.0);
      pass.bounding_polygon = texture->bounding_polygon_above(kBoundingRipple * ripple, kBoundingFlux);
    }
    patterns.outer_radius = std::max(patterns.outer_radius, outer_radius);
  }
}

}  // namespace

std::vector<PlannedPass> passes_with_patterns(std::span<const PlannedPass> passes) {
  std::vector<PlannedPass> out(passes.begin(), passes.end());
  const std::size_t groups = std::min(passes.size(), kMaxPatterns);
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t first = g * passes.size() / groups, last = (g + 1) * passes.size() / groups;
    if (last - first == 1) continue;
    PlannedPass middle = passes[(first + last) / 2];
    double squares = 0.0;
    for (const PlannedPass& pass : passes.subspan(first, last - first))
      squares += std::pow(pass.lambda_nm - middle.lambda_nm, 2.0) + pass.spread_nm * pass.spread_nm;
    middle.spread_nm = std::sqrt(squares / static_cast<double>(last - first));
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(first), out.begin() + static_cast<std::ptrdiff_t>(last),
              middle);
  }
  return out;
}

Work set_stop_patterns(const Scene& scene, StopTransmittances& stops, std::vector<Item>& items,
                       const std::vector<ItemEstimate>& estimates, const FrameError& allowed, const Context& context) {
  const double squares = allowed.squared();
  std::vector<std::size_t> all(items.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<double> error(items.size());
  std::vector<Rim> rims(items.size());
  for (const std::size_t k : all) error[k] = fringe_error(rim_of(estimates[k], allowed.peak, 0.5));  // an upper bound
  const auto worth = [&](std::vector<std::size_t> some) {
    return stops.has_half_tones() ? some : above_error_limit(std::move(some), error, 0.5 * kSharpFraction * squares);
  };
  std::vector<std::size_t> chosen = worth(all);
  for (const std::size_t k : chosen) {
    const auto& passes = items[k].light->passes;
    const double f = stops.fresnel_number(items[k].ghost, passes[passes.size() / 2].lambda_nm, items[k].light->source);
    rims[k] = rim_of(estimates[k], allowed.peak, f);
    error[k] = fringe_error(rims[k]);
  }
  chosen = worth(std::move(chosen));

  std::vector<StopTransmittances::Request> wanted;
  for (const std::size_t k : chosen)
    for (const PlannedPass& pass : passes_with_patterns(items[k].light->passes))
      wanted.push_back({items[k].ghost, pass.lambda_nm, pass.spread_nm, items[k].light->source});
  if (!stops.prepare(wanted, context)) return {};
  std::vector<Drawn> drawn;
  for (const std::size_t k : chosen) drawn.push_back({patterns_of(stops, items[k]), rims[k]});
  const double dimmest = drop_small(drawn, kRippleFraction * squares);

  std::vector<Work> work(chosen.size());
  parallel_for(chosen.size(), context, [&](std::size_t at) {
    if (!drawn[at].patterns) return;
    set_range(drawn[at], dimmest);
    drawn[at].patterns->negligible_level = kNegligibleError * allowed.error * allowed.peak;
    Item& item = items[chosen[at]];
    item.patterns = drawn[at].patterns;
    work[at] = widen_boxes(scene, item);
  });
  Work sum;
  for (const Work& w : work) sum.add(w);
  return sum;
}

}  // namespace contrejour::inline internal::adaptive
