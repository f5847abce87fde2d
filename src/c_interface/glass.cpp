// SPDX-License-Identifier: Apache-2.0
// Glasses for C callers.
#include <span>
#include <string>
#include <vector>

#include "c_interface/boundary.h"
#include "c_interface/optics_objects.h"
#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/expert/glass_text.h"

namespace contrejour {
namespace {

const std::vector<std::string>& glass_names() {
  static const std::vector<std::string> kNames = [] {
    const GlassCatalogue& glasses = bundled_glasses();
    std::vector<std::string> names;
    for (std::size_t k = 0; k < glasses.size(); ++k) {
      const GlassSummary summary = glasses.summary(k);
      names.push_back(summary.maker + " " + summary.name);
    }
    return names;
  }();
  return kNames;
}

cj_glass_info info_of(const Glass& glass) {
  const GlassFigures figures = glass_figures(glass);
  cj_glass_info info{};
  info.name = glass.name.c_str();
  info.n_d = figures.n_d;
  info.v_d = figures.v_d;
  info.v_e = figures.v_e;
  info.p_gf = figures.p_gf;
  info.d_pgf = figures.d_pgf;
  if (const auto range = wavelength_range_nm(glass)) {
    info.first_nm = range->first_nm;
    info.last_nm = range->last_nm;
  }
  return info;
}

// Writes value(wavelength) for each wavelength.
template <class Value>
cj_status by_wavelength(const cj_glass* glass, const double* wavelengths_nm, std::size_t count, double* values,
                        cj_error* error, const Value& value) {
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(glass, "glass"); !given) return given;
    if (count == 0) return {};
    if (const auto given = require(wavelengths_nm, "wavelengths_nm"); !given) return given;
    if (const auto given = require(values, "the array for the results"); !given) return given;
    for (std::size_t k = 0; k < count; ++k)
      if (!is_wavelength(wavelengths_nm[k])) return invalid_argument("a wavelength is out of range; give nm, as 550");
    for (std::size_t k = 0; k < count; ++k) values[k] = value(wavelengths_nm[k]);
    return {};
  });
}

}  // namespace
}  // namespace contrejour

using contrejour::Result;

size_t cj_bundled_glass_count(void) {
  return contrejour::guarded_value(size_t{0}, [] { return contrejour::glass_names().size(); });
}

const char* cj_bundled_glass_name(size_t index) {
  return contrejour::guarded_value<const char*>(nullptr,
                                                [&] { return contrejour::text_at(contrejour::glass_names(), index); });
}

cj_status cj_glass_find(const char* text, cj_glass** glass, cj_error* error) {
  return contrejour::guarded_create(glass, error, [&]() -> Result<cj_glass> {
    if (const auto given = contrejour::require(text, "text"); !given) return tl::unexpected(given.error());
    auto found = contrejour::params::parse_glass(text);
    if (!found) return tl::unexpected(found.error());
    return cj_glass{std::move(*found)};
  });
}

void cj_glass_destroy(cj_glass* glass) { delete glass; }

cj_status cj_glass_get_info(const cj_glass* glass, cj_glass_info* info, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(glass, "glass"); !given) return given;
    if (const auto good = check_struct(info, sizeof(cj_glass_info), "cj_glass_info"); !good) return good;
    write_struct(info_of(glass->glass), info);
    return {};
  });
}

cj_status cj_glass_indices(const cj_glass* glass, const double* wavelengths_nm, size_t count, double* indices,
                           cj_error* error) {
  return contrejour::by_wavelength(glass, wavelengths_nm, count, indices, error, [&](double lambda_nm) {
    return contrejour::refractive_index(glass->glass, lambda_nm);
  });
}

cj_status cj_glass_transmittances(const cj_glass* glass, double path_mm, const double* wavelengths_nm, size_t count,
                                  double* transmittances, cj_error* error) {
  return contrejour::by_wavelength(glass, wavelengths_nm, count, transmittances, error, [&](double lambda_nm) {
    return contrejour::internal_transmittance(glass->glass, lambda_nm, path_mm);
  });
}
