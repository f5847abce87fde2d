// SPDX-License-Identifier: Apache-2.0
// Glasses and coatings of the lens format: named tables at the end of a file, or inline in a surface's row.
#pragma once

#include <map>
#include <string>

#include "base/toml_fields.h"
#include "contrejour/expert/coating.h"
#include "contrejour/expert/glass.h"
#include "optics/lens_files/glass_finder.h"

namespace contrejour::inline internal {

// A named glass or coating, and its position in the file: a name that is not used is an error.
template <class Medium>
struct NamedMedium {
  Medium value;
  const toml::node* where = nullptr;
  bool used = false;
};

template <class Medium>
using MediumTable = std::map<std::string, NamedMedium<Medium>, std::less<>>;

// Read [glass] and [coating] of the whole file; empty if absent.
MediumTable<Glass> read_glass_table(const toml::table& lens, TomlErrors& errors);
MediumTable<Coating> read_coating_table(const toml::table& lens, TomlErrors& errors);

// Read the value of a row's `glass` or `coating`; what: its name in errors, e.g. "surface 3". A name that is not in the
// table refers to a catalogue.
Glass read_glass(const toml::node& node, const std::string& what, MediumTable<Glass>& table, GlassFinder& finder,
                 TomlErrors& errors);
Coating read_coating(const toml::node& node, const std::string& what, MediumTable<Coating>& table, TomlErrors& errors);

void refuse_unused(const MediumTable<Glass>& glasses, const MediumTable<Coating>& coatings, TomlErrors& errors);

}  // namespace contrejour::inline internal
