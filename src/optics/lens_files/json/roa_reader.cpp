// SPDX-License-Identifier: Apache-2.0
// ray-optics' .roa files (docs/formats/ray-optics.md): a tree of Python objects in JSON.
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/units.h"
#include "optics/lens_files/json/json_lens.h"
#include "optics/lens_files/json/roa_media.h"
#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {
namespace {

constexpr double kDistant = 1e8;  // an object farther away is infinitely far
constexpr double kUnsetAperture = 1.0;  // max_aperture of a new surface

struct Unit {
  std::string_view name;
  double mm;
};
constexpr Unit kUnits[] = {{"mm", 1.0}, {"cm", 10.0}, {"m", 1000.0}, {"in", 25.4}, {"inch", 25.4}, {"inches", 25.4}};

// The first of the names that is there.
JsonField either(const JsonField& field, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (field[name].is_there()) return field[name];
  return field[*names.begin()];
}

class RoaReader {
 public:
  RoaReader(const JsonField& root, const LensText& in)
      : errors_{in.file, {}}, model_(content_of(root.reporting_to(errors_)["optical_model"])),
        sequence_(content_of(model_["seq_model"])), finder_(in.glasses) {
    design_ = design_from("ray-optics", in.file);
  }

  [[nodiscard]] Result<Prescription> read() {
    read_system();
    read_surfaces();
    read_stop();
    read_light();
    if (errors_.first) return stopped_by(errors_);
    return prescription_of(design_);
  }

 private:
  void read_system() {
    const JsonField system = content_of(either(model_, {"system_spec", "sys_spec"}));
    design_.name = system["title"].text();
    design_.source = "a ray-optics file, which does not say it";
    const JsonField dimensions = either(system, {"_dimensions", "dimensions"});
    const std::string unit = lower_case(dimensions.text());
    for (const Unit& known : kUnits)
      if (known.name == unit) design_.unit_mm = known.mm;
    if (!unit.empty() && design_.unit_mm == 1.0 && unit != "mm")
      dimensions.fail(fmt::format("the unit '{}' is not known; mm, cm, m and inches are", shortened(unit)));
  }

  void read_surfaces() {
    const JsonField surfaces = sequence_["ifcs"], gaps = sequence_["gaps"];
    refuse_many_surfaces(surfaces);
    if (!surfaces.is_list() || gaps.size() + 1 != surfaces.size())
      sequence_.fail(fmt::format("has {} surfaces and {} gaps; one gap stands between two surfaces", surfaces.size(),
                                 gaps.size()));
    for (std::size_t k = 0; k < surfaces.size() && !errors_.first; ++k) {
      design_.surfaces.push_back(surface_of(surfaces[k]));
      if (k < gaps.size()) read_gap(content_of(gaps[k]), design_.surfaces.back());
    }
    if (errors_.first || design_.surfaces.empty()) return;
    double& object = design_.surfaces.front().thickness;
    if (std::abs(object) >= kDistant) object = std::numeric_limits<double>::infinity();
    forget_unset_apertures();
  }

  void read_gap(const JsonField& gap, DesignSurface& in_front) {
    in_front.thickness = gap["thi"].number_or(0.0);
    in_front.glass_after = roa_glass(gap["medium"], finder_);
  }

  DesignSurface surface_of(const JsonField& object) {
    const JsonField content = content_of(object);
    DesignSurface surface;
    surface.line = object.line();
    const std::string type = class_of(object);
    if (type != "Surface")
      object.fail(
          fmt::format("is a {}; surfaces of glass are computed", type.empty() ? "nameless thing" : shortened(type)),
          ErrorCode::Unsupported);
    const JsonField mode = either(content, {"interact_mode", "refract_mode"});
    if (lower_case(mode.text()).starts_with("refl") || lower_case(mode.text()) == "phantom")
      mode.fail(fmt::format("'{}': surfaces that refract are computed", shortened(mode.text())),
                ErrorCode::Unsupported);
    if (content["phase_element"].is_there())
      content["phase_element"].fail("diffractive and holographic surfaces are not computed", ErrorCode::Unsupported);
    const JsonField aperture = content["max_aperture"];
    surface.semi_diameter = std::max(aperture.number_or(0.0), 0.0);
    if (std::isinf(surface.semi_diameter)) surface.semi_diameter = 0.0;
    read_profile(
        content["profile"].is_there() ? content["profile"] : model_["profile_dict"][content["profile_id"].text()],
        surface);
    read_decentre(content["decenter"], surface);
    read_opening(content["clear_apertures"], surface);
    return surface;
  }

  // RadialPolynomial's list begins with the linear term; an older list of eleven with the constant.
  void read_profile(const JsonField& object, DesignSurface& surface) {
    const std::string type = class_of(object);
    const JsonField content = content_of(object);
    surface.curvature = content["cv"].number_or(0.0);
    surface.shape.conic = content["cc"].is_there() ? content["cc"].number_or(0.0) : content["ec"].number_or(1.0) - 1.0;
    if (type == "Spherical") {
      surface.shape.conic = 0.0;
    } else if (type == "EvenPolynomial") {
      add_powers(content["coefs"], 2, 2, surface.shape);
    } else if (type == "RadialPolynomial") {
      constexpr std::size_t kFromConstant = 11;
      add_powers(content["coefs"], content["coefs"].size() == kFromConstant ? 0 : 1, 1, surface.shape);
    } else if (type == "YToroid" || type == "XToroid") {
      add_powers(content["coefs"], 2, 2, surface.shape);
      surface.shape.kind = ShapeKind::Toroid;
      surface.shape.curvature_x_per_mm = content["cR"].number_or(0.0);
      constexpr double kQuarterTurn_rad = 1.5707963267948966;
      if (type == "XToroid") surface.shape.rotation_rad = kQuarterTurn_rad;
    } else if (type != "Conic") {
      object.fail(fmt::format("the profile '{}' is not known; Spherical, Conic, EvenPolynomial, RadialPolynomial, "
                              "YToroid and XToroid are",
                              shortened(type)),
                  ErrorCode::Unsupported);
    }
  }

  // 'decenter' moves all surfaces that follow, 'dec and return' this surface alone.
  static void read_decentre(const JsonField& object, DesignSurface& surface) {
    if (!object.is_there()) return;
    const JsonField content = content_of(object);
    const std::string type = lower_case(either(content, {"dtype", "type"}).text());
    const auto component = [&](const char* name, std::size_t k) {
      const JsonField vector = content[name];
      return (vector["__ndarray__"].is_list() ? vector["__ndarray__"][k] : vector[k]).number_or(0.0);
    };
    const Vec3 shift{component("dec", 0), component("dec", 1), component("dec", 2)};
    for (std::size_t k = 0; k < 3; ++k)
      if (component("euler", k) != 0.0)
        return object.fail("tilted surfaces of ray-optics are not read; those that are decentred are",
                           ErrorCode::Unsupported);
    if (shift == Vec3{}) return;
    if (type == "dec and return" || type == "dar") {
      surface.own.shift = shift;
    } else if (type == "decenter" || type == "local" || type == "dec") {
      surface.move.shift = shift;
    } else {
      object.fail(
          fmt::format("decentred by '{}', which is not read; 'decenter' and 'dec and return' are", shortened(type)),
          ErrorCode::Unsupported);
    }
  }

  // Reads the first clear aperture and the first obscuration.
  void read_opening(const JsonField& list, DesignSurface& surface) {
    for (std::size_t k = 0; k < list.size(); ++k) {
      const JsonField object = list[k];
      const bool obscures = content_of(object)["is_obscuration"].truth();
      if (obscures ? surface.obscuration.any() : surface.opening.has_value()) {
        design_.warnings.push_back(fmt::format("of several {} (line {}) the first is used",
                                               obscures ? "obscurations" : "clear apertures", object.line()));
        continue;
      }
      const std::optional<DesignOpening> opening = opening_of(object);
      if (!opening) continue;
      if (!obscures) {
        surface.opening = opening;
      } else if (opening->shape == OpeningShape::Rectangle) {
        design_.warnings.push_back(
            fmt::format("a rectangular obscuration (line {}) is not computed; light goes through", object.line()));
      } else {
        surface.obscuration = {{opening->half_x, opening->half_y}, opening->centre, opening->rotation_rad};
      }
    }
  }

  // None if it has no size, or something is wrong with it.
  static std::optional<DesignOpening> opening_of(const JsonField& object) {
    const std::string type = class_of(object);
    const JsonField content = content_of(object);
    DesignOpening opening;
    opening.line = object.line();
    opening.rotation_rad = rad_from_deg(content["rotation"].number_or(0.0));
    if (!std::isfinite(opening.rotation_rad)) {
      content["rotation"].fail("is infinite");
      return std::nullopt;
    }
    opening.centre = {content["x_offset"].number_or(0.0), content["y_offset"].number_or(0.0)};
    if (type == "Circular") {
      opening.half_x = opening.half_y = content["radius"].required_number();
    } else if (type == "Rectangular" || type == "Elliptical") {
      opening.shape = type == "Rectangular" ? OpeningShape::Rectangle : OpeningShape::Ellipse;
      opening.half_x = content["x_half_width"].required_number();
      opening.half_y = content["y_half_width"].required_number();
    } else {
      object.fail(
          fmt::format("the aperture '{}' is not known; Circular, Rectangular and Elliptical are", shortened(type)),
          ErrorCode::Unsupported);
      return std::nullopt;
    }
    return opening.half_x > 0.0 && opening.half_y > 0.0 ? std::optional(opening) : std::nullopt;
  }

  // A model whose apertures were never computed has the same value for all.
  void forget_unset_apertures() {
    for (std::size_t k = 1; k + 1 < design_.surfaces.size(); ++k)
      if (design_.surfaces[k].semi_diameter != kUnsetAperture) return;
    for (DesignSurface& surface : design_.surfaces) surface.semi_diameter = 0.0;
  }

  // Without a stop, the entrance pupil is at the first surface.
  void read_stop() {
    if (errors_.first || design_.surfaces.size() < 3) return;
    const JsonField stop = sequence_["stop_surface"];
    const double index = stop.number_or(1.0);
    if (!stop.is_there())
      design_.warnings.push_back("no surface is the stop; it is taken at the first surface, as ray-optics does");
    if (!(index >= 1.0 && index < static_cast<double>(design_.surfaces.size() - 1)))
      return stop.fail(fmt::format("is {:g}; the surfaces between object and image are 1 to {}", index,
                                   design_.surfaces.size() - 2));
    design_.surfaces[static_cast<std::size_t>(index)].is_stop = true;
  }

  void read_light() {
    const JsonField light = content_of(model_["optical_spec"]);
    const JsonField spectrum = content_of(light["spectral_region"]);
    const double reference = spectrum["reference_wvl"].number_or(0.0);
    if (reference >= 0.0 && reference < static_cast<double>(spectrum["wavelengths"].size()))
      design_.wavelength_nm = spectrum["wavelengths"][static_cast<std::size_t>(reference)].number();
    read_pupil(content_of(light["pupil"]));
    read_field(content_of(light["field_of_view"]));
  }

  // ["aperture", "image", "f/#"], or older "FNO".
  void read_pupil(const JsonField& pupil) {
    const JsonField key = either(pupil, {"key", "_key", "pupil_type"});
    const std::string space = key.is_list() ? lower_case(key[1].text()) : "";
    const std::string what = lower_case(key.is_list() ? key[2].text() : key.text());
    const double value = pupil["value"].required_number();
    design_.aperture_value = value;
    const bool image = space == "image" || what == "fno" || what == "na";
    if (what == "epd" || what == "pupil") {
      design_.aperture = DesignAperture::EntrancePupil;
    } else if (what == "f/#" || what == "fno") {
      design_.aperture = image ? DesignAperture::WorkingFNumber : DesignAperture::ObjectNA;
      if (!image) design_.aperture_value = std::sin(std::atan(0.5 / value));
    } else if (what == "na" || what == "nao") {
      design_.aperture = image ? DesignAperture::WorkingFNumber : DesignAperture::ObjectNA;
      if (image) design_.aperture_value = 0.5 / value;
    } else {
      key.fail(fmt::format("the pupil '{}' is not known; epd, f/# and NA are", shortened(what)));
    }
    if (!(value > 0.0)) pupil["value"].fail("is not more than 0");
  }

  // ["field", "object", "angle"], or older "OBJ_ANG".
  void read_field(const JsonField& view) {
    const JsonField key = either(view, {"key", "_key", "field_type"});
    const std::string space = key.is_list() ? lower_case(key[1].text()) : "";
    const std::string what = lower_case(key.is_list() ? key[2].text() : key.text());
    const bool image = space == "image" || what == "img_ht";
    if (what == "angle" || what == "obj_ang") {
      design_.field = FieldKind::Angle_deg;
      if (image)
        design_.warnings.push_back("the field is told by its angle in image space; it is taken in object space");
    } else if (what == "height" || what == "img_ht" || what == "obj_ht") {
      design_.field = image ? FieldKind::ImageHeight : FieldKind::ObjectHeight;
    } else if (key.is_there()) {
      return key.fail(fmt::format("the field '{}' is not known; angle and height are", shortened(what)));
    }
    const JsonField fields = view["fields"];
    double largest = 0.0;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const JsonField field = content_of(fields[k]);
      largest = std::max(largest, std::hypot(field["x"].number_or(0.0), field["y"].number_or(0.0)));
    }
    design_.largest_field = view["is_relative"].truth() ? largest * std::abs(view["value"].number_or(1.0)) : largest;
    if (!std::isfinite(design_.largest_field)) fields.fail("a field is infinite");
  }

  JsonErrors errors_;
  JsonField model_, sequence_;
  GlassFinder finder_;
  SequentialDesign design_;
};

}  // namespace

bool is_roa(const JsonField& root) { return root["optical_model"].is_map(); }

Result<Prescription> read_roa(const JsonField& root, const LensText& in) { return RoaReader(root, in).read(); }

}  // namespace contrejour::inline internal
