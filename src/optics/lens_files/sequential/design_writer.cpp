// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/design_writer.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "optics/lens_files/sequential/design_opening.h"

namespace contrejour::inline internal {

std::string number_text(double value) { return fmt::format("{}", value); }

std::optional<std::string> text_giving(double value, double about, const std::function<double(double)>& back) {
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", about, digits);
    double read = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    if (back(read) == value) return text;
  }
  return std::nullopt;
}

std::string plain_title(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool is_blank = std::iscntrl(static_cast<unsigned char>(c)) != 0 || c == ' ';
    if (is_blank && (out.empty() || out.back() == ' ')) continue;
    out += is_blank ? ' ' : c == '\'' || c == '"' ? '`' : c;
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

Tilts tilts_of(const Surface& surface, double rotation_rad) {
  const Vec3 axis = surface.pose.axis;
  Tilts tilts;
  tilts.y_rad = std::asin(std::clamp(axis.x, -1.0, 1.0));
  tilts.x_rad = std::atan2(-axis.y, axis.z);
  const bool round = surface.shape.has_axial_symmetry() && surface.aperture.kind == ApertureKind::Disc &&
                     surface.obscuration.has_axial_symmetry();
  if (round) return tilts;
  const Placement tilted = rotation_about(0, tilts.x_rad).then(rotation_about(1, tilts.y_rad));
  tilts.z_rad = rotation_rad - pose_of(tilted).rotation_rad;
  return tilts;
}

ClearAperture aperture_in_rotated(const ClearAperture& aperture, double rotation_rad) {
  ClearAperture own = aperture;
  rotate_opening(-rotation_rad, own);
  if (std::abs(own.rotation_rad) < 1e-12) own.rotation_rad = 0.0;
  return own;
}

Obscuration obscuration_in_rotated(const Obscuration& obscuration, double rotation_rad) {
  Obscuration own = obscuration;
  rotate_opening(-rotation_rad, own);
  if (std::abs(own.rotation_rad) < 1e-12) own.rotation_rad = 0.0;
  return own;
}

std::optional<CataloguedName> catalogued_name(const Glass& glass) {
  if (glass.name.empty() || !std::holds_alternative<CatalogueGlass>(glass.dispersion)) return std::nullopt;
  const auto found = bundled_glasses().find(glass.name);
  if (!found || !(found->glass.dispersion == glass.dispersion)) return std::nullopt;
  return CataloguedName{found->summary.name, found->summary.maker};
}

Result<std::vector<double>> sensor_distances_mm(const Prescription& lens) {
  std::vector<double> out;
  for (std::size_t k = 0; k < std::max<std::size_t>(lens.zoom.size(), 1); ++k) {
    LensSettings settings;
    if (!lens.zoom.empty()) settings.focal_length_mm = lens.zoom[k].focal_length_mm;
    const auto state = configure_lens(lens, settings);
    if (!state) return tl::unexpected(state.error());
    out.push_back(lens.sensor_distance_mm.value_or(state->sensor_z_mm - state->surfaces.back().z_mm));
  }
  return out;
}

Result<std::vector<double>> write_surfaces(const WritableDesign& rows, const SurfaceWriter& write) {
  const Prescription& lens = rows.lens;
  Result<std::vector<double>> sensor_mm = std::vector<double>{rows.sensor_mm};
  if (!rows.is_path()) {
    if (const auto valid = validate(lens); !valid) return tl::unexpected(valid.error());
    sensor_mm = sensor_distances_mm(lens);
    if (!sensor_mm) return sensor_mm;
  }
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    const bool last = k + 1 == lens.surfaces.size();
    if (const auto problem = write(k, last ? sensor_mm->front() : lens.surfaces[k].thickness_mm))
      return failure(ErrorCode::Unsupported, fmt::format("surface {}: {}", k + 1, *problem),
                     {lens.file.file, lens.surfaces[k].source_line, 0});
  }
  return sensor_mm;
}

std::string radius_text(double curvature_per_mm) {
  if (curvature_per_mm == 0.0) return "0";
  const double radius_mm = 1.0 / curvature_per_mm;
  return text_giving(curvature_per_mm, radius_mm, [](double r) { return 1.0 / r; }).value_or(number_text(radius_mm));
}

std::vector<std::string> common_losses(const Prescription& lens) {
  std::vector<std::string> losses;
  const auto coated = std::count_if(lens.surfaces.begin(), lens.surfaces.end(),
                                    [](const Surface& s) { return !std::holds_alternative<Bare>(s.coating.films); });
  if (coated > 0) losses.push_back(fmt::format("the coatings of {} surfaces are not written", coated));
  if (lens.stated.focal_length_mm || lens.stated.back_focal_distance_mm)
    losses.emplace_back("the stated focal length and back focal distance are not written");
  return losses;
}

}  // namespace contrejour::inline internal
