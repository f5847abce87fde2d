// Glasses and coatings of the lens format: named tables at the end of a file, or inline in a surface's row.
#pragma once

#include <map>
#include <string>

#include "base/toml_fields.h"
#include "contrejour/coating.h"
#include "contrejour/glass.h"
#include "optics/lens_files/glass_finder.h"

namespace contrejour {

// A named glass or coating, and where it was written: a name that nothing uses is an error.
template <class Medium>
struct NamedMedium {
  Medium value;
  const toml::node* where = nullptr;
  bool used = false;
};

template <class Medium>
using MediumTable = std::map<std::string, NamedMedium<Medium>, std::less<>>;

// From [glass] and [coating] of the whole file; absent is empty.
MediumTable<Glass> read_glass_table(const toml::table& lens, TomlErrors& errors);
MediumTable<Coating> read_coating_table(const toml::table& lens, TomlErrors& errors);

// From the value of a row's `glass` or `coating`; what: how errors call it, e.g. "surface 3". A name that is not in the
// table is a catalogue's.
Glass read_glass(const toml::node& node, const std::string& what, MediumTable<Glass>& table, GlassFinder& finder,
                 TomlErrors& errors);
Coating read_coating(const toml::node& node, const std::string& what, MediumTable<Coating>& table, TomlErrors& errors);

void refuse_unused(const MediumTable<Glass>& glasses, const MediumTable<Coating>& coatings, TomlErrors& errors);

}  // namespace contrejour
