// SPDX-License-Identifier: Apache-2.0
#include "studio/core/keys.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "studio/core/light_tracks.h"

namespace contrejour::studio {
namespace {

using NamedValue = std::pair<std::string, KeyedValue>;

NamedValue* parameter_track(Animation& animation, const std::string& name) {
  const auto found = std::find_if(animation.parameters.begin(), animation.parameters.end(),
                                  [&](const NamedValue& p) { return p.first == name; });
  return found != animation.parameters.end() ? &*found : nullptr;
}

KeyedValue* track(Animation& animation, const TrackId& id) {
  if (id.parameter.empty())
    return id.light < animation.lights.size() ? light_track(animation.lights[id.light], id.part) : nullptr;
  NamedValue* found = parameter_track(animation, id.parameter);
  return found != nullptr ? &found->second : nullptr;
}

Key key_of_text(const params::Parameter& p, const std::string& text, int frame) {
  const auto number = params::parse_real(text);
  const bool is_number =
      (p.kind == params::Kind::Real || p.kind == params::Kind::Integer || p.name == "error") && number;
  return is_number ? Key{frame, {*number}, {}} : Key{frame, {}, text};
}

Result<Key> key_at_hand(const Document& document, const TrackId& id, int frame) {
  if (id.parameter.empty()) return key_of_light(document, id.light, id.part, frame);
  const params::Parameter& p = params::parameter(id.parameter);
  if (!may_have_keys(p)) return invalid_argument(fmt::format("{} is the same in all frames", id.parameter));
  const std::string text = document.text(id.parameter);
  if (text.empty()) return invalid_argument(fmt::format("set {} first; then it can have keys", id.parameter));
  return key_of_text(p, text, frame);
}

Interpolation usual_interpolation(const Key& key) {
  return key.numbers.empty() ? Interpolation::Step : Interpolation::Smooth;
}

Result<Document> begin_track(Document document, const TrackId& id, const Key& key) {
  const KeyedValue value{{key}, usual_interpolation(key)};
  if (id.parameter.empty()) {
    document = with_animated_lights(std::move(document));
    set_light_track(document.animation.lights.at(id.light), id.part, value);
  } else {
    document.animation.parameters.emplace_back(id.parameter, value);
    std::sort(document.animation.parameters.begin(), document.animation.parameters.end(),
              [](const NamedValue& a, const NamedValue& b) { return a.first < b.first; });
  }
  return document;
}

// The change of a value with keys, at the frame; a constant changes as it is.
void follow(KeyedValue& value, const Key& key) {
  if (is_constant(value)) {
    value.keys.front().numbers = key.numbers;
    value.keys.front().text = key.text;
  } else {
    insert_key(value, key);
  }
}

void follow_parameters(const Document& before, Document& after, int frame) {
  std::erase_if(after.animation.parameters, [&](NamedValue& p) {
    const std::string text = after.text(p.first);
    if (text == before.text(p.first)) return false;
    if (text.empty()) return true;
    const Key key = key_of_text(params::parameter(p.first), text, frame);
    // A text among numbers begins anew: a value such as "auto" has no frames between.
    if (key.numbers.size() != p.second.keys.front().numbers.size()) p.second = {{key}, usual_interpolation(key)};
    follow(p.second, key);
    return false;
  });
}

}  // namespace

const char* name_of(LightPart part) {
  static constexpr const char* names[] = {"position", "value", "colour", "size", "distance"};
  return names[static_cast<std::size_t>(part)];
}

std::vector<Track> tracks_of(const Document& document) {
  std::vector<Track> tracks;
  for (const auto& [name, value] : document.animation.parameters)
    if (!is_constant(value)) tracks.push_back({{name, 0, {}}, name, value});
  Animation animation = document.animation;
  for (std::size_t k = 0; k < animation.lights.size(); ++k)
    for (int part = 0; part < kLightParts; ++part) {
      const TrackId id{"", k, static_cast<LightPart>(part)};
      const KeyedValue* value = track(animation, id);
      if (value != nullptr && !is_constant(*value))
        tracks.push_back({id, fmt::format("light {} {}", k + 1, name_of(id.part)), *value});
    }
  return tracks;
}

const KeyedValue* keys_of(const Document& document, const TrackId& id) {
  const KeyedValue* value = track(const_cast<Animation&>(document.animation), id);  // not changed here
  return value != nullptr && !is_constant(*value) ? value : nullptr;
}

bool has_keys(const Document& document) { return !tracks_of(document).empty(); }

std::optional<std::pair<int, int>> range_of_keys(const Document& document) {
  std::optional<std::pair<int, int>> range;
  for (const Track& t : tracks_of(document)) {
    const int first = t.value.keys.front().frame, last = t.value.keys.back().frame;
    range = range ? std::pair(std::min(range->first, first), std::max(range->second, last)) : std::pair(first, last);
  }
  return range;
}

bool may_have_keys(const params::Parameter& p) {
  const bool is_of_all_frames = p.name == "size" || p.name == "method" || p.name == "device" || p.name == "threads";
  return !p.repeats && !is_of_all_frames;
}

Result<Document> with_key(Document document, const TrackId& id, int frame) {
  const auto key = key_at_hand(document, id, frame);
  if (!key) return tl::unexpected(key.error());
  KeyedValue* value = track(document.animation, id);
  if (value == nullptr) return begin_track(std::move(document), id, *key);
  if (is_constant(*value))
    *value = {{*key}, usual_interpolation(*key)};
  else
    insert_key(*value, *key);
  return document;
}

Result<Document> without_key(Document document, const TrackId& id, int frame) {
  KeyedValue* value = track(document.animation, id);
  if (value == nullptr) return invalid_argument("this has no keys");
  if (value->keys.size() == 1) return without_track(std::move(document), id);
  std::erase_if(value->keys, [&](const Key& key) { return key.frame == frame; });
  return document;
}

Result<Document> with_key_moved(Document document, const TrackId& id, int from, int to) {
  KeyedValue* value = track(document.animation, id);
  const auto at = [&](int frame) {
    return std::find_if(value->keys.begin(), value->keys.end(), [&](const Key& key) { return key.frame == frame; });
  };
  if (value == nullptr || at(from) == value->keys.end()) return invalid_argument("there is no such key");
  if (from == to) return document;
  if (at(to) != value->keys.end()) return invalid_argument(fmt::format("frame {} has a key already", to));
  at(from)->frame = to;
  std::sort(value->keys.begin(), value->keys.end(), [](const Key& a, const Key& b) { return a.frame < b.frame; });
  return document;
}

Result<Document> with_interpolation(Document document, const TrackId& id, Interpolation between) {
  KeyedValue* value = track(document.animation, id);
  if (value == nullptr) return invalid_argument("this has no keys");
  value->between = value->keys.front().numbers.empty() ? Interpolation::Step : between;
  return document;
}

Result<Document> without_track(Document document, const TrackId& id) {
  if (id.parameter.empty()) {
    if (id.light >= document.animation.lights.size()) return invalid_argument("this has no keys");
    const auto constant = key_of_light(document, id.light, id.part, 0);
    if (constant) set_light_track(document.animation.lights[id.light], id.part, {{*constant}, Interpolation::Linear});
    if (tracks_of(document).empty()) document.animation.lights.clear();
    return document;
  }
  std::erase_if(document.animation.parameters, [&](const NamedValue& p) { return p.first == id.parameter; });
  return document;
}

Document at_frame(Document document, double frame) {
  const params::Values values = parameters_at(document.animation, frame);
  for (const auto& [name, value] : document.animation.parameters) document.texts[name] = values.list(name);
  return with_lights_at(std::move(document), frame);
}

Document with_keys_of_edit(const Document& before, Document after, int frame) {
  if (!(after.animation == before.animation)) return after;  // an edit of the keys themselves
  follow_parameters(before, after, frame);
  return with_light_edits(before, std::move(after), frame);
}

}  // namespace contrejour::studio
