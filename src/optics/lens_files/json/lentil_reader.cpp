// SPDX-License-Identifier: Apache-2.0
// Lentil's database of lenses (docs/formats/lentil.md): many in one file, by their keys.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/near_name.h"
#include "contrejour/expert/first_order.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/json/json_lens.h"
#include "optics/lens_files/missing_stop.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/tables/heights.h"

namespace contrejour::inline internal {
namespace {

constexpr std::string_view kElements = "optical-elements-patent";
constexpr double kPlane_mm = 99999.0;  // and more: how the database writes planes

bool is_entry(const JsonField& field) { return field[kElements].is_list(); }

// "company product-name year (key)", without the parts that are missing.
std::string name_of(const JsonField& entry, std::string_view key) {
  std::string name;
  for (const char* part : {"company", "product-name"}) {
    const std::string word = entry[part].text();
    if (!word.empty()) name += (name.empty() ? "" : " ") + word;
  }
  if (name.empty()) name = "lens of Lentil";
  return key.empty() ? name : fmt::format("{} ({})", name, key);
}

class LentilReader {
 public:
  LentilReader(const JsonField& entry, std::string_view key, const LensText& in)
      : errors_{in.file, {}}, entry_(entry.reporting_to(errors_)), glasses_(in.glasses) {
    lens_.file = {in.file, entry.line(), 0};
    lens_.name = name_of(entry_, key);
    lens_.source = entry_["patent-number"].text();
    if (lens_.source.empty()) lens_.source = "Lentil's database, which does not say it";
  }

  [[nodiscard]] Result<Prescription> read() {
    const JsonField elements = entry_[kElements];
    refuse_many_surfaces(elements);
    for (std::size_t k = 0; k < elements.size() && !errors_.first; ++k) read_element(elements[k]);
    if (lens_.surfaces.empty()) elements.fail("no elements; give the lens's surfaces");
    if (errors_.first) return stopped_by(errors_);
    const double back_mm = lens_.surfaces.back().thickness_mm;
    if (back_mm > 0.0) lens_.stated.back_focal_distance_mm = back_mm;
    state_focal_length();
    if (errors_.first) return stopped_by(errors_);
    if (const auto placed = place_missing_stop(lens_); !placed) return tl::unexpected(placed.error());
    keep_sensor_without_image(lens_);
    return completed(std::move(lens_));
  }

 private:
  void read_element(const JsonField& element) {
    Surface surface;
    surface.source_line = element.line();
    const JsonField thickness = element["thickness"];
    if (thickness.is_list())
      return thickness.fail("several thicknesses: zooms of Lentil are not read; give one", ErrorCode::Unsupported);
    surface.thickness_mm = thickness.required_number();
    const JsonField rim = element["housing-radius"];
    surface.semi_diameter_mm = (rim.is_there() ? rim : element["housing_radius"]).required_number();
    surface.glass_after = medium_;
    if (lower_case(element["material"].text()) == "iris") {
      surface.kind = SurfaceKind::Stop;
    } else {
      surface.glass_after = glass_of(element);
      read_shape(element, surface);
    }
    medium_ = surface.glass_after;
    lens_.surfaces.push_back(std::move(surface));
  }

  Glass glass_of(const JsonField& element) {
    const std::string material = element["material"].text();
    if (lower_case(material) == "air") return air();
    const std::string name = lower_case(material) == "abbe" ? "" : material;
    const auto n_d = element["ior"].number();
    const double v_d = element["abbe"].number_or(0.0);
    if (n_d && *n_d == 1.0) return air();
    if (n_d) return v_d == 0.0 ? Glass{"", ConstantIndex{*n_d}} : Glass{"", AbbeGlass{*n_d, v_d}};
    const auto found = glasses_.find(name);
    if (found) return *found;
    element["ior"].fail(name.empty() ? "is missing; give the index" : found.error().message);
    return air();
  }

  // A cyl-y's axis lies along y, so it curves in x.
  void read_shape(const JsonField& element, Surface& surface) {
    const double radius_mm = element["radius"].required_number();
    const double c = std::abs(radius_mm) >= kPlane_mm ? 0.0 : curvature_of_radius(radius_mm);
    const std::string geometry = lower_case(element["lens-geometry"].text());
    if (geometry == "cyl-y") {
      if (c != 0.0) surface.shape = {.kind = ShapeKind::Toroid, .curvature_x_per_mm = c};
      return;
    }
    surface.curvature_per_mm = geometry == "planar" ? 0.0 : c;
    if (geometry == "cyl-x") {
      if (c != 0.0) surface.shape.kind = ShapeKind::Toroid;
    } else if (geometry == "aspherical") {
      add_powers(element["aspherical-equation"], 4, 2, surface.shape);
    } else if (!geometry.empty() && geometry != "spherical" && geometry != "planar") {
      element["lens-geometry"].fail(
          fmt::format("'{}' is not known; spherical, planar, aspherical, cyl-x and cyl-y are", shortened(geometry)));
    }
  }

  // An anamorphic lens has two focal lengths, of which one is stated.
  void state_focal_length() {
    const auto focal_mm = entry_["focal-length-mm-patent"].number();
    if (!focal_mm || !(*focal_mm > 0.0)) return;
    const bool symmetric = std::all_of(lens_.surfaces.begin(), lens_.surfaces.end(),
                                       [](const Surface& s) { return s.shape.has_axial_symmetry(); });
    if (symmetric) {
      lens_.stated.focal_length_mm = focal_mm;
    } else {
      lens_.warnings.push_back(
          fmt::format("the stated focal length of {:g} mm (line {}) is that of one section of an "
                      "anamorphic lens, which is not said; it is not compared",
                      *focal_mm, entry_["focal-length-mm-patent"].line()));
    }
  }

  JsonErrors errors_;
  JsonField entry_;
  GlassFinder glasses_;
  Prescription lens_;
  Glass medium_ = air();
};

std::string first_lens_keys(const JsonField& root) {
  constexpr std::size_t kMaxShown = 10;
  std::string keys;
  std::size_t shown = 0;
  for (std::size_t k = 0; k < root.size() && shown < kMaxShown; ++k)
    if (is_entry(root[k])) keys += fmt::format("{}{}", shown++ == 0 ? "" : ", ", shortened(root.key(k)));
  return keys;
}

}  // namespace

bool is_lentil(const JsonField& root) {
  if (is_entry(root)) return true;
  for (std::size_t k = 0; root.is_map() && k < root.size(); ++k)
    if (is_entry(root[k])) return true;
  return false;
}

Result<Prescription> read_lentil(const JsonField& root, const LensText& in) {
  if (is_entry(root)) return LentilReader(root, "", in).read();
  std::vector<std::size_t> entries;
  for (std::size_t k = 0; k < root.size(); ++k)
    if (is_entry(root[k]) && (in.key.empty() || root.key(k) == in.key)) entries.push_back(k);
  if (entries.size() == 1) return LentilReader(root[entries.front()], root.key(entries.front()), in).read();
  const std::string keys = first_lens_keys(root);
  return failure(ErrorCode::InvalidArgument,
                 in.key.empty() ? fmt::format("{} lenses; name one as FILE#KEY, with a key of {}{}", entries.size(),
                                              keys, entries.size() > 10 ? ", ..." : "")
                                : fmt::format("no lens has the key '{}'; there are {}", shortened(in.key), keys),
                 {in.file, 0, 0});
}

}  // namespace contrejour::inline internal
