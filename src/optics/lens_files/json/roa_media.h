// SPDX-License-Identifier: Apache-2.0
// Glasses in ray-optics' files.
#pragma once

#include "contrejour/expert/glass.h"
#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/json/json_fields.h"

namespace contrejour::inline internal {

// A Python object in JSON: its class and its content. Any other value is its own content, without a class.
[[nodiscard]] std::string class_of(const JsonField& object);
[[nodiscard]] JsonField content_of(const JsonField& object);

// Reads a medium of opticalglass: air, a catalogue's glass by maker and name (with the file's own coefficients if our
// catalogue has no such glass, or one with another index), a model glass, a constant index, a table. Anything else is
// an error and gives air.
[[nodiscard]] Glass roa_glass(const JsonField& medium, GlassFinder& finder);

}  // namespace contrejour::inline internal
