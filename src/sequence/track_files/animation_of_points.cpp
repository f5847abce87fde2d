// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/track_files.h"
#include "sequence/track_files/value_keys.h"

namespace contrejour {
namespace {

// On in the frames that have a key, off in all others.
KeyedValue on_where_sampled(const PointTrack& track) {
  KeyedValue on;
  const auto add = [&](int frame, const char* text) { on.keys.push_back({frame, {}, text}); };
  add(track.keys.front().frame - 1, "off");
  for (std::size_t k = 0; k < track.keys.size(); ++k) {
    const int frame = track.keys[k].frame;
    if (k == 0 || track.keys[k - 1].frame != frame - 1) add(frame, "on");
    if (k + 1 == track.keys.size() || track.keys[k + 1].frame != frame + 1) add(frame + 1, "off");
  }
  return on;
}

AnimatedLight light_of(const PointTrack& track, const std::optional<KeyedValue>& value) {
  AnimatedLight light;
  light.name = track.name;
  for (const TrackKey& key : track.keys) light.position.keys.push_back({key.frame, {key.uv.x, key.uv.y}, {}});
  light.value = value;
  if (track.is_sampled) light.on = on_where_sampled(track);
  return light;
}

}  // namespace

inline namespace internal {

Result<std::optional<KeyedValue>> value_of_text(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto value = params::parse_light_value(text);
  if (!value) return tl::unexpected(value.error());
  Key key{0, {}, text};
  if (value->unit == params::LightValue::Unit::Sum) {
    key.text.clear();
    key.numbers = {value->rgb[0]};
    if (value->per_channel) key.numbers = {value->rgb[0], value->rgb[1], value->rgb[2]};
  }
  return KeyedValue{{key}, Interpolation::Linear};
}

}  // namespace internal

Result<Animation> animation_of_points(std::span<const PointTrack> tracks, const std::string& value) {
  const auto common = value_of_text(value);
  if (!common) return tl::unexpected(common.error());
  Animation animation;
  for (const PointTrack& track : tracks) animation.lights.push_back(light_of(track, *common));
  return animation;
}

}  // namespace contrejour
