// SPDX-License-Identifier: Apache-2.0
// Parses the names of ghosts, and selections of them.
#include <string>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "settings/without_prefix.h"

namespace contrejour::params {
namespace {

// Sorts the pair that begins at k, because light meets its later surface first in whichever order they are written.
// Returns whether the pair can be reflecting surfaces.
bool sort_pair(std::vector<int>& numbers, std::size_t k) {
  if (numbers[k] > numbers[k + 1]) std::swap(numbers[k], numbers[k + 1]);
  return numbers[k] >= 1 && numbers[k] < numbers[k + 1];
}

// "2-5", "2,5" or "2-5-1-4".
std::optional<Ghost> parse_surfaces(std::string_view text) {
  std::vector<int> numbers;
  for (const std::string_view part : split(text, text.find(',') != std::string_view::npos ? ',' : '-')) {
    const auto number = parse_integer(part);
    numbers.push_back(number ? *number : 0);
  }
  if ((numbers.size() != 2 && numbers.size() != 4) || !sort_pair(numbers, 0)) return std::nullopt;
  Ghost ghost{numbers[0], numbers[1]};
  if (numbers.size() == 2) return ghost;
  if (!sort_pair(numbers, 2)) return std::nullopt;
  ghost.k = numbers[2];
  ghost.l = numbers[3];
  return ghost;
}

// "1,-2": a diffraction order at the sensor.
bool parse_order(std::string_view text, Ghost& ghost) {
  const auto orders = split(text, ',');
  if (orders.size() != 2) return false;
  const auto x = parse_integer(orders[0]), y = parse_integer(orders[1]);
  if (!x || !y) return false;
  ghost.order = {*x, *y};
  return true;
}

}  // namespace

Result<Ghost> parse_ghost(std::string_view text) {
  const std::size_t at = text.find('@');
  auto ghost = parse_surfaces(text.substr(0, at));
  if (ghost && (at == std::string_view::npos || parse_order(text.substr(at + 1), *ghost))) return *ghost;
  return invalid_argument(fmt::format(
      "\"{}\" is not a ghost; give its two surfaces as in 2-5, both pairs of a ghost of four reflections as "
      "in 2-5-1-4, and a diffraction order at the sensor as in 7-12@1,-2",
      text));
}

// A comma separates two ghosts, or two numbers within one that is written with commas or has more reflections: a number
// that is not part of a pair is joined with the next.
Result<std::vector<Ghost>> parse_ghosts(std::string_view text) {
  const auto parts = split(text, ',');
  const auto is_incomplete = [](std::string_view part) {
    return part.find('@') != std::string_view::npos || part.find('-', 1) == std::string_view::npos;
  };
  std::vector<Ghost> ghosts;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    std::string name(parts[k]);
    if (is_incomplete(parts[k]) && k + 1 < parts.size()) name.append(",").append(parts[++k]);
    const auto ghost = parse_ghost(name);
    if (!ghost) return tl::unexpected(ghost.error());
    ghosts.push_back(*ghost);
  }
  return ghosts;
}

Result<GhostSelection> parse_selection(std::string_view text) {
  if (text == "all") return SelectAll{};
  if (const auto number = without_prefix(text, "brightest:")) {
    const auto count = parse_integer(*number);
    if (count && *count >= 0) return SelectBrightest{*count};
  } else if (const auto amount = without_prefix(text, "flux:")) {
    const auto percent = parse_real(*amount);
    if (percent && *percent >= 0.0 && *percent <= 100.0) return SelectByFlux{*percent};
  } else if (const auto index = without_prefix(text, "surface:")) {
    const auto surface = parse_integer(*index);
    if (surface && *surface >= 1) return SelectSurface{*surface};
  } else if (const auto list = without_prefix(text, "list:")) {
    const auto ghosts = parse_ghosts(*list);
    if (!ghosts) return tl::unexpected(ghosts.error());
    return SelectList{*ghosts};
  }
  return invalid_argument(
      fmt::format("\"{}\" is not a selection of ghosts; give all, brightest:N, flux:PERCENT, surface:K or "
                  "list:2-5,3-7",
                  text));
}

}  // namespace contrejour::params
