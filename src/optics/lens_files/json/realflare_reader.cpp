// SPDX-License-Identifier: Apache-2.0
// Realflare's lens models (docs/formats/realflare.md).
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/json/json_lens.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/tables/heights.h"

namespace contrejour::inline internal {
namespace {

// The lens settings of a project or a preset.
JsonField lens_of_settings(const JsonField& root) {
  return root["flare"].is_map() ? root["flare"]["lens"] : root["lens"];
}

// The model itself, or the one within a project; else a field without elements.
JsonField model_of(const JsonField& root) {
  if (root["lens_elements"].is_list()) return root;
  for (const char* key : {"lens_model", "prescription", "model"})
    if (const JsonField model = lens_of_settings(root)[key]; model["lens_elements"].is_list()) return model;
  return root;
}

// A project or a preset names the file of its lens.
Result<Prescription> refuse_settings(const JsonField& root, const LensText& in) {
  const JsonField lens = lens_of_settings(root);
  for (const char* key : {"lens_model_path", "prescription_path"}) {
    if (!lens[key].is_text()) continue;
    return failure(ErrorCode::Unsupported,
                   fmt::format("settings of Realflare, not a lens: they name the lens '{}'; give that file",
                               shortened(lens[key].text())),
                   {in.file, lens[key].line(), 0});
  }
  return failure(ErrorCode::Unsupported,
                 "a preset of Realflare, not a lens; give a file of its folder `model`, with lens_elements",
                 {in.file, root.line(), 0});
}

Surface surface_of(const JsonField& element, bool is_stop, const Glass& medium) {
  Surface surface;
  surface.source_line = element.line();
  surface.thickness_mm = element["distance"].required_number();
  surface.semi_diameter_mm = std::abs(element["height"].number_or(0.0));
  surface.glass_after = medium;
  if (is_stop) {
    surface.kind = SurfaceKind::Stop;
    return surface;
  }
  surface.curvature_per_mm = curvature_of_radius(element["radius"].number_or(0.0));
  const double n_d = element["refractive_index"].required_number(), v_d = element["abbe_nr"].number_or(0.0);
  surface.glass_after = n_d == 1.0   ? air()
                        : v_d == 0.0 ? Glass{"", ConstantIndex{n_d}}
                                     : Glass{"", AbbeGlass{n_d, v_d}};
  return surface;
}

// The stop may be a glass surface: then it becomes a row of its own, at that surface's vertex.
bool is_refracting(const JsonField& element, const Glass& medium) {
  return element["radius"].number_or(0.0) != 0.0 ||
         std::abs(element["refractive_index"].number_or(1.0) - refractive_index(medium, kLineD_nm)) > 1e-6;
}

void choose_heights(Prescription& lens, int line) {
  const HeightMeaning meaning = meaning_of_heights(
      lens, lens.f_number > 0.0 ? std::optional(lens.f_number) : std::nullopt, HeightMeaning::SemiDiameter);
  apply_heights(lens, meaning);
  if (meaning == HeightMeaning::SemiDiameter) return;
  lens.warnings.push_back(
      fmt::format("lens_elements (line {} on): height {}", line,
                  meaning == HeightMeaning::Diameter
                      ? "is taken for the diameter: as the semi-diameter it does not fit the f-number or the radii"
                      : "is no clear aperture; surfaces are sized for the f-number and a full frame's corner"));
}

}  // namespace

bool is_realflare(const JsonField& root) {
  const bool project = root["flare"].is_map() && root["flare"]["lens"].is_map();
  const bool preset = root["lens"].is_map() && root["starburst"].is_map();
  const bool part = (root["aperture"].is_map() && root["aperture"]["blades"].is_there()) ||
                    (root["bin_size"].is_there() && root["wavelength_count"].is_there());
  return root["lens_elements"].is_list() || project || preset || part;
}

Result<Prescription> read_realflare(const JsonField& root, const LensText& in) {
  JsonErrors errors{in.file, {}};
  const JsonField fields = model_of(root).reporting_to(errors);
  if (!fields["lens_elements"].is_list()) return refuse_settings(root, in);
  Prescription lens;
  lens.file = {in.file, 0, 0};
  lens.name = fields["name"].text();
  lens.source = fields["patent_number"].text();
  if (lens.name.empty()) lens.name = "lens of Realflare";
  if (lens.source.empty()) lens.source = "a Realflare file that does not say it";
  lens.f_number = fields["fstop"].number_or(0.0);
  const auto focal_mm = fields["focal_length"].number();
  if (focal_mm && *focal_mm > 0.0) lens.stated.focal_length_mm = focal_mm;
  const double stop = fields["aperture_index"].required_number();
  const JsonField list = fields["lens_elements"];
  refuse_many_surfaces(list);
  Glass medium = air();
  for (std::size_t k = 0; k < list.size() && !errors.first; ++k) {
    const bool is_stop = static_cast<double>(k) == stop;
    lens.surfaces.push_back(surface_of(list[k], is_stop, medium));
    if (is_stop && is_refracting(list[k], medium)) {
      lens.surfaces.back().thickness_mm = 0.0;
      lens.surfaces.push_back(surface_of(list[k], false, medium));
    }
    medium = lens.surfaces.back().glass_after;
  }
  if (stop < 0.0 || stop >= static_cast<double>(list.size()) || stop != std::floor(stop))
    fields["aperture_index"].fail(fmt::format("is {:g}; it counts the {} lens_elements from 0", stop, list.size()));
  if (errors.first) return stopped_by(errors);
  const double back_mm = lens.surfaces.back().thickness_mm;
  if (back_mm > 0.0) lens.stated.back_focal_distance_mm = back_mm;
  place_openings(lens);
  choose_heights(lens, list.line());
  keep_sensor_without_image(lens);
  const auto beam = full_frame_beam(lens);
  return completed(std::move(lens), beam);
}

}  // namespace contrejour::inline internal
