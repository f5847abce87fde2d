// SPDX-License-Identifier: Apache-2.0
// DeepLens' refractive lenses (docs/formats/deeplens.md).
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/json/json_lens.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/design_text.h"
#include "optics/lens_files/tables/heights.h"

namespace contrejour::inline internal {
namespace {

class DeepLensReader {
 public:
  DeepLensReader(const JsonField& root, const LensText& in)
      : errors_{in.file, {}}, root_(root.reporting_to(errors_)), finder_(in.glasses) {
    lens_.file = {in.file, 0, 0};
    lens_.name = stem_of(in.file);
    lens_.source = root_["info"].text();
    if (lens_.source.empty() || lens_.source == "None") lens_.source = "a DeepLens file that does not say it";
  }

  [[nodiscard]] Result<Prescription> read() {
    if (root_["DOE"].is_there())
      root_["DOE"].fail("a diffractive element; lenses that refract alone are computed", ErrorCode::Unsupported);
    const JsonField surfaces = root_["surfaces"];
    refuse_many_surfaces(surfaces);
    for (std::size_t k = 0; k < surfaces.size() && !errors_.first; ++k) read_surface(surfaces[k]);
    if (lens_.surfaces.empty()) surfaces.fail("no surface refracts");
    if (errors_.first) return stopped_by(errors_);
    add_stop();
    read_figures();
    if (errors_.first) return stopped_by(errors_);
    keep_sensor_without_image(lens_);
    auto lens = completed(std::move(lens_));
    if (lens) compare_f_number(*lens);
    return lens;
  }

 private:
  void read_surface(const JsonField& in) {
    const std::string type = lower_case(in["type"].text());
    if (type == "sensor") return;
    Surface surface;
    surface.source_line = in.line();
    surface.glass_after = medium_;
    surface.thickness_mm = in["d_next"].required_number();
    if (type == "aperture" || type == "stop") {
      surface.kind = SurfaceKind::Stop;
    } else if (type == "anamorphic") {
      set_cylinder(in, surface);
      surface.glass_after = glass_of(in["mat2"]);
    } else if (type == "spheric" || type == "aspheric" || type == "plane") {
      if (type != "plane") set_shape(in, surface);
      surface.glass_after = glass_of(in["mat2"]);
    } else {
      in["type"].fail(fmt::format("'{}' is not computed; Spheric, Aspheric, Anamorphic, Plane and Aperture are",
                                  shortened(in["type"].text())),
                      ErrorCode::Unsupported);
    }
    set_rim(in, surface);
    medium_ = surface.glass_after;
    lens_.surfaces.push_back(std::move(surface));
  }

  // A square plane is given by its side.
  static void set_rim(const JsonField& in, Surface& surface) {
    if (in["r"].is_there() || !in["l"].is_there()) {
      surface.semi_diameter_mm = std::abs(in["r"].required_number());
      return;
    }
    const double half_mm = 0.5 * std::abs(in["l"].required_number());
    surface.semi_diameter_mm = half_mm * std::sqrt(2.0);
    if (surface.kind == SurfaceKind::Refracting)
      surface.aperture = {.kind = ApertureKind::Rectangle, .half_mm = {half_mm, half_mm}};
  }

  static double curvature_of(const JsonField& in, const char* radius, const char* curvature) {
    return in[radius].is_there() ? curvature_of_radius(in[radius].number_or(0.0))
                                 : tidy_curvature(in[curvature].required_number());
  }

  // Curved along x or along y.
  static void set_cylinder(const JsonField& in, Surface& surface) {
    surface.curvature_per_mm = curvature_of(in, "roc_y", "cy");
    surface.shape = {.kind = ShapeKind::Biconic, .curvature_x_per_mm = curvature_of(in, "roc_x", "cx")};
    if (surface.curvature_per_mm != 0.0 && surface.shape.curvature_x_per_mm != 0.0)
      in["type"].fail("curved along x and along y; one of them is computed", ErrorCode::Unsupported);
  }

  // Coefficients of r^2, r^4, ...
  static void set_shape(const JsonField& in, Surface& surface) {
    surface.curvature_per_mm = curvature_of(in, "roc", "c");
    surface.shape.conic = in["k"].number_or(0.0);
    add_powers(in["ai"], 2, 2, surface.shape);
  }

  // "air", "1.6204/60.31" or a name.
  Glass glass_of(const JsonField& in) {
    const std::string name = in.text();
    if (name == "air" || name == "vacuum" || name == "occluder") return air();
    const std::size_t slash = name.find('/');
    if (slash != std::string::npos) {
      const auto n_d = plain_number(name.substr(0, slash)), v_d = plain_number(name.substr(slash + 1));
      if (n_d && v_d) return {"", AbbeGlass{*n_d, *v_d}};
    }
    const auto found = finder_.find(name);
    if (found) return *found;
    in.fail(name.empty() ? "is missing; give the medium behind" : found.error().message);
    return air();
  }

  // Without an aperture DeepLens takes the narrowest surface.
  void add_stop() {
    const auto is_stop = [](const Surface& s) { return s.kind == SurfaceKind::Stop; };
    auto& rows = lens_.surfaces;
    if (std::any_of(rows.begin(), rows.end(), is_stop)) return;
    const auto narrowest = std::min_element(rows.begin(), rows.end(), [](const Surface& a, const Surface& b) {
      return a.semi_diameter_mm < b.semi_diameter_mm;
    });
    Surface stop;
    stop.kind = SurfaceKind::Stop;
    stop.source_line = narrowest->source_line;
    stop.semi_diameter_mm = narrowest->semi_diameter_mm;
    stop.glass_after = narrowest == rows.begin() ? air() : std::prev(narrowest)->glass_after;
    lens_.warnings.push_back(
        fmt::format("no aperture; the stop is taken at the narrowest surface (line {})", stop.source_line));
    rows.insert(narrowest, stop);
  }

  void read_figures() {
    const auto positive = [&](const char* key) {
      const auto value = root_[key].number();
      return value && *value > 0.0 && std::isfinite(*value) ? value : std::nullopt;
    };
    lens_.stated.focal_length_mm = positive("foclen");
    const double back_mm = lens_.surfaces.back().thickness_mm;
    if (back_mm > 0.0) lens_.stated.back_focal_distance_mm = back_mm;
    const JsonField size = root_["sensor_size"];
    const double width_mm = size[0].number_or(0.0), height_mm = size[1].number_or(0.0);
    const auto radius_mm = positive("r_sensor") ? positive("r_sensor") : positive("r_last");
    if (width_mm > 0.0 && height_mm > 0.0 && std::isfinite(width_mm + height_mm)) {
      lens_.sensor_width_mm = width_mm;
      lens_.sensor_height_mm = height_mm;
    } else if (radius_mm) {
      lens_.sensor_width_mm = lens_.sensor_height_mm = *radius_mm * std::sqrt(2.0);
    }
  }

  // DeepLens traces the aperture; its `fnum` may stem from another state of the lens.
  void compare_f_number(Prescription& lens) const {
    constexpr double kTolerance = 0.1;
    const double stated = root_["fnum"].number_or(0.0);
    if (stated > 0.0 && !(std::abs(lens.f_number / stated - 1.0) <= kTolerance))
      lens.warnings.push_back(fmt::format("fnum is {:.4g} (line {}), while the aperture's whole opening gives f/{:.3g}",
                                          stated, root_["fnum"].line(), lens.f_number));
  }

  JsonErrors errors_;
  JsonField root_;
  GlassFinder finder_;
  Prescription lens_;
  Glass medium_ = air();
};

}  // namespace

bool is_deeplens(const JsonField& root) {
  const JsonField first = root["surfaces"][0];
  return first["type"].is_text() && (first["d_next"].is_there() || first["mat2"].is_there());
}

Result<Prescription> read_deeplens(const JsonField& root, const LensText& in) {
  return DeepLensReader(root, in).read();
}

}  // namespace contrejour::inline internal
