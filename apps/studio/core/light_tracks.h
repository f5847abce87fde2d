// SPDX-License-Identifier: Apache-2.0
// The lights of a document as those of its animation; parts of keys.h. Thread-safety: pure functions.
#pragma once

#include "studio/core/keys.h"

namespace contrejour::studio {

// One key at frame 0 (animation.h), which files write as a plain value.
[[nodiscard]] bool is_constant(const KeyedValue& value);
// In place of a key at its frame.
void insert_key(KeyedValue& value, const Key& key);

// Null where the light has the common option's value.
[[nodiscard]] KeyedValue* light_track(AnimatedLight& light, LightPart part);
void set_light_track(AnimatedLight& light, LightPart part, const KeyedValue& value);
// The light's value at hand. Errors: there is no such light; it has the common option's value.
[[nodiscard]] Result<Key> key_of_light(const Document& document, std::size_t light, LightPart part, int frame);

// All lights of the document as constants, where the animation has none yet.
[[nodiscard]] Document with_animated_lights(Document document);
[[nodiscard]] Document with_lights_at(Document document, double frame);
[[nodiscard]] Document with_light_edits(const Document& before, Document after, int frame);

}  // namespace contrejour::studio
