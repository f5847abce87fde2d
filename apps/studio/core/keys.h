// SPDX-License-Identifier: Apache-2.0
// Keys of a document's values over the frames of a shot, as those of a lights file (contrejour/expert/animation.h). The
// document's values are those of the frame at hand, so that panels need not know of keys: what has keys gets one at
// that frame when it is edited. A document with keys of a light has all its lights in the animation, those without keys
// as constants. Errors: InvalidArgument. Thread-safety: pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studio/core/document.h"

namespace contrejour::studio {

enum class LightPart { Position, Value, Colour, Size, Distance };
inline constexpr int kLightParts = 5;
[[nodiscard]] const char* name_of(LightPart part);

// Something that has keys: a parameter by its name, or a property of a light.
struct TrackId {
  std::string parameter;  // empty: of a light
  std::size_t light = 0;
  LightPart part = LightPart::Position;
  friend bool operator==(const TrackId&, const TrackId&) = default;
};

struct Track {
  TrackId id;
  std::string label;  // "fnumber", "light 1 position"
  KeyedValue value;
};

// Everything that has keys: parameters by name, then lights. Constants are left out.
[[nodiscard]] std::vector<Track> tracks_of(const Document& document);
[[nodiscard]] const KeyedValue* keys_of(const Document& document, const TrackId& id);
[[nodiscard]] bool has_keys(const Document& document);
// The first and the last frame that have a key.
[[nodiscard]] std::optional<std::pair<int, int>> range_of_keys(const Document& document);

// Whether the value may have keys: numbers and choices of one value, but not size, method, device and threads.
[[nodiscard]] bool may_have_keys(const params::Parameter& parameter);

// A key at the frame with the value at hand; the first one begins the track, smooth for numbers. Errors: a value that
// the lens or the picture gives and that nobody has set; a parameter that may not have keys.
[[nodiscard]] Result<Document> with_key(Document document, const TrackId& id, int frame);
// Without the last key the value stays as it is.
[[nodiscard]] Result<Document> without_key(Document document, const TrackId& id, int frame);
// Errors: there is a key at `to` already.
[[nodiscard]] Result<Document> with_key_moved(Document document, const TrackId& id, int from, int to);
[[nodiscard]] Result<Document> with_interpolation(Document document, const TrackId& id, Interpolation between);
[[nodiscard]] Result<Document> without_track(Document document, const TrackId& id);

// The values of that frame. Lights that are off there have no value.
[[nodiscard]] Document at_frame(Document document, double frame);

// After an edit at a frame: its changes become keys where there are keys, and lights are those of the document.
[[nodiscard]] Document with_keys_of_edit(const Document& before, Document after, int frame);

}  // namespace contrejour::studio
