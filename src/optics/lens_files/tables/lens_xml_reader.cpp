// SPDX-License-Identifier: Apache-2.0
// XML files of OpenLensFlare and the LensFlareFramework, which share a format (docs/formats/openlensflare.md).
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "optics/lens/validate.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/missing_stop.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/tables/heights.h"

namespace contrejour::inline internal {
namespace {

constexpr std::string_view kXmlSpace = " \t\r\n";

class LensXmlReader {
 public:
  LensXmlReader(const pugi::xml_node& system, const LensText& in) : system_(system), in_(in) {
    lens_.file = {in.file, line_of(system), 0};
  }

  [[nodiscard]] Result<Prescription> read() {
    lens_.name = text_of(system_, "name");
    if (lens_.name.empty()) lens_.name = "lens of OpenLensFlare";
    lens_.source = "an OpenLensFlare file, which does not say it";
    lens_.sensor_width_mm = number_or(system_, "filmWidth", lens_.sensor_width_mm);
    lens_.sensor_height_mm = number_or(system_, "filmHeight", lens_.sensor_height_mm);
    const double focal_mm = number_or(system_, "effectiveFocalLength", 0.0);
    if (focal_mm > 0.0) lens_.stated.focal_length_mm = focal_mm;
    for (const pugi::xml_node& element : system_.child("elements").children("element")) {
      if (error_) break;
      read_element(element);
    }
    if (lens_.surfaces.empty()) fail(system_, "no <element> under <elements>; list the surfaces from the front on");
    finish();
    if (error_) return tl::unexpected(*error_);
    return completed(std::move(lens_), beam());
  }

 private:
  [[nodiscard]] int line_of(const pugi::xml_node& node) const {
    const auto offset = node.offset_debug();
    if (offset < 0) return 0;
    const std::string_view before = in_.text.substr(0, static_cast<std::size_t>(offset));
    return 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
  }

  void fail(const pugi::xml_node& node, std::string message, ErrorCode code = ErrorCode::Parse) {
    if (!error_) error_ = Error{code, std::move(message), {in_.file, line_of(node), 0}};
  }

  static std::string text_of(const pugi::xml_node& node, const char* child) {
    return std::string(trimmed(node.child(child).child_value(), kXmlSpace));
  }

  double number_or(const pugi::xml_node& node, const char* child, double fallback) {
    const std::string text = text_of(node, child);
    if (text.empty()) return fallback;
    const auto value = plain_number(text);
    if (!value) fail(node.child(child), fmt::format("<{}> '{}' is no number", child, shortened(text)));
    return value.value_or(fallback);
  }

  double radius_of(const pugi::xml_node& element) {
    const std::string text = text_of(element, "radius");
    const auto value = number_or_infinity(text);
    if (!value && !text.empty())
      fail(element.child("radius"), fmt::format("<radius> '{}' is no number", shortened(text)));
    return value.value_or(0.0);
  }

  double required(const pugi::xml_node& element, const char* child) {
    if (text_of(element, child).empty()) fail(element, fmt::format("an element without <{}>; give it", child));
    return number_or(element, child, 0.0);
  }

  void read_element(const pugi::xml_node& element) {
    const std::string type = text_of(element, "type");
    if (has_sensor_) return fail(element, "an element behind the sensor; put it in front");
    if (type == "sensor") {
      has_sensor_ = true;
      return;
    }
    if (lens_.surfaces.size() >= static_cast<std::size_t>(kMaxSurfaces))
      return fail(element, fmt::format("more than {} surfaces; no more are computed", kMaxSurfaces));
    if (type == "lensAspherical")
      return fail(element, "the shape of a lensAspherical is nowhere said in this format; make it a lensSpherical",
                  ErrorCode::Unsupported);
    if (type != "lensSpherical" && type != "apertureStop")
      return fail(element, fmt::format("element type '{}' is not known; lensSpherical, apertureStop and sensor are",
                                       shortened(type)));
    Surface surface;
    surface.source_line = line_of(element);
    surface.thickness_mm = required(element, "thickness");
    surface.semi_diameter_mm = std::abs(required(element, "height"));
    surface.glass_after = medium_;
    if (type == "apertureStop") {
      surface.kind = SurfaceKind::Stop;
    } else {
      surface.curvature_per_mm = curvature_of_radius(radius_of(element));
      surface.glass_after = glass_of(element);
      surface.coating = coating_of(element, surface);
    }
    medium_ = surface.glass_after;
    lens_.surfaces.push_back(std::move(surface));
  }

  // In this format air has an Abbe number of 89.3.
  Glass glass_of(const pugi::xml_node& element) {
    const double n_d = required(element, "refractiveIndex"), v_d = number_or(element, "abbeNumber", 0.0);
    if (n_d == 1.0) return air();
    return v_d == 0.0 ? Glass{"", ConstantIndex{n_d}} : Glass{"", AbbeGlass{n_d, v_d}};
  }

  // The film is a quarter of coatingLambda thick.
  Coating coating_of(const pugi::xml_node& element, const Surface& surface) {
    const double lambda_nm = number_or(element, "coatingLambda", 0.0), n = number_or(element, "coatingIor", 0.0);
    if (!(lambda_nm > 0.0) || !(n > 0.0)) return {};
    if (is_air(medium_) || is_air(surface.glass_after)) return {"", QuarterWave{n, lambda_nm}};
    cemented_.push_back(surface.source_line);
    return {};
  }

  void finish() {
    if (error_) return;
    const double back_mm = lens_.surfaces.back().thickness_mm;
    if (back_mm > 0.0) lens_.stated.back_focal_distance_mm = back_mm;
    place_openings(lens_);
    const HeightMeaning meaning = meaning_of_heights(lens_, std::nullopt);
    apply_heights(lens_, meaning);
    warn_of_heights(meaning);
    if (!cemented_.empty())
      lens_.warnings.push_back(
          fmt::format("films between two glasses are left out: cemented faces are bare (line{} {})",
                      cemented_.size() == 1 ? "" : "s", fmt::join(cemented_, ", ")));
    if (const auto placed = place_missing_stop(lens_); !placed) {
      error_ = placed.error();
      return;
    }
    keep_sensor_without_image(lens_);
  }

  // All files state the factor 0.5, although some heights are radii.
  void warn_of_heights(HeightMeaning meaning) {
    const pugi::xml_node multiplier = system_.child("heightMultiplier");
    const double stated = number_or(system_, "heightMultiplier", 1.0);
    const double taken = meaning == HeightMeaning::SemiDiameter ? 1.0 : meaning == HeightMeaning::Diameter ? 0.5 : 0.0;
    if (taken == stated) return;
    if (meaning == HeightMeaning::SemiDiameter) {
      lens_.warnings.push_back(fmt::format(
          "heights are taken for semi-diameters, as which surfaces fit; a heightMultiplier of {:g} (line {}) "
          "is not followed",
          stated, line_of(multiplier)));
    } else {
      lens_.warnings.push_back(fmt::format(
          "heights (line {} on) {}", lens_.surfaces.front().source_line,
          taken > 0.0 ? "are taken for diameters: as semi-diameters surfaces would end or cross"
                      : "are no clear apertures; surfaces are sized for the stated f-number and focal length"));
    }
  }

  // <fnumber> is the setting, not the widest f-number: it only serves lenses with unusable heights.
  std::optional<Beam> beam() {
    const double f_number = number_or(system_, "fnumber", 0.0);
    if (!(f_number > 0.0) || !lens_.stated.focal_length_mm) return std::nullopt;
    const double half_mm = 0.5 * std::hypot(lens_.sensor_width_mm, lens_.sensor_height_mm);
    return Beam{*lens_.stated.focal_length_mm / f_number, std::atan(half_mm / *lens_.stated.focal_length_mm)};
  }

  pugi::xml_node system_;
  const LensText& in_;
  Prescription lens_;
  Glass medium_ = air();
  bool has_sensor_ = false;
  std::vector<int> cemented_;
  std::optional<Error> error_;
};

}  // namespace

bool looks_like_lens_xml(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kXmlSpace);
  return first != std::string_view::npos && text[first] == '<' && text.find("<opticalSystem") != std::string_view::npos;
}

Result<Prescription> read_lens_xml(const LensText& in) {
  pugi::xml_document document;
  const auto parsed = document.load_buffer(in.text.data(), in.text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed) {
    const auto offset = std::clamp<std::ptrdiff_t>(parsed.offset, 0, static_cast<std::ptrdiff_t>(in.text.size()));
    const std::string_view before = in.text.substr(0, static_cast<std::size_t>(offset));
    return failure(ErrorCode::Parse, fmt::format("not valid XML: {}", parsed.description()),
                   {in.file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')), 0});
  }
  const pugi::xml_node root = document.document_element();
  if (std::string_view(root.name()) != "opticalSystem")
    return failure(
        ErrorCode::Parse,
        fmt::format("XML, but no lens of OpenLensFlare: it is a <{}>; give an <opticalSystem>", shortened(root.name())),
        {in.file, 0, 0});
  return LensXmlReader(root, in).read();
}

}  // namespace contrejour::inline internal
