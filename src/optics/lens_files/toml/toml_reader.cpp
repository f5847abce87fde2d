// SPDX-License-Identifier: Apache-2.0
// Our own lens format, docs/formats/lens-toml.md: names and types here, plausibility in validate().
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/toml_fields.h"
#include "base/units.h"
#include "contrejour/lens.h"
#include "optics/lens/validate.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/toml/toml_media.h"
#include "optics/lens_files/toml/toml_shape.h"
#include "optics/lens_files/toml/toml_values.h"

namespace contrejour {

namespace {

// Wider than any lens; validate() checks plausibility and names the surface's line.
// Beyond this angle the image circle of a distortion-free lens does not approximate a real one.
constexpr double kMaxHalfField_deg = 80.0;

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

// A lens while it is being read; air before the first surface.
struct TomlReader {
  TomlErrors errors;
  MediumTable<Glass> glasses;
  MediumTable<Coating> coatings;
  GlassFinder finder;
  Coating default_coating;
  Prescription lens;

  TomlReader(const std::string& file, const GlassCatalogue* own) : errors(file), finder(own) {}

  [[nodiscard]] Glass glass_before() const { return lens.surfaces.empty() ? air() : lens.surfaces.back().glass_after; }

  void read_lens_table(const toml::table& root);
  void read_sensor(TomlFields& fields);
  void read_stated(TomlFields& fields);
  void read_surfaces(TomlFields& fields);
  void read_surface(const toml::table& row, bool last);
  Coating coating_of(TomlFields& fields, const Surface& surface);
  void read_stop(TomlFields& fields, Surface& surface);
  void read_zoom(TomlFields& fields);
  void read_zoom_position(const toml::table& row);
};

void TomlReader::read_lens_table(const toml::table& root) {
  TomlFields fields(root, "lens",
                    {"name", "source", "f_number", "sensor_mm", "half_field_deg", "sensor_distance_mm",
                     "default_coating", "surfaces", "groups", "zoom", "stated", "glass", "coating"},
                    errors);
  lens.name = fields.required_text("name", "give the lens a name");
  lens.source = fields.required_text("source", "say where its figures come from, e.g. the patent's number");
  lens.f_number = fields.required_number("f_number", kFinite, "give the f-number at full opening");
  read_stated(fields);
  read_sensor(fields);
  glasses = read_glass_table(root, errors);
  coatings = read_coating_table(root, errors);
  if (const toml::node* coating = fields.find("default_coating"); coating != nullptr && !errors.failed()) {
    default_coating = read_coating(*coating, "default_coating", coatings, errors);
  }
  if (!errors.failed()) read_surfaces(fields);
  if (!errors.failed()) read_groups(fields, lens.surfaces, errors);
  if (!errors.failed()) read_zoom(fields);
  if (!errors.failed()) refuse_unused(glasses, coatings, errors);
}

void TomlReader::read_stated(TomlFields& fields) {
  const toml::table* table = fields.table("stated");
  if (table == nullptr) return;
  TomlFields stated(*table, "stated", {"focal_length_mm", "back_focal_distance_mm", "wavelength_nm", "tolerance"},
                    errors);
  lens.stated.focal_length_mm = stated.number("focal_length_mm", kFinite);
  lens.stated.back_focal_distance_mm = stated.number("back_focal_distance_mm", kFinite);
  lens.stated.wavelength_nm = stated.number("wavelength_nm", {300.0, 1100.0}).value_or(kLineD_nm);
  lens.stated.tolerance = stated.number("tolerance", {1e-6, 0.5}).value_or(lens.stated.tolerance);
}

void TomlReader::read_sensor(TomlFields& fields) {
  lens.sensor_distance_mm = fields.number("sensor_distance_mm", {1e-6, 1e5});
  if (fields.has("sensor_mm") == fields.has("half_field_deg")) {
    fields.fail_here("give the sensor either as sensor_mm = [36, 24] or by half_field_deg");
    return;
  }
  if (const toml::array* size = fields.array("sensor_mm")) {
    if (size->size() != 2) return fields.fail(*size, "sensor_mm must be [width, height]");
    lens.sensor_width_mm = fields.number_at((*size)[0], "the sensor's width", {0.1, 10000.0});
    lens.sensor_height_mm = fields.number_at((*size)[1], "the sensor's height", {0.1, 10000.0});
    return;
  }
  const auto half_field_deg = fields.number("half_field_deg", {0.01, kMaxHalfField_deg});
  if (!half_field_deg || errors.failed()) return;
  if (!lens.stated.focal_length_mm) {
    return fields.fail(*fields.find("half_field_deg"),
                       "half_field_deg needs focal_length_mm under [stated]; or give sensor_mm");
  }
  // The 3:2 rectangle in the image circle of the field, whose radius without distortion is f tan(field).
  const double radius_mm = *lens.stated.focal_length_mm * std::tan(rad_from_deg(*half_field_deg));
  lens.sensor_width_mm = 2.0 * radius_mm * 3.0 / std::sqrt(13.0);
  lens.sensor_height_mm = 2.0 * radius_mm * 2.0 / std::sqrt(13.0);
}

void TomlReader::read_surfaces(TomlFields& fields) {
  const toml::array* rows = fields.array("surfaces");
  if (rows == nullptr) return fields.fail_here("surfaces is missing; list them from the front to the back");
  if (rows->size() > static_cast<std::size_t>(kMaxSurfaces)) {
    return fields.fail(*rows, fmt::format("{} surfaces; at most {} are read", rows->size(), kMaxSurfaces));
  }
  lens.surfaces.reserve(rows->size());
  for (const toml::node& node : *rows) {
    if (!node.is_table()) {
      return fields.fail(node,
                         fmt::format("surface {} must be a row {{ radius_mm = ..., ... }}", lens.surfaces.size() + 1));
    }
    read_surface(*node.as_table(), lens.surfaces.size() + 1 == rows->size());
    if (errors.failed()) return;
  }
  if (lens.surfaces.empty()) fields.fail(*rows, "surfaces is empty; list them from the front to the back");
}

void TomlReader::read_surface(const toml::table& row, bool last) {
  TomlFields fields(
      row, fmt::format("surface {}", lens.surfaces.size() + 1),
      {"radius_mm", "curvature_per_mm", "thickness_mm", "semi_diameter_mm", "glass", "coating", "stop", "conic",
       "asphere", "toroid", "biconic", "ellipse", "rectangle", "obscuration", "decentre_mm", "tilt_deg", "axis"},
      errors);
  Surface surface;
  surface.source_line = line_of(row);
  surface.semi_diameter_mm =
      fields.required_number("semi_diameter_mm", kFinite, "give the radius of the clear aperture");
  if (!last) {
    surface.thickness_mm = fields.required_number("thickness_mm", kFinite, "give the distance to the next vertex");
  } else if (fields.has("thickness_mm")) {
    fields.fail(*fields.find("thickness_mm"),
                "the last surface has no thickness_mm: the sensor stands where the lens focuses; what the source "
                "says goes under [stated] as back_focal_distance_mm");
  }
  surface.obscuration = read_obscuration(fields, errors);
  if (fields.has("stop")) {
    read_stop(fields, surface);
  } else {
    surface.curvature_per_mm = read_curvature(fields, "");
    surface.shape = read_shape(fields, errors);
    surface.aperture = read_aperture(fields, errors);
    surface.pose = read_pose(fields, errors);
    const toml::node* glass = fields.find("glass");
    surface.glass_after = glass == nullptr ? air() : read_glass(*glass, fields.what(), glasses, finder, errors);
    surface.coating = coating_of(fields, surface);
  }
  if (!errors.failed()) lens.surfaces.push_back(std::move(surface));
}

void TomlReader::read_stop(TomlFields& fields, Surface& surface) {
  const auto is_stop = fields.boolean("stop");
  if (is_stop == false) return fields.fail(*fields.find("stop"), "stop = false says nothing; leave it out");
  for (const std::string_view key : {"radius_mm", "curvature_per_mm", "glass", "coating", "conic", "asphere", "toroid",
                                     "biconic", "ellipse", "rectangle", "decentre_mm", "tilt_deg", "axis"}) {
    if (fields.has(key)) fields.fail(*fields.find(key), fmt::format("a stop has no {}; leave it out", key));
  }
  surface.kind = SurfaceKind::Stop;
  surface.glass_after = glass_before();
}

// The row's own coating; else the lens's default between glass and air; else bare, for cemented faces.
Coating TomlReader::coating_of(TomlFields& fields, const Surface& surface) {
  if (const toml::node* own = fields.find("coating")) return read_coating(*own, fields.what(), coatings, errors);
  const bool glass_to_air = is_air(glass_before()) != is_air(surface.glass_after);
  return glass_to_air ? default_coating : Coating{};
}

void TomlReader::read_zoom(TomlFields& fields) {
  const toml::array* rows = fields.array("zoom");
  if (rows == nullptr) return;
  if (rows->size() < 2 || rows->size() > static_cast<std::size_t>(kMaxZoomPositions)) {
    return fields.fail(*rows, fmt::format("zoom has {} positions; give 2 to {}, or leave zoom out for a lens of "
                                          "one focal length",
                                          rows->size(), kMaxZoomPositions));
  }
  for (const toml::node& node : *rows) {
    if (!node.is_table()) {
      return fields.fail(node, "a zoom position must be { focal_length_mm = ..., thickness_mm = { ... } }");
    }
    read_zoom_position(*node.as_table());
    if (errors.failed()) return;
  }
}

void TomlReader::read_zoom_position(const toml::table& row) {
  TomlFields fields(row, fmt::format("zoom position {}", lens.zoom.size() + 1), {"focal_length_mm", "thickness_mm"},
                    errors);
  ZoomPosition position;
  position.source_line = line_of(row);
  position.focal_length_mm =
      fields.required_number("focal_length_mm", kFinite, "give the focal length a photographer asks for");
  const toml::table* gaps = fields.table("thickness_mm");
  if (gaps == nullptr) return fields.fail_here("thickness_mm is missing; write { 6 = 8.78 } for surface 6");
  for (const auto& [key, node] : *gaps) {
    const std::string_view digits = key.str();
    int surface = 0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), surface);
    const bool whole = code == std::errc{} && end == digits.data() + digits.size() && digits.front() != '0';
    if (!whole || surface < 1 || surface > static_cast<int>(lens.surfaces.size())) {
      errors.fail(key.source(), fmt::format("{}: there is no surface '{}'; the lens has surfaces 1 to {}",
                                            fields.what(), shortened(digits), lens.surfaces.size()));
      return;
    }
    position.thickness_mm.emplace_back(surface - 1, fields.number_at(node, "thickness_mm", kFinite));
  }
  // TOML sorts keys as text ("10" before "6"); surfaces are in the order of the lens.
  std::sort(position.thickness_mm.begin(), position.thickness_mm.end());
  lens.zoom.push_back(std::move(position));
}

}  // namespace

Result<Prescription> read_lens_toml(std::string_view text, const std::string& file, const GlassCatalogue* glasses) {
  if (text.size() > kMaxLensFileBytes) {
    return failure(ErrorCode::Parse,
                   fmt::format("{} bytes; a lens file has at most {}", text.size(), kMaxLensFileBytes), {file, 0, 0});
  }
  const Result<toml::table> root = parse_toml(text, file, "docs/formats/lens-toml.md");
  if (!root) return tl::unexpected(root.error());
  TomlReader reader(file, glasses);
  reader.lens.file = {file, 1, 0};
  reader.read_lens_table(*root);
  if (reader.errors.failed()) return tl::unexpected(reader.errors.error());
  if (const auto valid = validate(reader.lens); !valid) return tl::unexpected(valid.error());
  return std::move(reader.lens);
}

}  // namespace contrejour
