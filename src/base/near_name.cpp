// SPDX-License-Identifier: Apache-2.0
#include "base/near_name.h"

#include <algorithm>
#include <cstdlib>

namespace contrejour::inline internal {

namespace {

constexpr std::size_t kMaxShown = 60;

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<int> before(width), above(width), row(width);
  for (std::size_t j = 0; j < width; ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, above);
    std::swap(above, row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < width; ++j) {
      const int replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, above[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace contrejour::inline internal

namespace contrejour {

std::string nearest_name(std::string_view name, const std::vector<std::string_view>& known) {
  if (name.empty() || name.size() > kMaxShown) return {};
  const std::string wanted = lower_case(name);
  std::string best;
  int best_distance = 1 + static_cast<int>(name.size()) / 3;
  for (const std::string_view candidate : known) {
    const std::string lower = lower_case(candidate);
    // A name that is part of the other one ("radius" for "radius_mm") is near at any length.
    const bool part = name.size() >= 3 && lower.find(wanted) != std::string::npos;
    // A difference in length is a lower bound of the distance: skip names that cannot be nearer than the best.
    const auto difference = std::max(lower.size(), wanted.size()) - std::min(lower.size(), wanted.size());
    if (!part && difference > static_cast<std::size_t>(best_distance)) continue;
    const int distance = part ? 0 : edit_distance(wanted, lower);
    if (distance < best_distance || (distance == best_distance && best.empty())) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace contrejour

namespace contrejour::inline internal {

std::string shortened(std::string_view name) {
  std::size_t size = std::min(name.size(), kMaxShown);
  // Step back over UTF-8 continuation bytes (10xxxxxx): never cut inside a character.
  while (size < name.size() && size > 0 && (static_cast<unsigned char>(name[size]) & 0xC0U) == 0x80U) --size;
  std::string shown(name.substr(0, size));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return size < name.size() ? shown + "..." : shown;
}

}  // namespace contrejour::inline internal
