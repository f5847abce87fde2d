// Glasses as ray-optics' files hold them.
#pragma once

#include "contrejour/glass.h"
#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/json/json_fields.h"

namespace contrejour {

// A python object in JSON: its class and what it holds. Anything else is its own content, without a class.
[[nodiscard]] std::string class_of(const JsonField& object);
[[nodiscard]] JsonField content_of(const JsonField& object);

// One of opticalglass: air, a catalogue's glass by maker and name (the file's own coefficients where ours has none, or
// one of another index), a model glass, a constant index, a table. What is none is an error, and air.
[[nodiscard]] Glass roa_glass(const JsonField& medium, GlassFinder& finder);

}  // namespace contrejour
