// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/toml/toml_shape.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/units.h"
#include "optics/lens/carried.h"
#include "optics/lens_files/toml/toml_values.h"

namespace contrejour::inline internal {
namespace {

constexpr NumberRange kTilt_deg{-89.0, 89.0};
constexpr double kUnit = 1e-12;  // an axis whose length is 1 within this is not normalised

// A whole number in digits, or 0.
int whole(std::string_view digits) {
  int value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool all = code == std::errc{} && end == digits.data() + digits.size() && digits.front() != '0';
  return all ? value : 0;
}

std::vector<double> read_powers(TomlFields& row, TomlErrors& errors) {
  std::vector<double> powers;
  const toml::table* asphere = row.table("asphere");
  if (asphere == nullptr) return powers;
  for (const auto& [key, node] : *asphere) {
    const int power = whole(key.str());
    if (power < 1 || power > SurfaceShape::kHighestPower) {
      errors.fail(key.source(),
                  fmt::format("{}: asphere has no power '{}'; write {{ 4 = ..., 6 = ... }} with powers of "
                              "r from 1 to {}",
                              row.what(), shortened(key.str()), SurfaceShape::kHighestPower));
      return {};
    }
    if (powers.size() < static_cast<std::size_t>(power)) powers.resize(static_cast<std::size_t>(power));
    powers[static_cast<std::size_t>(power - 1)] = row.number_at(node, "an asphere's coefficient", kFinite);
  }
  return powers;
}

double read_rotation(TomlFields& fields) {
  if (fields.has("turn_deg") && fields.has("turn_rad")) {
    fields.fail_here("give either turn_deg or turn_rad");
    return 0.0;
  }
  if (const auto deg = fields.number("turn_deg", {-360.0, 360.0})) return rad_from_deg(*deg);
  return fields.number("turn_rad", {-1e3, 1e3}).value_or(0.0);
}

Vec3 axis_of_tilt(double about_x_deg, double about_y_deg) {
  const double a = rad_from_deg(about_x_deg), b = rad_from_deg(about_y_deg);
  return {std::sin(b) * std::cos(a), -std::sin(a), std::cos(b) * std::cos(a)};
}

// [x, y] or [x, y, z].
Vec3 read_vector(TomlFields& fields, std::string_view key, std::size_t min_count, NumberRange range) {
  const toml::array* list = fields.array(key);
  if (list == nullptr) return {};
  if (list->size() < min_count || list->size() > 3) {
    fields.fail(*list, fmt::format("{} must be a list of {} numbers", key, min_count == 3 ? "3" : "2 or 3"));
    return {};
  }
  std::array<double, 3> v{};
  for (std::size_t k = 0; k < list->size(); ++k) v[k] = fields.number_at((*list)[k], key, range);
  return {v[0], v[1], v[2]};
}

Vec2 read_pair(TomlFields& fields, std::string_view key) {
  const toml::array* list = fields.array(key);
  if (list == nullptr) return {};
  if (list->size() != 2) {
    fields.fail(*list, fmt::format("{} must be a list of 2 numbers", key));
    return {};
  }
  return {fields.number_at((*list)[0], key, kFinite), fields.number_at((*list)[1], key, kFinite)};
}

Vec3 read_axis(TomlFields& fields) {
  const Vec3 axis = read_vector(fields, "axis", 3, kFinite);
  const double size = length(axis);
  if (!(size > 0.0)) {
    fields.fail(*fields.find("axis"), "axis has no direction; give [x, y, z], or tilt_deg = [about x, about y]");
    return {0, 0, 1};
  }
  return std::abs(size - 1.0) < kUnit ? axis : axis * (1.0 / size);
}

// Enough digits to read the same angle back, if a number in degrees gives it.
std::string rotation_text(double rotation_rad) {
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", deg_from_rad(rotation_rad), digits);
    double deg = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), deg);
    if (rad_from_deg(deg) == rotation_rad) return "turn_deg = " + text;
  }
  return "turn_rad = " + toml_number(rotation_rad);
}

std::string vector_text(Vec3 v) {
  return fmt::format("[{}, {}, {}]", toml_number(v.x), toml_number(v.y), toml_number(v.z));
}

struct Group {
  std::size_t first = 0, last = 0;
  SurfacePose pose;
};

// Moves a group as one body, about the midpoint of its first and last vertex.
void carry(const Group& group, std::vector<Surface>& surfaces) {
  double length_mm = 0.0;
  for (std::size_t k = group.first; k < group.last; ++k) length_mm += surfaces[k].thickness_mm;
  double behind_mm = -0.5 * length_mm;
  for (std::size_t k = group.first; k <= group.last; ++k) {
    if (surfaces[k].kind != SurfaceKind::Stop) surfaces[k].pose = carried(group.pose, behind_mm, surfaces[k].pose);
    behind_mm += surfaces[k].thickness_mm;
  }
}

void read_group(const toml::table& table, std::size_t index, std::vector<Surface>& surfaces, TomlErrors& errors) {
  TomlFields fields(table, fmt::format("group {}", index), {"surfaces", "decentre_mm", "tilt_deg", "axis"}, errors);
  const toml::array* range = fields.array("surfaces");
  if (range == nullptr || range->size() != 2) {
    return fields.fail_here("give surfaces = [first, last], as they are counted from 1");
  }
  const NumberRange any{1.0, static_cast<double>(surfaces.size())};
  const double first = fields.number_at((*range)[0], "the first surface", any);
  const double last = fields.number_at((*range)[1], "the last surface", any);
  if (errors.failed()) return;
  if (first != std::floor(first) || last != std::floor(last) || first > last) {
    return fields.fail(*range, "surfaces must be [first, last], two whole numbers");
  }
  const Group group{static_cast<std::size_t>(first) - 1, static_cast<std::size_t>(last) - 1, read_pose(fields, errors)};
  if (!errors.failed()) carry(group, surfaces);
}

// The outline of a rim or of an obscuration.
struct Outline {
  Vec2 half_mm, centre_mm;
  double rotation_rad = 0.0;
};

std::optional<Outline> read_outline(TomlFields& row, std::string_view name, const std::string& sides,
                                    TomlErrors& errors) {
  const toml::table* table = row.table(name);
  if (table == nullptr) return std::nullopt;
  TomlFields fields(*table, row.what() + ", " + std::string(name), {sides, "centre_mm", "turn_deg", "turn_rad"},
                    errors);
  if (!fields.has(sides)) fields.fail_here(fmt::format("give {} = [x, y]", sides));
  Outline outline;
  outline.half_mm = read_pair(fields, sides);
  outline.centre_mm = read_pair(fields, "centre_mm");
  outline.rotation_rad = read_rotation(fields);
  return outline;
}

std::string outline_text(std::string_view name, std::string_view sides, const Outline& outline) {
  const auto pair = [](Vec2 v) { return fmt::format("[{}, {}]", toml_number(v.x), toml_number(v.y)); };
  std::string out = fmt::format(", {} = {{ {} = {}", name, sides, pair(outline.half_mm));
  if (!(outline.centre_mm == Vec2{})) out += ", centre_mm = " + pair(outline.centre_mm);
  if (outline.rotation_rad != 0.0) out += ", " + rotation_text(outline.rotation_rad);
  return out + " }";
}

}  // namespace

double read_curvature(TomlFields& fields, const std::string& suffix) {
  const std::string radius = "radius" + suffix + "_mm", curvature = "curvature" + suffix + "_per_mm";
  if (fields.has(radius) == fields.has(curvature)) {
    fields.fail_here(fmt::format("give either {} (inf for a plane) or {}; the stop is stop = true", radius, curvature));
    return 0.0;
  }
  if (fields.has(curvature)) return fields.number(curvature, kFinite).value_or(0.0);
  const toml::node& node = *fields.find(radius);
  // TOML's own infinity is how a plane is written: the one number that is allowed not to be finite.
  if (node.is_floating_point() && std::isinf(node.as_floating_point()->get())) return 0.0;
  const double radius_mm = fields.number_at(node, radius, kFinite);
  if (std::abs(radius_mm) < 1.0 / kHuge) {
    fields.fail(node, fmt::format("{0} is 0; write {0} = inf for a plane, stop = true for the stop", radius));
    return 0.0;
  }
  return 1.0 / radius_mm;
}

SurfaceShape read_shape(TomlFields& row, TomlErrors& errors) {
  SurfaceShape shape;
  shape.conic = row.number("conic", kFinite).value_or(0.0);
  shape.powers = read_powers(row, errors);
  if (row.has("toroid") && row.has("biconic")) row.fail_here("a surface is a toroid or a biconic, not both");
  if (const toml::table* table = row.table("toroid")) {
    TomlFields toroid(*table, row.what() + ", toroid", {"radius_x_mm", "curvature_x_per_mm", "turn_deg", "turn_rad"},
                      errors);
    shape.kind = ShapeKind::Toroid;
    shape.curvature_x_per_mm = read_curvature(toroid, "_x");
    shape.rotation_rad = read_rotation(toroid);
  }
  if (const toml::table* table = row.table("biconic")) {
    TomlFields biconic(*table, row.what() + ", biconic",
                       {"radius_x_mm", "curvature_x_per_mm", "conic_x", "turn_deg", "turn_rad"}, errors);
    shape.kind = ShapeKind::Biconic;
    shape.curvature_x_per_mm = read_curvature(biconic, "_x");
    shape.conic_x = biconic.number("conic_x", kFinite).value_or(0.0);
    shape.rotation_rad = read_rotation(biconic);
    if (row.has("asphere")) row.fail(*row.find("asphere"), "a biconic has no asphere; leave the one or the other out");
  }
  return shape;
}

ClearAperture read_aperture(TomlFields& row, TomlErrors& errors) {
  if (row.has("ellipse") && row.has("rectangle")) row.fail_here("a rim is an ellipse or a rectangle, not both");
  ClearAperture aperture;
  const auto take = [&](const std::optional<Outline>& outline, ApertureKind kind) {
    if (outline) aperture = {kind, outline->half_mm, outline->centre_mm, outline->rotation_rad};
  };
  take(read_outline(row, "ellipse", "semi_axes_mm", errors), ApertureKind::Ellipse);
  take(read_outline(row, "rectangle", "half_sides_mm", errors), ApertureKind::Rectangle);
  return aperture;
}

Obscuration read_obscuration(TomlFields& row, TomlErrors& errors) {
  const auto outline = read_outline(row, "obscuration", "semi_axes_mm", errors);
  return outline ? Obscuration{outline->half_mm, outline->centre_mm, outline->rotation_rad} : Obscuration{};
}

SurfacePose read_pose(TomlFields& fields, TomlErrors& errors) {
  SurfacePose pose;
  pose.shift_mm = read_vector(fields, "decentre_mm", 2, kFinite);
  if (fields.has("tilt_deg") && fields.has("axis")) fields.fail_here("give either tilt_deg or axis");
  if (fields.has("axis")) {
    pose.axis = read_axis(fields);
  } else if (const toml::array* tilt = fields.array("tilt_deg")) {
    if (tilt->size() != 2) fields.fail(*tilt, "tilt_deg must be [about x, about y]");
    if (errors.failed()) return {};
    pose.axis = axis_of_tilt(fields.number_at((*tilt)[0], "tilt_deg", kTilt_deg),
                             fields.number_at((*tilt)[1], "tilt_deg", kTilt_deg));
  }
  return pose;
}

void read_groups(TomlFields& lens, std::vector<Surface>& surfaces, TomlErrors& errors) {
  const toml::array* groups = lens.array("groups");
  if (groups == nullptr) return;
  if (groups->size() > surfaces.size()) return lens.fail(*groups, "more groups than surfaces; give each element once");
  std::size_t index = 0;
  for (const toml::node& node : *groups) {
    if (!node.is_table()) return lens.fail(node, "a group must be { surfaces = [first, last], decentre_mm = ... }");
    read_group(*node.as_table(), ++index, surfaces, errors);
    if (errors.failed()) return;
  }
}

std::string curvature_text(double curvature_per_mm, std::string_view suffix) {
  if (curvature_per_mm == 0.0) return fmt::format("radius{}_mm = inf", suffix);
  const bool radius_is_read = std::abs(curvature_per_mm) >= 1.0 / kHuge;
  for (int digits = 1; radius_is_read && digits <= 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", 1.0 / curvature_per_mm, digits);
    double radius_mm = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), radius_mm);
    if (1.0 / radius_mm == curvature_per_mm) return fmt::format("radius{}_mm = {}", suffix, text);
  }
  return fmt::format("curvature{}_per_mm = {}", suffix, toml_number(curvature_per_mm));
}

std::string shape_text(const SurfaceShape& shape) {
  std::string out;
  if (shape.conic != 0.0) out += ", conic = " + toml_number(shape.conic);
  std::string powers;
  for (std::size_t k = 0; k < shape.powers.size(); ++k) {
    const bool last = k + 1 == shape.powers.size();
    if (shape.powers[k] == 0.0 && !last) continue;
    powers += fmt::format("{}{} = {}", powers.empty() ? "" : ", ", k + 1, toml_number(shape.powers[k]));
  }
  if (!powers.empty()) out += fmt::format(", asphere = {{ {} }}", powers);
  if (shape.has_axial_symmetry()) return out;
  const bool biconic = shape.kind == ShapeKind::Biconic;
  out += fmt::format(", {} = {{ {}", biconic ? "biconic" : "toroid", curvature_text(shape.curvature_x_per_mm, "_x"));
  if (shape.conic_x != 0.0) out += ", conic_x = " + toml_number(shape.conic_x);
  if (shape.rotation_rad != 0.0) out += ", " + rotation_text(shape.rotation_rad);
  return out + " }";
}

std::string aperture_text(const ClearAperture& aperture) {
  const Outline outline{aperture.half_mm, aperture.centre_mm, aperture.rotation_rad};
  switch (aperture.kind) {
    case ApertureKind::Disc: return {};
    case ApertureKind::Ellipse: return outline_text("ellipse", "semi_axes_mm", outline);
    case ApertureKind::Rectangle: return outline_text("rectangle", "half_sides_mm", outline);
  }
  return {};
}

std::string obscuration_text(const Obscuration& o) {
  return o.any() ? outline_text("obscuration", "semi_axes_mm", {o.half_mm, o.centre_mm, o.rotation_rad})
                 : std::string();
}

std::string pose_text(const SurfacePose& pose) {
  std::string out;
  if (!(pose.shift_mm == Vec3{})) out += ", decentre_mm = " + vector_text(pose.shift_mm);
  if (!(pose.axis == Vec3{0, 0, 1})) out += ", axis = " + vector_text(pose.axis);
  return out;
}

}  // namespace contrejour::inline internal
