// SPDX-License-Identifier: Apache-2.0
// Lenses changed and written, and their third-order aberrations, for C callers.
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "c_interface/boundary.h"
#include "c_interface/optics_objects.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/glass_text.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/seidel.h"
#include "contrejour/expert/write_lens.h"

namespace contrejour {
namespace {

Result<void> set_texts(const cj_surface_change& change, Surface& surface) {
  if ((change.what & CJ_CHANGE_GLASS) != 0) {
    if (const auto given = require(change.glass_behind, "glass_behind"); !given) return given;
    auto glass = params::parse_glass(change.glass_behind);
    if (!glass) return tl::unexpected(glass.error());
    surface.glass_after = std::move(*glass);
  }
  if ((change.what & CJ_CHANGE_COATING) != 0) {
    if (const auto given = require(change.coating, "coating"); !given) return given;
    auto coating = params::parse_coating(change.coating);
    if (!coating) return tl::unexpected(coating.error());
    surface.coating = std::move(*coating);
  }
  return {};
}

Result<Prescription> changed_lens(const Prescription& lens, std::size_t index, const cj_surface_change& change) {
  if (index >= lens.surfaces.size())
    return invalid_argument(
        fmt::format("the lens has {} surfaces, counted from 0; {} is none of them", lens.surfaces.size(), index));
  Prescription changed = lens;
  Surface& surface = changed.surfaces[index];
  if ((change.what & CJ_CHANGE_CURVATURE) != 0) surface.curvature_per_mm = change.curvature_per_mm;
  if ((change.what & CJ_CHANGE_THICKNESS) != 0) surface.thickness_mm = change.thickness_mm;
  if ((change.what & CJ_CHANGE_SEMI_DIAMETER) != 0) surface.semi_diameter_mm = change.semi_diameter_mm;
  if (auto set = set_texts(change, surface); !set) return tl::unexpected(set.error());
  if (auto valid = validate(changed); !valid) return tl::unexpected(valid.error());
  return changed;
}

Result<cj_text> text_of(Result<WrittenLens> written) {
  if (!written) return tl::unexpected(written.error());
  return cj_text{std::move(written->text), std::move(written->losses)};
}

cj_seidel sums_of(const SeidelSums& given) {
  cj_seidel ours{};
  ours.spherical = given.spherical;
  ours.coma = given.coma;
  ours.astigmatism = given.astigmatism;
  ours.petzval = given.petzval;
  ours.distortion = given.distortion;
  ours.axial_colour = given.axial_colour;
  ours.lateral_colour = given.lateral_colour;
  return ours;
}

Result<SeidelSums> seidel_of(const LensState& lens, double wavelength_nm, double half_field_rad, int32_t surface) {
  const auto lambda_nm = wavelength_of(lens, wavelength_nm);
  if (!lambda_nm) return tl::unexpected(lambda_nm.error());
  SeidelRequest request;
  request.lambda_nm = *lambda_nm;
  request.half_field_rad = half_field_rad != 0.0 ? half_field_rad : first_order(lens, *lambda_nm).half_field_rad;
  if (surface == -1) return seidel_sums(lens, request);
  const auto all = seidel_by_surface(lens, request);
  if (surface < 0 || static_cast<std::size_t>(surface) >= all.size())
    return invalid_argument(
        fmt::format("the lens has {} surfaces, counted from 0; {} is none of them; -1 is the whole "
                    "lens",
                    all.size(), surface));
  return all[static_cast<std::size_t>(surface)];
}

}  // namespace

inline namespace internal {

Result<Ghost> ghost_of_surfaces(const LensState& lens, const int32_t surfaces[4]) {
  Ghost ghost;
  ghost.i = surfaces[0];
  ghost.j = surfaces[1];
  ghost.k = surfaces[2];
  ghost.l = surfaces[3];
  if (has_surfaces_of(lens, ghost) && has_ghost(lens, ghost)) return ghost;
  return invalid_argument(fmt::format("the lens has no ghost {}", ghost_name(ghost)));
}

}  // namespace internal
}  // namespace contrejour

cj_status cj_lens_with_surface(const cj_lens* lens, size_t index, const cj_surface_change* change, cj_lens** changed,
                               cj_error* error) {
  using namespace contrejour;
  return guarded_create(changed, error, [&]() -> Result<cj_lens> {
    if (const auto given = require_lens(lens); !given) return tl::unexpected(given.error());
    if (const auto good = check_struct(change, sizeof(cj_surface_change), "cj_surface_change"); !good)
      return tl::unexpected(good.error());
    return lens_with_texts(changed_lens(lens->prescription, index, in_this_version(*change)));
  });
}

void cj_text_destroy(cj_text* text) { delete text; }
const char* cj_text_data(const cj_text* text) { return text != nullptr ? text->text.c_str() : nullptr; }
size_t cj_text_size(const cj_text* text) { return text != nullptr ? text->text.size() : 0; }
const char* cj_text_note(const cj_text* text, size_t index) {
  return text != nullptr ? contrejour::text_at(text->notes, index) : nullptr;
}

cj_status cj_lens_write(const cj_lens* lens, const char* format, cj_text** text, cj_error* error) {
  using namespace contrejour;
  return guarded_create(text, error, [&]() -> Result<cj_text> {
    if (const auto given = require_lens(lens); !given) return tl::unexpected(given.error());
    if (const auto given = require(format, "format"); !given) return tl::unexpected(given.error());
    const std::string_view name(format);
    if (name == "toml") return cj_text{write_lens_toml(lens->prescription), {}};
    if (name == "zmx") return text_of(write_lens_zmx(lens->prescription));
    if (name == "seq") return text_of(write_lens_seq(lens->prescription));
    return invalid_argument(fmt::format("\"{}\" is not a format; give toml, zmx or seq", name.substr(0, 60)));
  });
}

cj_status cj_lens_state_write_ghost(const cj_lens_state* state, const int32_t surfaces[4], const char* format,
                                    cj_text** text, cj_error* error) {
  using namespace contrejour;
  return guarded_create(text, error, [&]() -> Result<cj_text> {
    if (const auto given = require_surfaces(state); !given) return tl::unexpected(given.error());
    if (const auto given = require(surfaces, "surfaces"); !given) return tl::unexpected(given.error());
    if (const auto given = require(format, "format"); !given) return tl::unexpected(given.error());
    const auto ghost = ghost_of_surfaces(state->state, surfaces);
    if (!ghost) return tl::unexpected(ghost.error());
    const std::string_view name(format);
    if (name == "zmx") return text_of(write_ghost_zmx(state->state, *ghost));
    if (name == "seq") return text_of(write_ghost_seq(state->state, *ghost));
    return invalid_argument(fmt::format("\"{}\" is not a format for a ghost; give zmx or seq", name.substr(0, 60)));
  });
}

cj_status cj_lens_state_get_seidel(const cj_lens_state* state, double wavelength_nm, double half_field_rad,
                                   int32_t surface, cj_seidel* sums, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require_surfaces(state); !given) return given;
    if (const auto good = check_struct(sums, sizeof(cj_seidel), "cj_seidel"); !good) return good;
    const auto found = seidel_of(state->state, wavelength_nm, half_field_rad, surface);
    if (!found) return tl::unexpected(found.error());
    write_struct(sums_of(*found), sums);
    return {};
  });
}
