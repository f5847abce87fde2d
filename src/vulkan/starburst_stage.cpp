// SPDX-License-Identifier: Apache-2.0
#include "vulkan/starburst_stage.h"

#include <algorithm>
#include <utility>

namespace contrejour::inline internal::vulkan {
namespace {

// Pixels about that of a light's image, on each side, which near.comp integrates, and those which meet many cells.
constexpr int kNearPixels = static_cast<int>(kNear_px), kCentralPixels = 4;
constexpr std::uint32_t kGroup = 64, kSharingFew = 4;  // invocations

auto place_of(const std::vector<Starburst>& patterns, const Starburst& pattern) {
  return std::ranges::find(patterns, pattern.rings(), &Starburst::rings);
}

}  // namespace

StarburstStage::StarburstStage(DeviceContext& device, const DeviceInfo& info, std::span<const PlacedStarburst> lights,
                               StarburstKept& kept)
    : device_(device), info_(info), lights_(lights), kept_(kept) {
  if (lights.empty() || lights.size() > kMostPlacedStarbursts || !upload_patterns()) return;
  device_.write_first(Slot::Starbursts, light_words(lights_, patterns_of_lights()));
  fits_ = true;
}

// Returns false if the patterns do not fit into a buffer. If one is missing on the device, all are uploaded again.
bool StarburstStage::upload_patterns() {
  const auto is_kept = [&](const PlacedStarburst& light) {
    return place_of(kept_.patterns, light.pattern) != kept_.patterns.end();
  };
  if (std::ranges::all_of(lights_, is_kept)) return true;
  StarburstKept next;
  std::uint64_t size = kPatternsAt;
  for (const PlacedStarburst& light : lights_) {
    if (place_of(next.patterns, light.pattern) != next.patterns.end()) continue;
    next.patterns.push_back(light.pattern);
    size += pattern_size(*light.pattern.rings());
  }
  if (sizeof(std::uint32_t) * size > info_.storage_range_bytes) return false;
  std::vector<std::uint32_t> words(kPatternsAt);
  words.reserve(size);
  for (const Starburst& pattern : next.patterns) {
    next.at.push_back(static_cast<std::uint32_t>(words.size()));
    append_pattern(*pattern.rings(), words);
  }
  kept_ = {};  // until all is there
  device_.upload(Slot::Starbursts, words);
  uploaded_bytes_ = sizeof(std::uint32_t) * words.size();
  kept_ = std::move(next);
  return true;
}

std::vector<std::uint32_t> StarburstStage::patterns_of_lights() const {
  std::vector<std::uint32_t> at;
  for (const PlacedStarburst& light : lights_)
    at.push_back(kept_.at[static_cast<std::size_t>(place_of(kept_.patterns, light.pattern) - kept_.patterns.begin())]);
  return at;
}

// Adds the pixels about a light's image, up to so many on each side, by `sharing` invocations each.
void StarburstStage::draw_about(StarburstParameters p, int pixels, std::uint32_t sharing) {
  const auto [x, y] = image_pixel(lights_[p.light]);
  p.left = std::max(x - pixels, 0);
  p.top = std::max(y - pixels - p.first_row, 0);
  p.sharing = sharing;
  const int right = std::min(x + pixels + 1, p.width), bottom = std::min(y + pixels + 1 - p.first_row, p.height);
  if (right <= p.left || bottom <= p.top) return;
  const auto across = static_cast<std::uint32_t>(right - p.left), down = static_cast<std::uint32_t>(bottom - p.top);
  const std::uint32_t pixels_a_group = kGroup / sharing;
  device_.dispatch(Shader::StarburstNear, p, {(across + pixels_a_group - 1) / pixels_a_group, down});
}

void StarburstStage::draw(int width, int height, int first_row) {
  if (!fits_) return;
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  StarburstParameters p{count_of_lights(), width, height, first_row};
  device_.dispatch(Shader::StarburstFar, p, groups_of(pixels, info_));
  device_.barrier();
  for (p.light = 0; p.light < count_of_lights(); ++p.light) {
    draw_about(p, kCentralPixels, kGroup);
    draw_about(p, kNearPixels, kSharingFew);
    device_.barrier();
  }
  device_.end_stage("starburst");
}

}  // namespace contrejour::inline internal::vulkan
