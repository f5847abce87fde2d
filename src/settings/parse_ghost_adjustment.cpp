// SPDX-License-Identifier: Apache-2.0
// Parses artistic adjustments of ghosts: gains, colours and offsets, and the colour ramp.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "settings/parameter_tables.h"
#include "settings/parse_rgb.h"

namespace contrejour::params {
namespace {

constexpr double kMaxOffset = 1000.0;  // in units of the frame's height
constexpr double kMaxRampPosition = 1e6;

// "2-5", or "5" for all ghosts that reflect at surface 5.
Result<GhostAdjustment> parse_target(std::string_view text) {
  GhostAdjustment adjustment;
  if (const auto surface = parse_integer(text); surface && *surface >= 1) {
    adjustment.surface = *surface;
    return adjustment;
  }
  const auto ghost = parse_ghost(text);
  if (!ghost) return tl::unexpected(ghost.error());
  adjustment.ghost = *ghost;
  return adjustment;
}

using Assignment = std::pair<std::string_view, std::string>;  // "colour", "1,0.8,0.6"

// Splits "gain=0.5,colour=1,0.8,0.6": a part without a name continues the list of the assignment before it.
Result<std::vector<Assignment>> parse_assignments(std::string_view text) {
  std::vector<Assignment> assignments;
  for (const std::string_view part : split(text, ',')) {
    const std::size_t equals = part.find('=');
    if (equals != std::string_view::npos) {
      assignments.emplace_back(part.substr(0, equals), part.substr(equals + 1));
    } else if (!assignments.empty()) {
      assignments.back().second.append(",").append(part);
    } else {
      return invalid_argument(
          fmt::format("\"{}\" does not say what to adjust; write the ghost and a setting, as in 2-5:gain=0.5", text));
    }
  }
  return assignments;
}

Result<void> set_gain(const std::string& text, GhostAdjustment& adjustment) {
  const auto gain = parse_real(text);
  if (!gain || !(*gain >= 0.0 && *gain <= kMaxGain))
    return invalid_argument(fmt::format("\"{}\" is not a gain; give a number from 0 to {:.0e}", text, kMaxGain));
  adjustment.gain = *gain;
  return {};
}

Result<void> set_colour(const std::string& text, GhostAdjustment& adjustment) {
  const auto rgb = parse_rgb(text, kMaxGain);
  if (!rgb) return tl::unexpected(rgb.error());
  adjustment.colour = *rgb;
  return {};
}

Result<void> set_offset(const std::string& text, GhostAdjustment& adjustment) {
  const auto xy = parse_reals(text, 2);
  if (!xy) return tl::unexpected(xy.error());
  if (std::max(std::abs((*xy)[0]), std::abs((*xy)[1])) > kMaxOffset)
    return invalid_argument(
        fmt::format("\"{}\" is out of range; give an offset of at most {} frame heights", text, kMaxOffset));
  adjustment.offset = {(*xy)[0], (*xy)[1]};
  return {};
}

Result<void> set(const Assignment& assignment, GhostAdjustment& adjustment) {
  const auto& [name, value] = assignment;
  if (name == "gain") return set_gain(value, adjustment);
  if (name == "colour") return set_colour(value, adjustment);
  if (name == "offset") return set_offset(value, adjustment);
  return invalid_argument(fmt::format("\"{}\" is not a setting of a ghost; set gain, colour or offset", name));
}

Result<GhostRampStop> parse_ramp_stop(std::string_view text) {
  const auto halves = split(text, ':');
  const auto position = parse_real(halves[0]);
  if (halves.size() != 2 || !position)
    return invalid_argument(
        fmt::format("\"{}\" is not a position and its colour; write a ramp as -1:1,0.5,0.2/1:1,1,1", text));
  if (std::abs(*position) > kMaxRampPosition)
    return invalid_argument(fmt::format("{} is out of range; give ramp positions from -{} to {}", halves[0],
                                        kMaxRampPosition, kMaxRampPosition));
  const auto rgb = parse_rgb(halves[1], kMaxGain);
  if (!rgb) return tl::unexpected(rgb.error());
  return GhostRampStop{*position, *rgb};
}

}  // namespace

Result<GhostAdjustment> parse_ghost_adjustment(std::string_view text) {
  const std::size_t colon = text.find(':');
  auto adjustment = parse_target(text.substr(0, colon));
  if (!adjustment || colon == std::string_view::npos) return adjustment;
  const auto assignments = parse_assignments(text.substr(colon + 1));
  if (!assignments) return tl::unexpected(assignments.error());
  for (const Assignment& assignment : *assignments)
    if (const auto ok = set(assignment, *adjustment); !ok) return tl::unexpected(ok.error());
  return adjustment;
}

Result<std::vector<GhostRampStop>> parse_ghost_ramp(std::string_view text) {
  std::vector<GhostRampStop> ramp;
  for (const std::string_view part : split(text, '/')) {
    const auto stop = parse_ramp_stop(part);
    if (!stop) return tl::unexpected(stop.error());
    if (!ramp.empty() && !(stop->position > ramp.back().position))
      return invalid_argument(fmt::format("\"{}\" is out of order; give a ramp's positions in increasing order", part));
    ramp.push_back(*stop);
  }
  return ramp;
}

}  // namespace contrejour::params
