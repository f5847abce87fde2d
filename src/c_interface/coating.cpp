// SPDX-License-Identifier: Apache-2.0
// Coatings for C callers.
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "c_interface/boundary.h"
#include "c_interface/optics_objects.h"
#include "contrejour/expert/coated_glass.h"
#include "contrejour/expert/film_design.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour {
namespace {

const std::vector<std::string>& design_names() {
  static const std::vector<std::string> kNames = coating_design_names();
  return kNames;
}

cj_coating described(Coating coating) {
  std::string text = describe(coating);
  return {std::move(coating), std::move(text)};
}

Result<void> require_coated_glass(const cj_coating* coating, const cj_glass* glass) {
  if (const auto given = require(coating, "coating"); !given) return given;
  return require(glass, "glass");
}

// Writes value(wavelengths, angles) of the coated glass.
template <class Value>
cj_status by_wavelength_and_angle(const cj_coating* coating, const cj_glass* glass, const double* wavelengths_nm,
                                  const double* angles_rad, std::size_t count, double* values, cj_error* error,
                                  const Value& value) {
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require_coated_glass(coating, glass); !given) return given;
    if (count == 0) return {};
    if (const auto given = require(wavelengths_nm, "wavelengths_nm"); !given) return given;
    if (const auto given = require(angles_rad, "angles_rad"); !given) return given;
    if (const auto given = require(values, "the array for the results"); !given) return given;
    const auto found =
        value(coating->coating, glass->glass, std::span(wavelengths_nm, count), std::span(angles_rad, count));
    if (!found) return tl::unexpected(found.error());
    std::copy(found->begin(), found->end(), values);
    return {};
  });
}

const FilmStack* stack_of(const cj_coating* coating) {
  return coating != nullptr ? std::get_if<FilmStack>(&coating->coating.films) : nullptr;
}

}  // namespace
}  // namespace contrejour

using contrejour::Result;

cj_status cj_coating_read(const char* text, cj_coating** coating, cj_error* error) {
  return contrejour::guarded_create(coating, error, [&]() -> Result<cj_coating> {
    if (const auto given = contrejour::require(text, "text"); !given) return tl::unexpected(given.error());
    auto read = contrejour::params::parse_coating(text);
    if (!read) return tl::unexpected(read.error());
    return contrejour::described(std::move(*read));
  });
}

void cj_coating_destroy(cj_coating* coating) { delete coating; }

const char* cj_coating_description(const cj_coating* coating) {
  return coating != nullptr ? coating->description.c_str() : nullptr;
}

size_t cj_coating_design_count(void) {
  return contrejour::guarded_value(size_t{0}, [] { return contrejour::design_names().size(); });
}

const char* cj_coating_design_name(size_t index) {
  return contrejour::guarded_value<const char*>(nullptr,
                                                [&] { return contrejour::text_at(contrejour::design_names(), index); });
}

cj_status cj_coating_reflectances(const cj_coating* coating, const cj_glass* glass, const double* wavelengths_nm,
                                  const double* angles_rad, size_t count, double* reflectances, cj_error* error) {
  return contrejour::by_wavelength_and_angle(coating, glass, wavelengths_nm, angles_rad, count, reflectances, error,
                                             contrejour::coated_reflectances);
}

cj_status cj_coating_transmittances(const cj_coating* coating, const cj_glass* glass, const double* wavelengths_nm,
                                    const double* angles_rad, size_t count, double* transmittances, cj_error* error) {
  return contrejour::by_wavelength_and_angle(coating, glass, wavelengths_nm, angles_rad, count, transmittances, error,
                                             contrejour::coated_transmittances);
}

cj_status cj_coating_refine(const cj_coating* coating, const cj_glass* glass, const double* wavelengths_nm,
                            const double* targets, const double* weights, size_t count, cj_coating** refined,
                            cj_error* error) {
  using namespace contrejour;
  return guarded_create(refined, error, [&]() -> Result<cj_coating> {
    if (const auto given = require_coated_glass(coating, glass); !given) return tl::unexpected(given.error());
    if (const auto given = require(wavelengths_nm, "wavelengths_nm"); !given) return tl::unexpected(given.error());
    if (const auto given = require(targets, "targets"); !given) return tl::unexpected(given.error());
    const auto weight = weights != nullptr ? std::span(weights, count) : std::span<const double>();
    auto found = refined_to_targets(coating->coating, glass->glass, {wavelengths_nm, count}, {targets, count}, weight);
    if (!found) return tl::unexpected(found.error());
    return described({"", std::move(*found)});
  });
}

cj_status cj_coating_on_glass(const cj_coating* coating, const cj_glass* glass, cj_coating** films, cj_error* error) {
  using namespace contrejour;
  return guarded_create(films, error, [&]() -> Result<cj_coating> {
    if (const auto given = require_coated_glass(coating, glass); !given) return tl::unexpected(given.error());
    auto stack = films_on(coating->coating, glass->glass);
    if (!stack) return tl::unexpected(stack.error());
    return described({"", std::move(*stack)});
  });
}

size_t cj_coating_film_count(const cj_coating* coating) {
  const auto* stack = contrejour::stack_of(coating);
  return stack != nullptr ? stack->layers.size() : 0;
}

cj_status cj_coating_get_film(const cj_coating* coating, size_t index, cj_film* film, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    constexpr double kReference_nm = 550.0;
    if (const auto given = require(coating, "coating"); !given) return given;
    if (const auto good = check_struct(film, sizeof(cj_film), "cj_film"); !good) return good;
    const std::size_t count = cj_coating_film_count(coating);
    if (index >= count)
      return invalid_argument(
          fmt::format("there is no film {} of {}; cj_coating_on_glass() gives a design's films", index, count));
    const FilmLayer& layer = stack_of(coating)->layers[index];
    const auto n = index_at(layer.material, kReference_nm);
    cj_film ours{};
    ours.material = layer.material.name.c_str();
    ours.n = n.real();
    ours.k = n.imag();
    ours.thickness_nm = layer.thickness_nm;
    write_struct(ours, film);
    return {};
  });
}
