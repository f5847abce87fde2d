// SPDX-License-Identifier: Apache-2.0
// Optiland's .json files (docs/formats/optiland.md).
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/json/json_lens.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {
namespace {

// Removes letter case and underscores from a name, since versions of the program differ in both.
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c != '_') out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

class OptilandReader {
 public:
  OptilandReader(const JsonField& root, const LensText& in)
      : errors_{in.file, {}}, root_(root.reporting_to(errors_)), finder_(in.glasses) {
    design_ = design_from("Optiland", in.file);
    design_.name = root_["name"].text();
    design_.source = "an Optiland file, which does not say it";
  }

  [[nodiscard]] Result<Prescription> read() {
    const JsonField surfaces = root_["surface_group"]["surfaces"];
    if (!surfaces.is_list()) surfaces.fail("is missing; give the list of surfaces");
    refuse_many_surfaces(surfaces);
    for (std::size_t k = 0; k < surfaces.size() && !errors_.first; ++k) read_surface(surfaces[k], k);
    set_thicknesses();
    read_aperture(root_["aperture"]);
    read_fields(root_["fields"]);
    read_wavelength(root_["wavelengths"]);
    if (errors_.first) return stopped_by(errors_);
    return prescription_of(design_);
  }

 private:
  void read_surface(const JsonField& in, std::size_t index) {
    const std::string type = in["type"].text();
    const bool known = type.empty() || type == "Surface" || type == "StandardSurface" || type == "ObjectSurface" ||
                       type == "ImageSurface";
    if (!known)
      in["type"].fail(fmt::format("a {}; surfaces of glass are computed", shortened(type)), ErrorCode::Unsupported);
    const JsonField interaction = in["interaction_model"];
    for (const JsonField& mirror : {in["is_reflective"], interaction["is_reflective"]})
      if (mirror.truth()) mirror.fail("mirrors are not computed", ErrorCode::Unsupported);
    const std::string acts = interaction["type"].text();
    if (acts.find("Thin") != std::string::npos || acts.find("Diffract") != std::string::npos ||
        acts.find("Phase") != std::string::npos)
      interaction["type"].fail(fmt::format("a {}; surfaces that refract are computed", shortened(acts)),
                               ErrorCode::Unsupported);
    for (const JsonField& coating : {in["coating"], interaction["coating"]})
      if (coating.is_there() && coating["type"].text() != "FresnelCoating")
        design_.warnings.push_back(
            fmt::format("the coating of surface {} (line {}) is not read; it is bare", index, coating.line()));
    DesignSurface surface;
    surface.line = in.line();
    surface.is_stop = in["is_stop"].truth();
    read_geometry(in["geometry"], surface);
    surface.glass_after = glass_of(in["material_post"]);
    read_opening(in["aperture"], surface);
    design_.surfaces.push_back(std::move(surface));
  }

  void read_geometry(const JsonField& in, DesignSurface& surface) {
    position(in["cs"], surface);
    const std::string type = plain(in["type"].text());
    const auto curvature = [&](const char* key) { return curvature_of_radius(in[key].number_or(0.0)); };
    surface.curvature = curvature("radius");
    surface.shape.conic = in["conic"].number_or(0.0);
    if (type == "plane") {
      surface.curvature = surface.shape.conic = 0.0;
    } else if (type == "evenasphere") {
      add_powers(in["coefficients"], 2, 2, surface.shape);
    } else if (type == "oddasphere") {
      add_powers(in["coefficients"], 1, 1, surface.shape);
    } else if (type == "biconicgeometry" || type == "biconic") {
      surface.curvature = curvature("radius_y");
      surface.shape = {.kind = ShapeKind::Biconic,
                       .conic = in["conic_y"].number_or(0.0),
                       .curvature_x_per_mm = curvature("radius_x"),
                       .conic_x = in["conic_x"].number_or(0.0)};
    } else if (type == "toroidalgeometry" || type == "toroidal") {
      surface.curvature = curvature("radius_yz");
      surface.shape = {.kind = ShapeKind::Toroid,
                       .conic = in["conic_yz"].number_or(0.0),
                       .curvature_x_per_mm = curvature("radius_rotation")};
      add_powers(in["coeffs_poly_y"], 2, 2, surface.shape);
    } else if (type != "standardgeometry" && type != "standard") {
      in["type"].fail(fmt::format("the shape '{}' is not computed; Plane, StandardGeometry, EvenAsphere, OddAsphere, "
                                  "BiconicGeometry and ToroidalGeometry are",
                                  shortened(in["type"].text())),
                      ErrorCode::Unsupported);
    }
  }

  // The pose of a surface in global coordinates: rotated about its own z, y and x, then moved.
  void position(const JsonField& cs, DesignSurface& surface) {
    if (cs["reference_cs"].is_there())
      cs["reference_cs"].fail("coordinates that stand in others are not read; give them in the space of all",
                              ErrorCode::Unsupported);
    const auto value = [&](const char* key) { return cs[key].number_or(0.0); };
    z_.push_back(value("z"));
    surface.own.shift = {value("x"), value("y"), 0.0};
    const std::array<double, 3> turns = {value("rx"), value("ry"), value("rz")};
    for (const double number : {value("x"), value("y"), turns[0], turns[1], turns[2]})
      if (!std::isfinite(number)) return cs.fail("a place beside the axis, or a tilt, is infinite");
    for (int axis = 0; axis < 3; ++axis)
      if (const double rotation_rad = turns[static_cast<std::size_t>(axis)]; rotation_rad != 0.0)
        surface.own = surface.own.then(rotation_about(axis, rotation_rad));
  }

  void set_thicknesses() {
    for (std::size_t k = 0; k + 1 < z_.size() && k + 1 < design_.surfaces.size(); ++k) {
      const double thickness = z_[k + 1] - z_[k];
      if (k == 0 && std::isinf(z_[0])) {
        design_.surfaces[0].thickness = std::numeric_limits<double>::infinity();
      } else if (std::isfinite(thickness)) {
        design_.surfaces[k].thickness = thickness;
      } else {
        return errors_.fail(design_.surfaces[k].line, fmt::format("surface {} stands infinitely far away", k));
      }
    }
  }

  Glass glass_of(const JsonField& in) {
    const std::string type = plain(in["type"].text());
    if (type == "air" || !in.is_there()) return air();
    if (type == "idealmaterial") {
      const double n = in["index"].required_number();
      return n == 1.0 ? air() : Glass{"", ConstantIndex{n}};
    }
    if (type == "abbematerial") return {"", ModelGlass{in["index"].required_number(), in["abbe"].required_number()}};
    if (type == "mirror") {
      in.fail("mirrors are not computed", ErrorCode::Unsupported);
    } else if (type == "material") {
      return named_glass(in);
    } else {
      in["type"].fail(fmt::format("the material '{}' is not known; IdealMaterial, AbbeMaterial and Material are",
                                  shortened(in["type"].text())),
                      ErrorCode::Unsupported);
    }
    return air();
  }

  // A page of refractiveindex.info by its name; the path or the reference gives the maker.
  Glass named_glass(const JsonField& in) {
    const std::string name = in["name"].text();
    const std::string path = plain(in["filename"].text()) + "/" + plain(in["reference"].text());
    std::vector<std::string> makers;
    for (const char* maker : {"schott", "ohara", "hoya", "hikari", "sumita", "cdgm", "nsg", "lzos", "corning"})
      if (path.find(maker) != std::string::npos) makers.emplace_back(maker);
    auto found = finder_.find(name, makers);
    if (!found && !makers.empty()) found = finder_.find(name);
    if (found) return *found;
    in["name"].fail(found.error().message);
    return air();
  }

  void read_opening(const JsonField& in, DesignSurface& surface) {
    if (!in.is_there()) return;
    const std::string type = plain(in["type"].text());
    DesignOpening opening;
    opening.line = in.line();
    opening.centre = {in["offset_x"].number_or(0.0), in["offset_y"].number_or(0.0)};
    if (type == "radialaperture" || type == "offsetradialaperture") {
      opening.half_x = opening.half_y = in["r_max"].number_or(0.0);
      const double r_min = in["r_min"].number_or(0.0);
      if (r_min > 0.0) surface.obscuration = {{r_min, r_min}, opening.centre, 0.0};
    } else if (type == "rectangularaperture") {
      opening.shape = OpeningShape::Rectangle;
      const double left = in["x_min"].required_number(), right = in["x_max"].required_number();
      const double low = in["y_min"].required_number(), high = in["y_max"].required_number();
      opening.half_x = 0.5 * (right - left);
      opening.half_y = 0.5 * (high - low);
      opening.centre = {0.5 * (left + right), 0.5 * (low + high)};
    } else if (type == "ellipticalaperture") {
      opening.shape = OpeningShape::Ellipse;
      opening.half_x = in["a"].required_number();
      opening.half_y = in["b"].required_number();
    } else {
      design_.warnings.push_back(fmt::format(
          "the aperture (line {}) is of a kind that is not read; the surface is as large as its beam", in.line()));
      return;
    }
    const bool sized = opening.half_x > 0.0 && opening.half_y > 0.0 && std::isfinite(opening.half_x + opening.half_y) &&
                       std::isfinite(length(opening.centre));
    if (sized) surface.opening = opening;
  }

  void read_aperture(const JsonField& in) {
    const JsonField key = in["type"].is_there() ? in["type"] : in["ap_type"];
    const std::string type = plain(key.text());
    design_.aperture_value = in["value"].required_number();
    if (type == "epd") {
      design_.aperture = DesignAperture::EntrancePupil;
    } else if (type == "imagefno") {
      design_.aperture = DesignAperture::FNumber;
    } else if (type == "paraxialimagefno" || type == "imagena") {
      design_.aperture = DesignAperture::WorkingFNumber;
      if (type == "imagena") design_.aperture_value = 0.5 / design_.aperture_value;
    } else if (type == "objectna") {
      design_.aperture = DesignAperture::ObjectNA;
    } else if (type == "floatbystopsize") {
      design_.aperture = DesignAperture::ByStop;
      for (DesignSurface& surface : design_.surfaces)
        if (surface.is_stop) surface.semi_diameter = 0.5 * design_.aperture_value;
    } else {
      key.fail(fmt::format("the aperture '{}' is not known; EPD, imageFNO, objectNA and float_by_stop_size are",
                           shortened(key.text())));
    }
    if (!(design_.aperture_value > 0.0)) in["value"].fail("is not more than 0");
  }

  void read_fields(const JsonField& in) {
    const JsonField list = in["fields"];
    JsonField key = in["field_type"];
    if (!key.is_there()) key = in["field_definition"]["field_type"];
    if (!key.is_there() && list.size() > 0) key = list[0]["field_type"];
    const std::string type = plain(key.text());
    if (type.find("image") != std::string::npos) {
      design_.field = FieldKind::ImageHeight;
    } else if (type.find("object") != std::string::npos) {
      design_.field = FieldKind::ObjectHeight;
    } else if (!type.empty() && type.find("angle") == std::string::npos) {
      key.fail(fmt::format("the field '{}' is not known; angle, object_height and image heights are",
                           shortened(key.text())));
    }
    for (std::size_t k = 0; k < list.size(); ++k)
      design_.largest_field =
          std::max(design_.largest_field, std::hypot(list[k]["x"].number_or(0.0), list[k]["y"].number_or(0.0)));
    if (!std::isfinite(design_.largest_field)) list.fail("a field is infinite");
  }

  void read_wavelength(const JsonField& in) {
    const JsonField list = in["wavelengths"];
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (!list[k]["is_primary"].truth() && list.size() > 1) continue;
      const std::string unit = list[k]["unit"].text();
      const double to_nm = unit == "nm" ? 1.0 : unit == "mm" ? 1e6 : unit == "m" ? 1e9 : 1e3;
      design_.wavelength_nm = list[k]["value"].required_number() * to_nm;
    }
  }

  JsonErrors errors_;
  JsonField root_;
  GlassFinder finder_;
  SequentialDesign design_;
  std::vector<double> z_;  // of each surface
};

}  // namespace

bool is_optiland(const JsonField& root) { return root["surface_group"].is_map(); }

Result<Prescription> read_optiland(const JsonField& root, const LensText& in) {
  return OptilandReader(root, in).read();
}

}  // namespace contrejour::inline internal
