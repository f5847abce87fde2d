// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/toml/toml_media.h"

#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/near_name.h"
#include "contrejour/expert/film_design.h"
#include "optics/lens/validate.h"
#include "optics/lens_files/toml/toml_formula.h"
#include "optics/lens_files/toml/toml_values.h"

namespace contrejour::inline internal {

namespace {

// glass_problem() and coating_problem() check plausibility; here any finite number is accepted.

std::array<double, 3> read_triple(TomlFields& fields, std::string_view key, bool& ok) {
  std::array<double, 3> values{};
  const toml::array* list = fields.array(key);
  if (list == nullptr || list->size() != 3) {
    fields.fail_here(fmt::format("{} must be a list of three numbers", key));
    ok = false;
    return values;
  }
  for (std::size_t i = 0; i < 3; ++i) values[i] = fields.number_at((*list)[i], key, kFinite);
  return values;
}

// Reads {n}, {n_d, v_d}, {sellmeier_b, sellmeier_c_um2} or {formula, coefficients}, according to the keys.
Glass read_glass_keys(const toml::table& table, std::string name, const std::string& what, TomlErrors& errors) {
  if (table.contains("formula")) return read_formula_keys(table, std::move(name), what, errors);
  TomlFields fields(table, what, {"name", "n", "n_d", "v_d", "d_pgf", "sellmeier_b", "sellmeier_c_um2"}, errors);
  const bool constant = fields.has("n");
  const bool abbe = fields.has("n_d") || fields.has("v_d") || fields.has("d_pgf");
  const bool sellmeier = fields.has("sellmeier_b") || fields.has("sellmeier_c_um2");
  Glass glass{fields.text("name").value_or(std::move(name)), {}};
  if (int{constant} + int{abbe} + int{sellmeier} != 1) {
    fields.fail_here("give a glass either n_d and v_d, or n alone, or sellmeier_b and sellmeier_c_um2, or a formula");
    return glass;
  }
  bool ok = true;
  if (constant) {
    glass.dispersion = ConstantIndex{fields.required_number("n", kFinite, "")};
  } else if (abbe) {
    const double n_d = fields.required_number("n_d", kFinite, "give the index at 587.56 nm");
    const double v_d = fields.required_number("v_d", kFinite, "give the Abbe number, or n alone");
    const auto d_pgf = fields.number("d_pgf", kFinite);
    if (d_pgf) {
      glass.dispersion = ModelGlass{n_d, v_d, *d_pgf};
    } else {
      glass.dispersion = AbbeGlass{n_d, v_d};
    }
  } else {
    Sellmeier coefficients;
    coefficients.b = read_triple(fields, "sellmeier_b", ok);
    coefficients.c_um2 = read_triple(fields, "sellmeier_c_um2", ok);
    glass.dispersion = coefficients;
  }
  if (errors.failed() || !ok) return glass;
  if (const auto problem = glass_problem(glass)) fields.fail_here(*problem);
  return glass;
}

// { n, k } or { material }; { thickness_nm } or { waves, at_nm }, of the light within the film.
FilmLayer read_film(TomlFields& film, TomlErrors& errors) {
  FilmLayer layer;
  if (const auto name = film.text("material")) {
    layer.material = film_material(*name);
    if (film.has("n") || film.has("k")) film.fail_here("give a film either a material or n and k");
    if (!is_film_material(*name)) film.fail_here(*coating_problem({"", FilmStack{{layer}}}));
  } else {
    const double n = film.required_number("n", kFinite, "give the film's index or its material");
    layer.material = FilmMaterial(n, film.number("k", kFinite).value_or(0.0));
  }
  if (errors.failed() || !film.has("waves")) {
    if (film.has("at_nm")) film.fail_here("at_nm belongs to a thickness in waves; give waves");
    layer.thickness_nm = film.required_number("thickness_nm", kFinite, "give the film's thickness, or waves");
    return layer;
  }
  if (film.has("thickness_nm")) film.fail_here("give a film either thickness_nm or waves");
  const double at_nm = film.number("at_nm", kFinite).value_or(QuarterWave{}.lambda0_nm);
  const double n = index_at(layer.material, at_nm).real();
  layer.thickness_nm = n > 0.0 ? *film.number("waves", kFinite) * at_nm / n : -1.0;
  return layer;
}

std::vector<double> read_numbers(TomlFields& fields, std::string_view key) {
  std::vector<double> values;
  const toml::array* list = fields.array(key);
  if (list == nullptr) {
    fields.fail_here(fmt::format("{} is missing; give a list of numbers", key));
    return values;
  }
  for (const toml::node& node : *list) values.push_back(fields.number_at(node, key, kFinite));
  return values;
}

std::vector<FilmLayer> read_layers(TomlFields& fields, TomlErrors& errors) {
  std::vector<FilmLayer> layers;
  const toml::array* list = fields.array("layers");
  if (list == nullptr) return layers;
  for (const toml::node& node : *list) {
    const std::string what = fmt::format("{}, film {}", fields.what(), layers.size() + 1);
    const toml::table* row = node.as_table();
    if (row == nullptr) {
      errors.fail(node, what + ": write a film as { n = 1.38, thickness_nm = 99.6 }");
      return layers;
    }
    TomlFields film(*row, what, {"material", "n", "k", "thickness_nm", "waves", "at_nm"}, errors);
    layers.push_back(read_film(film, errors));
    if (errors.failed()) return layers;
  }
  return layers;
}

// Reads {quarter_wave_nm, n}, {hullin_nm, n}, {layers}, {design, design_nm} or {measured_nm, measured_deg,
// reflectance}.
Coating read_coating_keys(const toml::table& table, std::string name, const std::string& what, TomlErrors& errors) {
  TomlFields fields(table, what,
                    {"name", "quarter_wave_nm", "hullin_nm", "n", "layers", "design", "design_nm", "measured_nm",
                     "measured_deg", "reflectance"},
                    errors);
  Coating coating{fields.text("name").value_or(std::move(name)), {}};
  const bool quarter = fields.has("quarter_wave_nm");
  const bool hullin = fields.has("hullin_nm");
  const bool stack = fields.has("layers");
  const bool design = fields.has("design");
  const bool measured = fields.has("measured_nm");
  const bool more = fields.has("n") ? !(quarter || hullin) : false;
  const bool others =
      (fields.has("design_nm") && !design) || ((fields.has("measured_deg") || fields.has("reflectance")) && !measured);
  if (int{quarter} + int{hullin} + int{stack} + int{design} + int{measured} != 1 || more || others) {
    fields.fail_here(
        "give a coating one of quarter_wave_nm (and n), layers, design (and design_nm), measured_nm with "
        "measured_deg and reflectance, or hullin_nm (and n)");
    return coating;
  }
  const double n = fields.number("n", kFinite).value_or(QuarterWave{}.n);
  if (quarter) coating.films = QuarterWave{n, *fields.number("quarter_wave_nm", kFinite)};
  if (hullin) coating.films = HullinFresnelAR{n, *fields.number("hullin_nm", kFinite)};
  if (stack) coating.films = FilmStack{read_layers(fields, errors)};
  if (design) {
    const std::string wanted = fields.text("design").value_or("");
    const auto found = find_coating_design(wanted);
    if (!found)
      fields.fail_here(fmt::format("no design is called '{}'; give one of {}", shortened(wanted),
                                   fmt::join(coating_design_names(), ", ")));
    coating.films = found.value_or(DesignedCoating{});
    std::get<DesignedCoating>(coating.films).lambda0_nm =
        fields.number("design_nm", kFinite).value_or(DesignedCoating{}.lambda0_nm);
  }
  if (measured) {
    coating.films = MeasuredCoating{read_numbers(fields, "measured_nm"), read_numbers(fields, "measured_deg"),
                                    read_numbers(fields, "reflectance")};
  }
  if (errors.failed()) return coating;
  if (const auto problem = coating_problem(coating)) fields.fail_here(*problem);
  return coating;
}

template <class Medium, class Read>
MediumTable<Medium> read_medium_table(const toml::table& lens, std::string_view key, Read read, TomlErrors& errors) {
  MediumTable<Medium> media;
  const toml::node* node = lens.get(key);
  if (node == nullptr) return media;
  if (!node->is_table()) {
    errors.fail(*node, fmt::format("{0} must be a table; write [{0}] and one line a name", key));
    return media;
  }
  for (const auto& [name, entry] : *node->as_table()) {
    const std::string what = fmt::format("{} '{}'", key, shortened(name.str()));
    if (is_reserved_name(name.str()) || name.str().empty()) {
      errors.fail(name.source(), fmt::format("{}: this name has a meaning already; choose another", what));
      return media;
    }
    if (!entry.is_table()) {
      errors.fail(entry, fmt::format("{} must be a table in braces", what));
      return media;
    }
    media[std::string(name.str())] = {read(*entry.as_table(), std::string(name.str()), what, errors), &entry};
    if (errors.failed()) return media;
  }
  return media;
}

// The table's entry of that name, or null.
template <class Medium>
const Medium* look_up(std::string_view name, MediumTable<Medium>& table) {
  const auto found = table.find(name);
  if (found == table.end()) return nullptr;
  found->second.used = true;
  return &found->second.value;
}

// An error that names the nearest of the table.
template <class Medium>
void fail_unknown(const toml::node& node, std::string_view name, const std::string& what, std::string_view kind,
                  const MediumTable<Medium>& table, TomlErrors& errors) {
  std::vector<std::string_view> names;
  for (const auto& entry : table) names.push_back(entry.first);
  const std::string near = nearest_name(name, names);
  const std::string remedy =
      near.empty() ? fmt::format("add it under [{}]", kind) : fmt::format("did you mean '{}'?", shortened(near));
  errors.fail(node, fmt::format("{}: no {} is called '{}'; {}", what, kind, shortened(name), remedy));
}

// Reads a catalogue's glass. For an unknown name the error suggests a similar one of the table, or else the catalogue's
// nearest.
Glass read_catalogue_glass(const toml::node& node, const std::string& name, const std::string& what,
                           const MediumTable<Glass>& table, GlassFinder& finder, TomlErrors& errors) {
  auto found = finder.find(name);
  if (found) {
    if (const auto problem = glass_problem(*found)) {
      errors.fail(node, fmt::format("{}, glass '{}': {}", what, shortened(name), *problem));
    }
    return std::move(*found);
  }
  std::vector<std::string_view> names;
  for (const auto& entry : table) names.push_back(entry.first);
  if (nearest_name(name, names).empty()) {
    errors.fail(node, fmt::format("{}: {}; or add it under [glass]", what, found.error().message));
  } else {
    fail_unknown(node, name, what, "glass", table, errors);
  }
  return air();
}

template <class Medium>
void refuse_unused_of(const MediumTable<Medium>& table, std::string_view kind, TomlErrors& errors) {
  for (const auto& [name, entry] : table) {
    if (entry.used) continue;
    errors.fail(*entry.where, fmt::format("{} '{}' is used by no surface; remove it, or check the names in "
                                          "the surfaces",
                                          kind, shortened(name)));
  }
}

}  // namespace

MediumTable<Glass> read_glass_table(const toml::table& lens, TomlErrors& errors) {
  return read_medium_table<Glass>(lens, "glass", read_glass_keys, errors);
}

MediumTable<Coating> read_coating_table(const toml::table& lens, TomlErrors& errors) {
  return read_medium_table<Coating>(lens, "coating", read_coating_keys, errors);
}

Glass read_glass(const toml::node& node, const std::string& what, MediumTable<Glass>& table, GlassFinder& finder,
                 TomlErrors& errors) {
  if (const toml::table* keys = node.as_table()) return read_glass_keys(*keys, "", what + ", glass", errors);
  const auto* name = node.as_string();
  if (name == nullptr) {
    errors.fail(node, what + ": glass must be a name in quotes or { n_d = ..., v_d = ... }");
    return air();
  }
  if (name->get() == "air") return air();
  if (const Glass* found = look_up(name->get(), table)) return *found;
  return read_catalogue_glass(node, name->get(), what, table, finder, errors);
}

Coating read_coating(const toml::node& node, const std::string& what, MediumTable<Coating>& table, TomlErrors& errors) {
  if (const toml::table* keys = node.as_table()) {
    return read_coating_keys(*keys, "", what + ", coating", errors);
  }
  const auto* name = node.as_string();
  if (name == nullptr) {
    errors.fail(node, what + ": coating must be a name in quotes or { quarter_wave_nm = ... }");
    return {};
  }
  if (name->get() == "none") return {};
  if (name->get() == "quarter-wave") return {"", QuarterWave{}};
  if (const auto design = find_coating_design(name->get())) return {"", *design};
  if (const Coating* found = look_up(name->get(), table)) return *found;
  fail_unknown(node, name->get(), what, "coating", table, errors);
  return {};
}

void refuse_unused(const MediumTable<Glass>& glasses, const MediumTable<Coating>& coatings, TomlErrors& errors) {
  refuse_unused_of(glasses, "glass", errors);
  refuse_unused_of(coatings, "coating", errors);
}

}  // namespace contrejour::inline internal
