// SPDX-License-Identifier: Apache-2.0
// The lights of a document, in the order of its --light-at values. Positions are u, v: (0, 0) is the frame's top left
// corner, (1, 1) its bottom right one; a light may lie outside. Errors: InvalidArgument. Thread-safety: pure functions.
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/vec.h"
#include "studio/core/document.h"

namespace contrejour::studio {

// The texts are those of a light's value (docs/cli.md); empty: the common --value, --colour and so on.
struct LightEntry {
  Vec2 at{0.5, 0.5};
  std::string value, colour, size, distance;
  friend bool operator==(const LightEntry&, const LightEntry&) = default;
};

[[nodiscard]] std::vector<LightEntry> lights_of(const Document& document);
[[nodiscard]] Result<Document> with_lights(Document document, const std::vector<LightEntry>& lights);

// `index` counts from 0 and must exist.
[[nodiscard]] Result<Document> with_light_at(const Document& document, std::size_t index, Vec2 at);
[[nodiscard]] Result<Document> with_light(const Document& document, std::size_t index, const LightEntry& light);
[[nodiscard]] Result<Document> with_new_light(const Document& document, const LightEntry& light);
// Errors: the only light, because a picture without one would get the default light.
[[nodiscard]] Result<Document> without_light(const Document& document, std::size_t index);

}  // namespace contrejour::studio
