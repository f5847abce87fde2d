// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/film_material.h"

#include <algorithm>
#include <cmath>

#include "optics/coating/film_tables.h"

namespace contrejour {
namespace {

const FilmTable* find_table(std::string_view name) {
  const auto tables = film_tables();
  const auto at = std::find_if(tables.begin(), tables.end(), [&](const FilmTable& t) { return t.name == name; });
  return at == tables.end() ? nullptr : &*at;
}

// Lagrange's cubic through the four samples nearest to a position; in the first and last intervals, through the four at
// that end.
double between(const std::array<double, FilmTable::kSamples>& samples, double position) {
  constexpr auto kLast = static_cast<double>(FilmTable::kSamples - 1);
  if (std::isnan(position)) return position;
  const double within = std::clamp(position, 0.0, kLast);
  const double first = std::clamp(std::floor(within) - 1.0, 0.0, kLast - 3.0);
  const auto s = samples.begin() + static_cast<std::ptrdiff_t>(first);
  const double t = within - first;
  return s[0] * (t - 1) * (t - 2) * (t - 3) / -6.0 + s[1] * t * (t - 2) * (t - 3) / 2.0 +
         s[2] * t * (t - 1) * (t - 3) / -2.0 + s[3] * t * (t - 1) * (t - 2) / 6.0;
}

}  // namespace

std::vector<FilmMaterialFacts> film_materials() {
  std::vector<FilmMaterialFacts> all;
  for (const FilmTable& table : film_tables()) all.push_back({table.name, table.source});
  return all;
}

bool is_film_material(std::string_view name) { return find_table(name) != nullptr; }

FilmMaterial film_material(std::string_view name) {
  FilmMaterial material;
  material.name = name;
  return material;
}

std::complex<double> index_at(const FilmMaterial& material, double lambda_nm) {
  if (material.name.empty()) return material.n;
  const FilmTable* const table = find_table(material.name);
  if (table == nullptr) return material.n;
  const double position = (lambda_nm - kFilmTableFirst_nm) / kFilmTableStep_nm;
  return {between(table->n, position), std::max(0.0, between(table->k, position))};
}

}  // namespace contrejour
