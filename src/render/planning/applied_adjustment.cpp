// SPDX-License-Identifier: Apache-2.0
#include "render/planning/applied_adjustment.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/normal_pair.h"
#include "contrejour/expert/first_order.h"

namespace contrejour::inline internal {
namespace {

bool is_gain(double value) { return value >= 0.0 && std::isfinite(value); }
bool is_colour(const Rgb& rgb) { return std::all_of(rgb.begin(), rgb.end(), is_gain); }

std::string name_of(const GhostAdjustment& a) {
  return a.surface != 0 ? fmt::format("ghost of surface {}", a.surface) : fmt::format("ghost {}", ghost_name(a.ghost));
}

Rgb ramp_at(const std::vector<GhostRampStop>& ramp, double position) {
  if (ramp.empty()) return {1, 1, 1};
  const auto after =
      std::find_if(ramp.begin(), ramp.end(), [&](const GhostRampStop& stop) { return stop.position > position; });
  if (after == ramp.begin()) return after->colour;
  if (after == ramp.end()) return ramp.back().colour;
  const GhostRampStop& before = *(after - 1);
  const double t = (position - before.position) / (after->position - before.position);
  Rgb colour{};
  for (std::size_t c = 0; c < colour.size(); ++c) colour[c] = std::lerp(before.colour[c], after->colour[c], t);
  return colour;
}

// The offset depends on the ghost and the seed alone, not on which other ghosts are rendered.
Vec2 scattered(Ghost ghost, std::uint32_t seed) {
  const auto both = [](int low, int high) { return static_cast<std::uint32_t>(low + 1000 * high); };
  return normal_pair({seed, both(ghost.i, ghost.k), both(ghost.j, ghost.l)});
}

}  // namespace

Result<void> check_ghost_options(const LensState& lens, const GhostOptions& options) {
  if (!is_gain(options.gain) || !is_gain(options.edge_gain))
    return invalid_argument("a gain of ghosts must be 0 or more");
  if (!(options.jitter >= 0.0 && options.jitter <= kFarthestOffset))
    return invalid_argument(fmt::format("ghosts are scattered by 0 to {} times the frame's height", kFarthestOffset));
  for (const GhostAdjustment& a : options.adjustments) {
    const std::string whose = name_of(a);
    if (a.surface != 0 ? !reflects_at(lens, a.surface) : !has_ghost(lens, a.ghost))
      return invalid_argument(
          fmt::format("there is no {} in this lens; `contrejour ghosts` lists those there are", whose));
    if (!is_gain(a.gain) || !is_colour(a.colour))
      return invalid_argument(fmt::format("{}: give a gain and colours of 0 or more", whose));
    if (!(std::abs(a.offset.x) <= kFarthestOffset && std::abs(a.offset.y) <= kFarthestOffset))
      return invalid_argument(
          fmt::format("{}: give an offset of at most {} times the frame's height", whose, kFarthestOffset));
  }
  for (std::size_t k = 0; k < options.ramp.size(); ++k) {
    const GhostRampStop& stop = options.ramp[k];
    if (!(std::abs(stop.position) <= kFarthestPosition) || !is_colour(stop.colour))
      return invalid_argument(
          fmt::format("a ramp's places must lie within {} and its colours be 0 or more", kFarthestPosition));
    if (k > 0 && !(stop.position > options.ramp[k - 1].position))
      return invalid_argument("let the places of a ramp rise");
  }
  return {};
}

Result<void> check_brightness(std::span<const Light> lights, std::span<const Ghost> ghosts,
                              std::span<const AppliedAdjustment> adjustments, const GhostOptions& options) {
  const double edge_gain = std::max(1.0, options.edge_gain);
  for (std::size_t c = 0; c < 3 && !adjustments.empty(); ++c) {
    const auto strongest =
        std::max_element(adjustments.begin(), adjustments.end(),
                         [c](const AppliedAdjustment& a, const AppliedAdjustment& b) { return a.tint[c] < b.tint[c]; });
    const double gain = edge_gain * strongest->tint[c];
    for (std::size_t k = 0; k < lights.size(); ++k) {
      const double value = lights[k].value[c];
      if (std::abs(value) * gain <= kMaxLightValue) continue;
      return invalid_argument(fmt::format(
          "light {}: its value of {:.4g} times the gains of ghost {}, {:.4g}, is beyond {:.0e}", k + 1, value,
          ghost_name(ghosts[static_cast<std::size_t>(strongest - adjustments.begin())]), gain, kMaxLightValue));
    }
  }
  return {};
}

std::vector<AppliedAdjustment> applied_adjustments(const LensState& lens, std::span<const Ghost> ghosts,
                                                   const GhostOptions& options, const Frame& frame) {
  const double height_mm = frame.full_height * frame.pixel_pitch_mm;
  std::vector<AppliedAdjustment> adjustments;
  for (const Ghost& ghost : ghosts) {
    AppliedAdjustment adjustment;
    adjustment.tint = {options.gain, options.gain, options.gain};
    Vec2 offset;  // right and up in the picture
    const auto tint = [&](const Rgb& colour, double gain) {
      for (std::size_t c = 0; c < colour.size(); ++c) adjustment.tint[c] *= colour[c] * gain;
    };
    if (!options.ramp.empty())
      tint(ramp_at(options.ramp, ghost_first_order(lens, ghost, lens.design_wavelength_nm).relative_image_height), 1.0);
    for (const GhostAdjustment& a : options.adjustments) {
      if (a.surface != 0 ? !ghost.reflects_at(a.surface) : a.ghost != ghost) continue;
      tint(a.colour, a.gain);
      offset = offset + a.offset;
    }
    if (options.jitter > 0.0) offset = offset + scattered(ghost, options.jitter_seed) * options.jitter;
    adjustment.shift_mm = offset * -height_mm;  // right and up in the picture are left and down on the sensor
    adjustments.push_back(adjustment);
  }
  return adjustments;
}

}  // namespace contrejour::inline internal
