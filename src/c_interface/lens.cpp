// SPDX-License-Identifier: Apache-2.0
// Lenses and configured lenses for C callers.
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "c_interface/boundary.h"
#include "c_interface/objects.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/settings.h"

namespace contrejour {
namespace {

const std::vector<std::string>& lens_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const BundledLens& lens : bundled_lenses()) names.emplace_back(lens.name);
    return names;
  }();
  return kNames;
}

Result<cj_lens> find_lens_or_flare(const char* name_or_file) {
  if (!is_measured_flare(name_or_file)) return lens_with_texts(find_lens(name_or_file));
  auto flare = read_flare(std::filesystem::path(name_or_file));
  if (!flare) return tl::unexpected(flare.error());
  cj_lens lens;
  lens.prescription.name = flare->name;
  lens.prescription.source = flare->source;
  lens.measured = std::move(*flare);
  return lens;
}

Result<cj_lens_state> configured_lens(const cj_lens& lens, const params::Values& values) {
  if (lens.measured) return cj_lens_state{ideal_lens_of(*lens.measured), lens.measured};
  auto configured = params::lens_of(lens.prescription, values);
  if (!configured) return tl::unexpected(configured.error());
  return cj_lens_state{std::move(*configured)};
}

cj_surface surface_of(const cj_lens& lens, std::size_t index) {
  const Surface& given = lens.prescription.surfaces[index];
  const GlassFigures figures = glass_figures(given.glass_after);
  cj_surface ours{};
  ours.kind = given.kind == SurfaceKind::Stop ? CJ_STOP : CJ_REFRACTING;
  ours.is_sphere = given.shape.is_sphere() && given.pose == SurfacePose{} ? 1 : 0;
  ours.curvature_per_mm = given.curvature_per_mm;
  ours.thickness_mm = given.thickness_mm;
  ours.semi_diameter_mm = given.semi_diameter_mm;
  ours.index_d = figures.n_d;
  ours.abbe_d = figures.v_d;
  ours.glass_behind = is_air(given.glass_after) ? "air" : given.glass_after.name.c_str();
  ours.coating = lens.coatings[index].c_str();
  return ours;
}

cj_lens_figures figures_at(const LensState& lens, double lambda_nm) {
  const FirstOrder figures = first_order(lens, lambda_nm);
  cj_lens_figures ours{};
  ours.focal_length_mm = figures.focal_length_mm;
  ours.f_number = figures.f_number;
  ours.object_distance_mm = lens.object_distance_mm;
  ours.stop_radius_mm = lens.stop_radius_mm;
  ours.sensor_width_mm = lens.sensor_width_mm;
  ours.sensor_height_mm = lens.sensor_height_mm;
  ours.sensor_position_mm = figures.sensor_position_mm;
  ours.back_focal_distance_mm = figures.back_focal_distance_mm;
  ours.front_focal_distance_mm = figures.front_focal_distance_mm;
  ours.entrance_pupil_position_mm = figures.entrance_pupil_position_mm;
  ours.entrance_pupil_diameter_mm = figures.entrance_pupil_diameter_mm;
  ours.exit_pupil_position_mm = figures.exit_pupil_position_mm;
  ours.exit_pupil_diameter_mm = figures.exit_pupil_diameter_mm;
  ours.half_field_rad = figures.half_field_rad;
  ours.wavelength_nm = lambda_nm;
  return ours;
}

Result<void> no_surfaces(const std::string& name) {
  return failure(ErrorCode::Unsupported,
                 fmt::format("\"{}\" is a measured flare, which has no surfaces; it can be rendered and applied, but "
                             "this needs a lens",
                             name));
}

}  // namespace

inline namespace internal {

Result<cj_lens> lens_with_texts(Result<Prescription> read) {
  if (!read) return tl::unexpected(std::move(read.error()));
  cj_lens lens{std::move(*read), {}};
  for (const Surface& surface : lens.prescription.surfaces) lens.coatings.push_back(describe(surface.coating));
  return lens;
}

Result<void> require_lens(const cj_lens* lens) {
  if (const auto given = require(lens, "lens"); !given) return given;
  return lens->measured ? no_surfaces(lens->prescription.name) : Result<void>();
}

Result<void> require_surfaces(const cj_lens_state* state) {
  if (const auto given = require(state, "state"); !given) return given;
  return state->measured ? no_surfaces(state->state.name) : Result<void>();
}

}  // namespace internal
}  // namespace contrejour

using contrejour::Result;

size_t cj_bundled_lens_count(void) {
  return contrejour::guarded_value(size_t{0}, [] { return contrejour::lens_names().size(); });
}

const char* cj_bundled_lens_name(size_t index) {
  return contrejour::guarded_value<const char*>(nullptr,
                                                [&] { return contrejour::text_at(contrejour::lens_names(), index); });
}

cj_status cj_lens_find(const char* name_or_file, cj_lens** lens, cj_error* error) {
  return contrejour::guarded_create(lens, error, [&]() -> Result<cj_lens> {
    if (const auto given = contrejour::require(name_or_file, "name_or_file"); !given)
      return tl::unexpected(given.error());
    return contrejour::find_lens_or_flare(name_or_file);
  });
}

cj_status cj_lens_read_toml(const char* text, const char* file, cj_lens** lens, cj_error* error) {
  return contrejour::guarded_create(lens, error, [&]() -> Result<cj_lens> {
    if (const auto given = contrejour::require(text, "text"); !given) return tl::unexpected(given.error());
    return contrejour::lens_with_texts(contrejour::read_lens_toml(text, file != nullptr ? file : ""));
  });
}

void cj_lens_destroy(cj_lens* lens) { delete lens; }

cj_status cj_lens_get_info(const cj_lens* lens, cj_lens_info* info, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(lens, "lens"); !given) return given;
    if (const auto good = check_struct(info, offsetof(cj_lens_info, is_measured_flare), "cj_lens_info"); !good)
      return good;
    const Prescription& prescription = lens->prescription;
    cj_lens_info ours{};
    ours.name = prescription.name.c_str();
    ours.source = prescription.source.c_str();
    ours.f_number = prescription.f_number;
    if (!prescription.zoom.empty()) {
      ours.shortest_focal_length_mm = prescription.zoom.front().focal_length_mm;
      ours.longest_focal_length_mm = prescription.zoom.back().focal_length_mm;
    }
    ours.sensor_width_mm = prescription.sensor_width_mm;
    ours.sensor_height_mm = prescription.sensor_height_mm;
    ours.surface_count = prescription.surfaces.size();
    ours.warning_count = prescription.warnings.size();
    ours.is_measured_flare = lens->measured ? 1 : 0;
    write_struct(ours, info);
    return {};
  });
}

const char* cj_lens_warning(const cj_lens* lens, size_t index) {
  return lens != nullptr ? contrejour::text_at(lens->prescription.warnings, index) : nullptr;
}

cj_status cj_lens_get_surface(const cj_lens* lens, size_t index, cj_surface* surface, cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(lens, "lens"); !given) return given;
    if (const auto good = check_struct(surface, sizeof(cj_surface), "cj_surface"); !good) return good;
    const std::size_t count = lens->prescription.surfaces.size();
    if (index >= count)
      return invalid_argument(
          fmt::format("the lens has {} surfaces, counted from 0; {} is none of them", count, index));
    write_struct(surface_of(*lens, index), surface);
    return {};
  });
}

cj_status cj_lens_configure(const cj_lens* lens, const cj_settings* settings, cj_lens_state** state, cj_error* error) {
  using namespace contrejour;
  return guarded_create(state, error, [&]() -> Result<cj_lens_state> {
    if (const auto given = require(lens, "lens"); !given) return tl::unexpected(given.error());
    return configured_lens(*lens, values_of(settings));
  });
}

void cj_lens_state_destroy(cj_lens_state* state) { delete state; }

cj_status cj_lens_state_get_figures(const cj_lens_state* state, double wavelength_nm, cj_lens_figures* figures,
                                    cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require_surfaces(state); !given) return given;
    if (const auto good = check_struct(figures, sizeof(cj_lens_figures), "cj_lens_figures"); !good) return good;
    if (wavelength_nm != 0.0 && !(wavelength_nm >= 100.0 && wavelength_nm <= 10000.0))
      return invalid_argument(fmt::format("{} nm is not a wavelength of light; give nm, as 550, or 0", wavelength_nm));
    const double lambda_nm = wavelength_nm == 0.0 ? state->state.design_wavelength_nm : wavelength_nm;
    write_struct(figures_at(state->state, lambda_nm), figures);
    return {};
  });
}
