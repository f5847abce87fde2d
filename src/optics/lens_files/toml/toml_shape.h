// SPDX-License-Identifier: Apache-2.0
// Shapes, rims and poses of surfaces in the lens format: conics, aspheres, toroids, biconics, ellipses, rectangles,
// decentres and tilts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/toml_fields.h"
#include "contrejour/lens.h"

namespace contrejour::inline internal {

// Read a shape from a row's conic, asphere, toroid, biconic; a pose from its or a group's decentre_mm, tilt_deg, axis.
[[nodiscard]] SurfaceShape read_shape(TomlFields& row, TomlErrors& errors);
[[nodiscard]] ClearAperture read_aperture(TomlFields& row, TomlErrors& errors);  // ellipse, rectangle
[[nodiscard]] Obscuration read_obscuration(TomlFields& row, TomlErrors& errors);
[[nodiscard]] SurfacePose read_pose(TomlFields& fields, TomlErrors& errors);

// 1 / radius_mm, or curvature_per_mm, whichever key is present, with a suffix for the other section ("_x").
[[nodiscard]] double read_curvature(TomlFields& fields, const std::string& suffix);

// Poses of elements that are moved together: `groups` of the lens.
void read_groups(TomlFields& lens, std::vector<Surface>& surfaces, TomlErrors& errors);

// The text behind a row's radius, ", conic = -1" and so on.
[[nodiscard]] std::string shape_text(const SurfaceShape& shape);
[[nodiscard]] std::string aperture_text(const ClearAperture& aperture);
[[nodiscard]] std::string obscuration_text(const Obscuration& obscuration);
[[nodiscard]] std::string pose_text(const SurfacePose& pose);

// "radius_mm = 30.81", or with a suffix "radius_x_mm = ...", in as few digits as give the same curvature.
[[nodiscard]] std::string curvature_text(double curvature_per_mm, std::string_view suffix);

}  // namespace contrejour::inline internal
