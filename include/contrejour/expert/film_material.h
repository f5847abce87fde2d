// SPDX-License-Identifier: Apache-2.0
// What films are made of: complex index by wavelength (docs/physics/coatings.md).
// Domain: 360 to 830 nm, where catalogued materials have samples every 10 nm; beyond it, the nearest sample holds.
// Accuracy: 1e-5 of their sources; real films of different makers differ by about 1e-2. Thread-safety: pure functions.
#pragma once

#include <complex>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/export.h"

namespace contrejour {

struct FilmMaterial {
  std::string name;              // one of film_materials(); empty: the index below, at every wavelength
  std::complex<double> n = 1.0;  // n + i k, absorbing for k > 0

  FilmMaterial() = default;
  FilmMaterial(double real, double imaginary = 0.0) : n(real, imaginary) {}
  FilmMaterial(std::complex<double> index) : n(index) {}
  friend bool operator==(const FilmMaterial&, const FilmMaterial&) = default;
};

// Names and sources of the catalogued: dielectrics from low index to high, then metals.
struct FilmMaterialFacts {
  std::string_view name, source;
};
[[nodiscard]] CONTREJOUR_API std::vector<FilmMaterialFacts> film_materials();
[[nodiscard]] CONTREJOUR_API bool is_film_material(std::string_view name);

[[nodiscard]] CONTREJOUR_API FilmMaterial film_material(std::string_view name);  // one of those
[[nodiscard]] CONTREJOUR_API std::complex<double> index_at(const FilmMaterial& material, double lambda_nm);

}  // namespace contrejour
