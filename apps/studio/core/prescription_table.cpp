// SPDX-License-Identifier: Apache-2.0
#include "studio/core/prescription_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/glass_text.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::studio {
namespace {

bool is_stop(const Surface& surface) { return surface.kind == SurfaceKind::Stop; }

// The words of a message that are keys of lens files.
std::string in_words(std::string message) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kWords = {
      {{"semi_diameter_mm", "the semi-diameter"}, {"thickness_mm", "the thickness"}, {"radius_mm", "the radius"}}};
  for (const auto& [key, word] : kWords)
    for (std::size_t at = message.find(key); at != std::string::npos; at = message.find(key, at + word.size()))
      message.replace(at, key.size(), word);
  return message;
}

// The lens is no longer that of its file, so errors name no line there.
Result<Prescription> checked(Prescription lens) {
  if (auto ok = validate(lens); !ok) return failure(ok.error().code, in_words(ok.error().message));
  return lens;
}

const Glass& medium_before(const Prescription& lens, std::size_t row) {
  static const Glass kAir = air();
  return row == 0 ? kAir : lens.surfaces[row - 1].glass_after;
}

std::string glass_text(const Glass& glass) {
  if (is_air(glass)) return "";
  if (const auto* abbe = std::get_if<AbbeGlass>(&glass.dispersion))
    return fmt::format("{:.7g},{:.6g}", abbe->n_d, abbe->v_d);
  if (!glass.name.empty()) return glass.name;
  const GlassFigures figures = glass_figures(glass);
  return fmt::format("{:.6g},{:.4g}", figures.n_d, figures.v_d);
}

// As --coating writes it, if the user or the file has named it; a description otherwise.
std::string coating_text(const Coating& coating) {
  if (std::holds_alternative<Bare>(coating.films)) return "none";
  if (!coating.name.empty()) return coating.name;
  if (const auto* film = std::get_if<QuarterWave>(&coating.films))
    return fmt::format("quarter-wave:{}:{}", film->lambda0_nm, film->n);
  return describe(coating);
}

Result<double> real_cell(std::string_view text, double least, const char* what) {
  const auto value = params::parse_real(text);
  if (!value) return value;
  if (*value < least) return invalid_argument(fmt::format("{} is at least {}", what, least));
  return value;
}

Result<void> set_radius(Surface& surface, std::string_view text) {
  if (text.empty() || text == "inf" || text == "plane") {
    surface.curvature_per_mm = 0;
    return {};
  }
  const auto radius = params::parse_real(text);
  if (!radius) return tl::unexpected(radius.error());
  surface.curvature_per_mm = *radius == 0 ? 0 : 1 / *radius;
  return {};
}

// "no glass is called 'BANANA'; near it: ...", for a text that the catalogue knows nothing like.
std::string unknown_glass(std::string_view text) {
  const auto near = glasses_near(text, 5);
  return near.empty()
             ? fmt::format("no glass is called '{}'; type its first letters to see those of the catalogue", text)
             : fmt::format("no glass is called '{}'; those that begin like it are {}, \u2026", text,
                           fmt::join(near, ", "));
}

// The stop has the medium in front of it on both sides, so it follows.
Result<void> set_glass(Prescription& lens, std::size_t row, std::string_view text) {
  const auto glass = text.empty() ? Result<Glass>(air()) : params::parse_glass(text);
  if (!glass) {
    const bool names_command = glass.error().message.find("glass list") != std::string::npos;
    return names_command ? failure(ErrorCode::InvalidArgument, unknown_glass(text)) : tl::unexpected(glass.error());
  }
  lens.surfaces[row].glass_after = *glass;
  for (std::size_t k = row + 1; k < lens.surfaces.size() && is_stop(lens.surfaces[k]); ++k)
    lens.surfaces[k].glass_after = *glass;
  return {};
}

template <class Set>
Result<void> set_number(std::string_view text, double least, const char* what, Set set) {
  const auto value = real_cell(text, least, what);
  if (!value) return tl::unexpected(value.error());
  set(*value);
  return {};
}

Result<void> set_cell(Prescription& lens, std::size_t row, LensColumn column, std::string_view text) {
  Surface& surface = lens.surfaces[row];
  switch (column) {
    case LensColumn::Radius: return set_radius(surface, text);
    case LensColumn::Thickness: return set_number(text, 0, "a thickness", [&](double v) { surface.thickness_mm = v; });
    case LensColumn::Glass: return set_glass(lens, row, text);
    case LensColumn::SemiDiameter:
      return set_number(text, 1e-3, "a semi-diameter", [&](double v) { surface.semi_diameter_mm = v; });
    case LensColumn::Conic:
      return set_number(text.empty() ? "0" : text, -1e6, "a conic constant",
                        [&](double v) { surface.shape.conic = v; });
    case LensColumn::Coating: {
      auto coating = params::parse_coating(text.empty() ? "none" : text);
      if (!coating) return tl::unexpected(coating.error());
      surface.coating = std::move(*coating);
      return {};
    }
  }
  return {};
}

Surface reversed_surface(Surface surface, const Glass& after, double thickness_mm) {
  surface.curvature_per_mm = -surface.curvature_per_mm;
  surface.shape.curvature_x_per_mm = -surface.shape.curvature_x_per_mm;
  for (double& power : surface.shape.powers) power = -power;
  surface.glass_after = after;
  surface.thickness_mm = thickness_mm;
  return surface;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace

std::string_view heading_of(LensColumn column) {
  constexpr std::array<std::string_view, 6> headings = {"Radius mm",    "Thickness mm", "Glass",
                                                        "Semi-dia. mm", "Conic",        "Coating"};
  return headings[static_cast<std::size_t>(column)];
}

std::string cell_text(const Prescription& lens, std::size_t row, LensColumn column) {
  const Surface& surface = lens.surfaces[row];
  if (!is_editable(lens, row, column)) return "";
  switch (column) {
    case LensColumn::Radius:
      return surface.curvature_per_mm == 0 ? "inf" : fmt::format("{:.8g}", 1 / surface.curvature_per_mm);
    case LensColumn::Thickness: return fmt::format("{:.8g}", surface.thickness_mm);
    case LensColumn::Glass: return glass_text(surface.glass_after);
    case LensColumn::SemiDiameter: return fmt::format("{:.6g}", surface.semi_diameter_mm);
    case LensColumn::Conic: return surface.shape.conic == 0 ? "" : fmt::format("{:.8g}", surface.shape.conic);
    case LensColumn::Coating: return coating_text(surface.coating);
  }
  return "";
}

bool is_editable(const Prescription& lens, std::size_t row, LensColumn column) {
  const bool is_last = row + 1 == lens.surfaces.size();
  if (column == LensColumn::Thickness) return !is_last;
  if (!is_stop(lens.surfaces[row])) return true;
  return column == LensColumn::SemiDiameter;
}

Result<Prescription> with_cell(const Prescription& lens, std::size_t row, LensColumn column, std::string_view text) {
  if (row >= lens.surfaces.size() || !is_editable(lens, row, column))
    return invalid_argument("this surface has no such value");
  Prescription edited = lens;
  if (auto ok = set_cell(edited, row, column, text); !ok) return tl::unexpected(ok.error());
  return checked(std::move(edited));
}

Result<Prescription> with_inserted_surface(const Prescription& lens, std::size_t row) {
  if (row + 1 >= lens.surfaces.size()) return invalid_argument("there is no gap behind the last surface");
  Prescription edited = lens;
  Surface inserted;
  inserted.curvature_per_mm = 0.5 * (lens.surfaces[row].curvature_per_mm + lens.surfaces[row + 1].curvature_per_mm);
  inserted.semi_diameter_mm = std::fmin(lens.surfaces[row].semi_diameter_mm, lens.surfaces[row + 1].semi_diameter_mm);
  inserted.glass_after = lens.surfaces[row].glass_after;
  inserted.thickness_mm = 0.5 * lens.surfaces[row].thickness_mm;
  edited.surfaces[row].thickness_mm -= inserted.thickness_mm;
  edited.surfaces.insert(edited.surfaces.begin() + static_cast<std::ptrdiff_t>(row) + 1, inserted);
  for (ZoomPosition& position : edited.zoom)
    for (auto& [surface, thickness] : position.thickness_mm)
      if (surface > static_cast<int>(row)) ++surface;
  return checked(std::move(edited));
}

Result<Prescription> without_surface(const Prescription& lens, std::size_t row) {
  if (row >= lens.surfaces.size()) return invalid_argument("the lens has no such surface");
  if (is_stop(lens.surfaces[row])) return invalid_argument("a lens needs its stop");
  const int index = static_cast<int>(row);
  for (const ZoomPosition& position : lens.zoom)
    for (const auto& gap : position.thickness_mm)
      if (gap.first == index) return invalid_argument("the gap behind this surface changes with the focal length");
  Prescription edited = lens;
  if (row > 0) {
    edited.surfaces[row - 1].thickness_mm += lens.surfaces[row].thickness_mm;
    edited.surfaces[row - 1].glass_after = lens.surfaces[row].glass_after;
  }
  edited.surfaces.erase(edited.surfaces.begin() + index);
  for (ZoomPosition& position : edited.zoom)
    for (auto& gap : position.thickness_mm)
      if (gap.first > index) --gap.first;
  return checked(std::move(edited));
}

Result<Prescription> scaled_lens(const Prescription& lens, double factor) {
  if (!(factor > 0) || !std::isfinite(factor)) return invalid_argument("the factor is above 0");
  Prescription edited = lens;
  for (Surface& surface : edited.surfaces) {
    surface.curvature_per_mm /= factor;
    surface.shape.curvature_x_per_mm /= factor;
    surface.thickness_mm *= factor;
    surface.semi_diameter_mm *= factor;
    surface.pose.shift_mm = surface.pose.shift_mm * factor;
    for (std::size_t p = 0; p < surface.shape.powers.size(); ++p)
      surface.shape.powers[p] *= std::pow(factor, -static_cast<double>(p));  // mm^(1 - p) of r^p, p from 1
  }
  for (ZoomPosition& position : edited.zoom) {
    position.focal_length_mm *= factor;
    for (auto& gap : position.thickness_mm) gap.second *= factor;
  }
  if (edited.sensor_distance_mm) *edited.sensor_distance_mm *= factor;
  edited.stated = {};
  return checked(std::move(edited));
}

Result<Prescription> reversed_lens(const Prescription& lens) {
  if (!lens.zoom.empty()) return failure(ErrorCode::Unsupported, "a zoom lens is not reversed");
  for (const Surface& surface : lens.surfaces)
    if (!(surface.pose == SurfacePose{}))
      return failure(ErrorCode::Unsupported, "a lens with tilted or decentred surfaces is not reversed");
  Prescription edited = lens;
  const std::size_t count = lens.surfaces.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t from = count - 1 - k;
    const double gap = from > 0 ? lens.surfaces[from - 1].thickness_mm : 0.0;
    edited.surfaces[k] = reversed_surface(lens.surfaces[from], medium_before(lens, from), gap);
  }
  edited.sensor_distance_mm.reset();
  edited.stated = {};
  return checked(std::move(edited));
}

std::vector<std::string> glasses_like(std::string_view text, std::size_t count) {
  std::vector<std::string> names;
  const std::string start = lower(text);
  const GlassCatalogue& glasses = bundled_glasses();
  for (std::size_t k = 0; k < glasses.size() && names.size() < count; ++k) {
    std::string name = glasses.summary(k).name;
    if (lower(name).starts_with(start) && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(std::move(name));
  }
  return names;
}

std::vector<std::string> glasses_near(std::string_view text, std::size_t count) {
  std::vector<std::string> near;
  for (std::size_t length = text.size(); length > 0 && near.empty(); --length)
    near = glasses_like(text.substr(0, length), count);
  return near;
}

}  // namespace contrejour::studio
