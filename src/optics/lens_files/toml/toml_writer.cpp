// SPDX-License-Identifier: Apache-2.0
// Writes docs/formats/lens-toml.md; reading it back gives the same numbers, bit for bit.
#include <map>

#include <fmt/format.h>

#include "base/toml_fields.h"
#include "contrejour/expert/film_design.h"
#include "contrejour/lens.h"
#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/toml/toml_formula.h"
#include "optics/lens_files/toml/toml_shape.h"
#include "optics/lens_files/toml/toml_values.h"

namespace contrejour {

namespace {

struct DispersionText {
  std::string operator()(const ConstantIndex& glass) const { return "n = " + toml_number(glass.n); }
  std::string operator()(const AbbeGlass& glass) const {
    return fmt::format("n_d = {}, v_d = {}", toml_number(glass.n_d), toml_number(glass.v_d));
  }
  std::string operator()(const Sellmeier& glass) const {
    const auto list = [](const std::array<double, 3>& v) {
      return fmt::format("[{}, {}, {}]", toml_number(v[0]), toml_number(v[1]), toml_number(v[2]));
    };
    return fmt::format("sellmeier_b = {}, sellmeier_c_um2 = {}", list(glass.b), list(glass.c_um2));
  }
  std::string operator()(const ModelGlass& glass) const {
    return fmt::format("n_d = {}, v_d = {}, d_pgf = {}", toml_number(glass.n_d), toml_number(glass.v_d),
                       toml_number(glass.d_pgf));
  }
  std::string operator()(const CatalogueGlass& glass) const { return formula_text(glass.data()); }
};

struct FilmsText {
  std::string operator()(const Bare&) const { return {}; }
  std::string operator()(const QuarterWave& film) const {
    return fmt::format("quarter_wave_nm = {}, n = {}", toml_number(film.lambda0_nm), toml_number(film.n));
  }
  std::string operator()(const HullinFresnelAR& film) const {
    return fmt::format("hullin_nm = {}, n = {}", toml_number(film.lambda0_nm), toml_number(film.n));
  }
  std::string operator()(const FilmStack& stack) const {
    std::string rows;
    for (const FilmLayer& layer : stack.layers) {
      rows += fmt::format("{}{{ {}, thickness_nm = {} }}", rows.empty() ? "" : ", ", material_text(layer.material),
                          toml_number(layer.thickness_nm));
    }
    return fmt::format("layers = [{}]", rows);
  }
  std::string operator()(const DesignedCoating& coating) const {
    return fmt::format("design = {}, design_nm = {}", toml_string(design_name(coating)),
                       toml_number(coating.lambda0_nm));
  }
  std::string operator()(const MeasuredCoating& measured) const {
    return fmt::format("measured_nm = {}, measured_deg = {}, reflectance = {}", list(measured.lambda_nm),
                       list(measured.angle_deg), list(measured.reflectance));
  }

 private:
  static std::string material_text(const FilmMaterial& material) {
    if (!material.name.empty()) return "material = " + toml_string(material.name);
    const std::string k = material.n.imag() == 0.0 ? "" : fmt::format(", k = {}", toml_number(material.n.imag()));
    return fmt::format("n = {}{}", toml_number(material.n.real()), k);
  }
  static std::string list(const std::vector<double>& values) {
    std::string text;
    for (const double v : values) text += (text.empty() ? "" : ", ") + toml_number(v);
    return "[" + text + "]";
  }
};

std::string keys_of(const Glass& glass) { return std::visit(DispersionText{}, glass.dispersion); }
std::string keys_of(const Coating& coating) { return std::visit(FilmsText{}, coating.films); }

// Writes named media to a table at the end of the file; a medium without a name, or with a name that is taken, is
// written in the surface's row.
class MediaTable {
 public:
  template <class Medium>
  std::string reference(const Medium& medium) {
    const std::string keys = keys_of(medium);
    if (medium.name.empty()) return fmt::format("{{ {} }}", keys);
    const std::string inline_text = fmt::format("{{ name = {}, {} }}", toml_string(medium.name), keys);
    if (is_reserved_name(medium.name)) return inline_text;
    if (is_known(medium)) {
      const auto [entry, is_new] = keys_.emplace(medium.name, "");
      return entry->second.empty() ? toml_string(medium.name) : inline_text;
    }
    const auto [entry, is_new] = keys_.emplace(medium.name, keys);
    return entry->second == keys ? toml_string(medium.name) : inline_text;
  }

  [[nodiscard]] std::string text(std::string_view title) const {
    std::string rows;
    for (const auto& [name, keys] : keys_) {
      if (!keys.empty()) rows += fmt::format("{} = {{ {} }}\n", toml_string(name), keys);
    }
    return rows.empty() ? rows : fmt::format("\n[{}]\n{}", title, rows);
  }

 private:
  // True if reading the name alone gives this medium.
  bool is_known(const Glass& glass) {
    const bool by_name = std::holds_alternative<ModelGlass>(glass.dispersion) ||
                         std::holds_alternative<CatalogueGlass>(glass.dispersion);
    if (!by_name) return false;
    const auto found = finder_.find(glass.name);
    return found && *found == glass;
  }
  static bool is_known(const Coating&) { return false; }

  std::map<std::string, std::string> keys_;  // empty: known by name, needs no row
  GlassFinder finder_;
};

std::string surface_row(const Surface& surface, bool last, MediaTable& glasses, MediaTable& coatings) {
  std::string row = "  { ";
  row += surface.kind == SurfaceKind::Stop ? "stop = true" : curvature_text(surface.curvature_per_mm, "");
  if (!last) row += ", thickness_mm = " + toml_number(surface.thickness_mm);
  row += ", semi_diameter_mm = " + toml_number(surface.semi_diameter_mm) + shape_text(surface.shape) +
         aperture_text(surface.aperture) + obscuration_text(surface.obscuration) + pose_text(surface.pose);
  if (surface.kind == SurfaceKind::Refracting) {
    if (!(surface.glass_after == air())) row += ", glass = " + glasses.reference(surface.glass_after);
    if (!std::holds_alternative<Bare>(surface.coating.films)) {
      row += ", coating = " + coatings.reference(surface.coating);
    }
  }
  return row + " },\n";
}

std::string zoom_rows(const std::vector<ZoomPosition>& zoom) {
  if (zoom.empty()) return {};
  std::string out = "\nzoom = [\n";
  for (const ZoomPosition& position : zoom) {
    std::string gaps;
    for (const auto& [index, thickness_mm] : position.thickness_mm) {
      gaps += fmt::format("{}{} = {}", gaps.empty() ? "" : ", ", index + 1, toml_number(thickness_mm));
    }
    out += fmt::format("  {{ focal_length_mm = {}, thickness_mm = {{ {} }} }},\n",
                       toml_number(position.focal_length_mm), gaps);
  }
  return out + "]\n";
}

std::string stated_table(const StatedFigures& stated) {
  std::string out = "\n[stated]\n";
  if (stated.focal_length_mm) out += fmt::format("focal_length_mm = {}\n", toml_number(*stated.focal_length_mm));
  if (stated.back_focal_distance_mm) {
    out += fmt::format("back_focal_distance_mm = {}\n", toml_number(*stated.back_focal_distance_mm));
  }
  out += fmt::format("wavelength_nm = {}\n", toml_number(stated.wavelength_nm));
  return out + fmt::format("tolerance = {}\n", toml_number(stated.tolerance));
}

}  // namespace

std::string write_lens_toml(const Prescription& lens) {
  MediaTable glasses, coatings;
  std::string out = fmt::format("name = {}\nsource = {}\nf_number = {}\nsensor_mm = [{}, {}]\n", toml_string(lens.name),
                                toml_string(lens.source), toml_number(lens.f_number), toml_number(lens.sensor_width_mm),
                                toml_number(lens.sensor_height_mm));
  if (lens.sensor_distance_mm) out += fmt::format("sensor_distance_mm = {}\n", toml_number(*lens.sensor_distance_mm));
  out += "\nsurfaces = [\n";
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    out += surface_row(lens.surfaces[i], i + 1 == lens.surfaces.size(), glasses, coatings);
  }
  out += "]\n" + zoom_rows(lens.zoom) + stated_table(lens.stated);
  return out + glasses.text("glass") + coatings.text("coating");
}

}  // namespace contrejour
