// SPDX-License-Identifier: Apache-2.0
#include "vulkan/starburst_words.h"

#include <bit>
#include <cmath>
#include <cstddef>

#include "diffraction/near_field.h"

namespace contrejour::inline internal::vulkan {
namespace {

constexpr std::size_t kPatternHeader = 5, kFarWords = 4, kZoneWords = 4, kNearWords = 8, kRowWords = 6;
constexpr std::size_t kRowsOfOctave = kRowsPerOctave + 1;

// Words that are appended; their numbers refer to the whole buffer.
class Words {
 public:
  explicit Words(std::vector<std::uint32_t>& to) : to_(to) {}

  [[nodiscard]] std::uint32_t at() const { return static_cast<std::uint32_t>(to_.size()); }
  std::uint32_t leave_out(std::size_t count) {  // returns the first one's number
    const std::uint32_t first = at();
    to_.resize(to_.size() + count);
    return first;
  }
  void add(double value) { to_.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }
  void add_number(std::size_t value) { to_.push_back(static_cast<std::uint32_t>(value)); }
  // Densities of four channels each, of which the fourth is 0.
  void add_rgb(const std::vector<float>& rgb0) {
    for (std::size_t k = 0; k < rgb0.size(); k += 4)
      for (std::size_t c = 0; c < 3; ++c) add(rgb0[k + c]);
  }
  void set(std::uint32_t at, std::size_t value) { to_[at] = static_cast<std::uint32_t>(value); }
  void set_real(std::uint32_t at, double value) { to_[at] = std::bit_cast<std::uint32_t>(static_cast<float>(value)); }

 private:
  std::vector<std::uint32_t>& to_;
};

void append_zone(const SharpZone& zone, std::uint32_t record, Words& to) {
  to.set(record, zone.first_bin);
  to.set(record + 1, zone.cells());
  to.set(record + 2, to.at());
  for (const float edge : zone.edge) to.add(edge);
  to.set(record + 3, to.at());
  to.add_rgb(zone.rgb0);
}

void append_far(const StarburstOctave& octave, std::uint32_t record, Words& to) {
  to.set(record, octave.bins);
  to.set(record + 1, to.at());
  to.add_rgb(octave.rgb0);
  if (octave.zones.empty()) return;
  to.set(record + 2, to.at());
  for (const std::uint16_t zone : octave.zone_of_bin) to.add_number(zone);
  const std::uint32_t zones = to.leave_out(kZoneWords * octave.zones.size());
  to.set(record + 3, zones);
  for (std::size_t k = 0; k < octave.zones.size(); ++k)
    append_zone(octave.zones[k], zones + static_cast<std::uint32_t>(kZoneWords * k), to);
}

void append_near(const NearField::Octave& octave, std::uint32_t record, Words& to) {
  to.set_real(record, octave.first_px);
  to.set_real(record + 1, octave.end_px);
  to.set_real(record + 2, octave.first_row_px);
  to.set(record + 3, octave.edge.size() - 1);
  to.set(record + 4, to.at());
  for (const double edge : octave.edge) to.add(edge);
  to.set(record + 5, to.at());
  for (const Vec2 along : octave.along) {
    to.add(along.x);
    to.add(along.y);
  }
  to.set(record + 6, to.at());
  for (const double edge2 : octave.row_edge2) to.add(edge2);
  to.set(record + 7, to.at());
  for (std::size_t k = 0; k < octave.below.size(); ++k) {
    const auto& below = octave.below[k];
    const auto& next = octave.below[k % kRowsOfOctave == kRowsPerOctave ? k : k + 1];
    for (const double value : below) to.add(value);
    for (std::size_t c = 0; c < 3; ++c) to.add(next[c] - below[c]);
  }
}

}  // namespace

ImagePixel image_pixel(const PlacedStarburst& light) {
  return {static_cast<std::int32_t>(std::floor(light.centre_px.x)),
          static_cast<std::int32_t>(std::floor(light.centre_px.y))};
}

std::vector<std::uint32_t> light_words(std::span<const PlacedStarburst> lights,
                                       std::span<const std::uint32_t> patterns_at) {
  std::vector<std::uint32_t> out;
  Words words(out);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const auto [x, y] = image_pixel(lights[k]);
    words.add_number(patterns_at[k]);
    words.add_number(static_cast<std::uint32_t>(x));
    words.add_number(static_cast<std::uint32_t>(y));
    words.add(x + 0.5 - lights[k].centre_px.x);
    words.add(y + 0.5 - lights[k].centre_px.y);
    for (const double flux : lights[k].flux) words.add(flux);
  }
  return out;
}

std::uint64_t pattern_size(const StarburstRings& rings) {
  std::uint64_t size = kPatternHeader + kFarWords * rings.octaves.size();
  for (const StarburstOctave& octave : rings.octaves) {
    size += octave.rgb0.size() / 4 * 3 + octave.zone_of_bin.size();
    for (const SharpZone& zone : octave.zones) size += kZoneWords + zone.edge.size() + zone.rgb0.size() / 4 * 3;
  }
  for (const NearField::Octave& octave : rings.near->octaves())
    size += kNearWords + 3 * octave.edge.size() + kRowsOfOctave + kRowWords * octave.below.size();
  return size;
}

void append_pattern(const StarburstRings& rings, std::vector<std::uint32_t>& words) {
  Words to(words);
  const std::span<const NearField::Octave> near = rings.near->octaves();
  const std::uint32_t header = to.leave_out(kPatternHeader);
  const std::uint32_t far_at = to.leave_out(kFarWords * rings.octaves.size());
  const std::uint32_t near_at = to.leave_out(kNearWords * near.size());
  to.set_real(header, 1.0 / (rings.first_px * rings.first_px));
  to.set(header + 1, rings.octaves.size());
  to.set(header + 2, far_at);
  to.set(header + 3, near.size());
  to.set(header + 4, near_at);
  for (std::size_t o = 0; o < rings.octaves.size(); ++o)
    append_far(rings.octaves[o], far_at + static_cast<std::uint32_t>(kFarWords * o), to);
  for (std::size_t o = 0; o < near.size(); ++o)
    append_near(near[o], near_at + static_cast<std::uint32_t>(kNearWords * o), to);
}

}  // namespace contrejour::inline internal::vulkan
