// SPDX-License-Identifier: Apache-2.0
// FlareSim's .lens files (docs/formats/flaresim.md): `name:`, `focal_length:`, then a line a surface.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "contrejour/lens.h"
#include "optics/lens/validate.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/lost_gap.h"
#include "optics/lens_files/missing_stop.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/tables/heights.h"

namespace contrejour::inline internal {
namespace {

constexpr std::string_view kFlareSimSpace = " \t\r\v\f";
constexpr double kAirIndex = 1.0001;  // FlareSim: up to this index it is air, and a V_d below 0.1 means no dispersion
constexpr double kRoundedIndex = 1e-3;
// Its files have no aspheres: the sphere in place of a strong asphere may end before its rim.
constexpr double kMinRimFractionWithoutAspheres = 0.3;

// "f/2.8" or "F2.8" of a text; of several the last.
std::optional<double> f_number_in(std::string_view text) {
  std::optional<double> found;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if ((text[k] != 'f' && text[k] != 'F') || (k > 0 && std::isalnum(static_cast<unsigned char>(text[k - 1]))))
      continue;
    std::string_view rest = text.substr(k + 1);
    if (rest.starts_with('/')) rest.remove_prefix(1);
    const std::size_t end = std::min(rest.find_first_not_of("0123456789."), rest.size());
    const auto value = plain_number(rest.substr(0, end));
    if (value && *value >= 0.4 && *value <= 1000.0) found = value;
  }
  return found;
}

std::vector<std::string_view> flaresim_words(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::size_t kMaxWords = 16;
  while (words.size() < kMaxWords) {
    line = trimmed(line, kFlareSimSpace);
    if (line.empty()) break;
    const std::size_t end = std::min(line.find_first_of(kFlareSimSpace), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

bool is_stop_word(std::string_view word) { return word == "stop" || word == "STOP" || word == "Stop"; }

class FlareSimReader {
 public:
  explicit FlareSimReader(const LensText& in) : in_(in) { lens_.file = {in.file, 0, 0}; }

  [[nodiscard]] Result<Prescription> read() {
    split();
    if (lens_.surfaces.empty())
      fail(0, "no surfaces after 'surfaces:'; give a line each: radius thickness ior abbe semi_ap coating");
    finish();
    if (error_) return tl::unexpected(*error_);
    const auto beam = full_frame_beam(lens_);
    auto lens = completed(std::move(lens_), beam, kMinRimFractionWithoutAspheres);
    if (lens) warn_of_lost_gap(*lens);
    return lens;
  }

 private:
  void fail(int line, std::string message) {
    if (!error_) error_ = Error{ErrorCode::Parse, std::move(message), {in_.file, line, 0}};
  }

  void split() {
    std::string_view text = in_.text;
    bool in_surfaces = false;
    for (int line = 1; !text.empty() && !error_; ++line) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view whole = trimmed(text.substr(0, end), kFlareSimSpace);
      text.remove_prefix(std::min(end + 1, text.size()));
      if (whole.starts_with('#')) {
        read_comment(trimmed(whole.substr(1), kFlareSimSpace));
      } else if (in_surfaces) {
        read_surface(flaresim_words(whole.substr(0, whole.find('#'))), line);
      } else if (whole.starts_with("surfaces:")) {
        in_surfaces = true;
      } else if (whole.starts_with("name:")) {
        lens_.name = trimmed(whole.substr(5), kFlareSimSpace);
      } else if (whole.starts_with("focal_length:")) {
        read_focal_length(whole.substr(13), line);
      } else if (!whole.empty() && whole.find(':') == std::string_view::npos) {
        fail(line, fmt::format("'{}' comes before 'surfaces:'; is this a lens of FlareSim?", shortened(whole)));
      }
    }
  }

  // "Patent: US004448497", "14 surfaces, 7 glass elements, f/1.4": written by the converter, or any other comment.
  void read_comment(std::string_view comment) {
    if (comment.starts_with("Patent:")) lens_.source = trimmed(comment.substr(7), kFlareSimSpace);
    if (comment.find("Optical Bench") != std::string_view::npos) from_optical_bench_ = true;
    if (comment.find("glass elements") != std::string_view::npos) {
      if (const auto value = f_number_in(comment)) f_number_ = value;
    } else if (lens_.surfaces.empty() && !title_f_number_) {
      title_f_number_ = f_number_in(comment);
    }
  }

  void read_focal_length(std::string_view text, int line) {
    text = trimmed(text.substr(0, text.find('#')), kFlareSimSpace);
    if (text.ends_with("mm")) text = trimmed(text.substr(0, text.size() - 2), kFlareSimSpace);
    const auto value = plain_number(text);
    if (!value) return fail(line, fmt::format("'{}' is no focal length; give it in mm", shortened(text)));
    if (*value > 0.0) lens_.stated.focal_length_mm = value;  // 0: unknown
  }

  // radius thickness ior abbe semi_ap coating [type [radius_y]]
  void read_surface(const std::vector<std::string_view>& words, int line) {
    if (words.empty()) return;
    if (lens_.surfaces.size() >= static_cast<std::size_t>(kMaxSurfaces))
      return fail(line, fmt::format("more than {} surfaces; no more are computed", kMaxSurfaces));
    Surface surface;
    surface.source_line = line;
    if (is_stop_word(words[0])) surface.kind = SurfaceKind::Stop;
    const auto radius_mm = surface.kind == SurfaceKind::Stop ? std::optional(0.0) : number_or_infinity(words[0]);
    double numbers[5] = {0, 0, 0, 0, 0};  // thickness, index, Abbe number, height, coating: the last may be missing
    bool good = radius_mm && words.size() >= 5;
    for (std::size_t k = 0; good && k < 5 && k + 1 < words.size(); ++k) {
      const auto value = plain_number(words[k + 1]);
      good = value.has_value();
      numbers[k] = value.value_or(0.0);
    }
    if (!good || !(numbers[3] >= 0.0))
      return fail(line,
                  fmt::format("'{}' is no surface; give radius (or stop), thickness, ior, abbe, semi_ap and coating",
                              shortened(fmt::format("{}", fmt::join(words, " ")))));
    surface.thickness_mm = numbers[0];
    surface.semi_diameter_mm = numbers[3];
    surface.curvature_per_mm = curvature_of_radius(*radius_mm);
    const bool odd_stop = surface.kind == SurfaceKind::Stop && numbers[1] > kAirIndex &&
                          std::abs(numbers[1] - refractive_index(medium_, kLineD_nm)) > kRoundedIndex;
    if (odd_stop)
      return fail(line,
                  "the stop has another index than the medium in front of it; give that surface a row of its own");
    surface.glass_after = glass_of(surface.kind, numbers[1], numbers[2]);
    if (surface.kind == SurfaceKind::Refracting) {
      surface.coating = coating_of(numbers[4], line, is_air(medium_) || is_air(surface.glass_after));
      read_shape(surface, words, line);
    }
    medium_ = surface.glass_after;
    lens_.surfaces.push_back(std::move(surface));
  }

  // The stop has the medium in front, whatever index its row states.
  [[nodiscard]] Glass glass_of(SurfaceKind kind, double n_d, double v_d) const {
    constexpr double kNoDispersion = 0.1;
    if (kind == SurfaceKind::Stop) return medium_;
    if (n_d <= kAirIndex) return n_d < 1.0 ? Glass{"", ConstantIndex{n_d}} : air();
    if (v_d < kNoDispersion) return Glass{"", ConstantIndex{n_d}};
    return Glass{"", AbbeGlass{n_d, v_d}};
  }

  // FlareSim: 0 bare, 1 a quarter wave of MgF2 at 550 nm, each further layer multiplies the reflectance by a quarter.
  Coating coating_of(double layers, int line, bool to_air) {
    if (layers < 1.0) return {};
    if (!to_air) {
      cemented_.push_back(line);
      return {};
    }
    if (layers < 2.0) return {"", QuarterWave{}};
    multi_.push_back(line);
    const double films = DesignedCoating::kMinLayers + layers - 2.0;
    return {"", DesignedCoating{CoatingDesign::Broadband, 550.0,
                                static_cast<int>(std::min(films, double{DesignedCoating::kMaxLayers}))}};
  }

  // A cyl_x's axis lies along x, so it curves in y; its one radius is that in y.
  void read_shape(Surface& surface, const std::vector<std::string_view>& words, int line) {
    if (words.size() < 7 || words[6] == "sph" || words[6] == "spherical") return;
    const std::string_view type = words[6];
    const double c = surface.curvature_per_mm;
    if (type == "cyl_x" || type == "cylinder_x") {
      if (c != 0.0) surface.shape.kind = ShapeKind::Toroid;
    } else if (type == "cyl_y" || type == "cylinder_y") {
      if (c != 0.0) surface.shape = {.kind = ShapeKind::Toroid, .curvature_x_per_mm = c};
      surface.curvature_per_mm = 0.0;
    } else if (type == "toric") {
      const auto radius_y = words.size() > 7 ? number_or_infinity(words[7]) : std::nullopt;
      if (!radius_y)
        return fail(line, "a toric surface has two radii; give that of the y-z section as the eighth word");
      surface.curvature_per_mm = curvature_of_radius(*radius_y);
      if (c != surface.curvature_per_mm) surface.shape = {.kind = ShapeKind::Toroid, .curvature_x_per_mm = c};
    } else {
      fail(line, fmt::format("surface type '{}' is not known; sph, cyl_x, cyl_y and toric are", shortened(type)));
    }
  }

  void finish() {
    if (error_) return;
    if (lens_.name.empty()) lens_.name = "lens of FlareSim";
    if (lens_.source.empty()) lens_.source = "a FlareSim file that does not say it";
    lens_.stated.back_focal_distance_mm = lens_.surfaces.back().thickness_mm;
    if (lens_.surfaces.back().thickness_mm <= 0.0) lens_.stated.back_focal_distance_mm.reset();
    place_openings(lens_);
    if (!f_number_) f_number_ = title_f_number_ ? title_f_number_ : f_number_in(lens_.name);
    choose_heights();
    lens_.f_number = f_number_.value_or(0.0);
    if (const auto placed = place_missing_stop(lens_); !placed) {
      error_ = placed.error();
      return;
    }
    keep_sensor_without_image(lens_);
    if (!cemented_.empty())
      lens_.warnings.push_back(
          fmt::format("films between two glasses are left out: cemented faces are bare (line{} {})",
                      cemented_.size() == 1 ? "" : "s", fmt::join(cemented_, ", ")));
    if (!multi_.empty())
      lens_.warnings.push_back(
          fmt::format("coatings of several layers, which FlareSim does not spell out, are broadband "
                      "designs for 550 nm (line{} {})",
                      multi_.size() == 1 ? "" : "s", fmt::join(multi_, ", ")));
  }

  // The converter from Optical Bench writes diameters under the heading semi_ap.
  void choose_heights() {
    const HeightMeaning stated = from_optical_bench_ ? HeightMeaning::Diameter : HeightMeaning::SemiDiameter;
    const HeightMeaning meaning = meaning_of_heights(lens_, f_number_, stated);
    apply_heights(lens_, meaning);
    if (meaning == stated) return;
    const int line = lens_.surfaces.front().source_line;
    lens_.warnings.push_back(
        fmt::format("column semi_ap (line {} on) holds {}", line,
                    meaning == HeightMeaning::SemiDiameter
                        ? "semi-diameters, unlike other conversions from Optical Bench: so the stop "
                          "lets the stated f-number through"
                    : meaning == HeightMeaning::Diameter
                        ? "diameters: as semi-diameters, which it says, they do not fit the stated "
                          "f-number or the radii"
                        : "heights that surfaces do not reach; they are sized for the f-number"));
  }

  const LensText& in_;
  Prescription lens_;
  Glass medium_ = air();
  std::optional<double> f_number_, title_f_number_;
  bool from_optical_bench_ = false;
  std::vector<int> cemented_, multi_;
  std::optional<Error> error_;
};

}  // namespace

// "surfaces:" on a line of its own, with nothing but comments and keys before it.
bool looks_like_flaresim(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end), kFlareSimSpace);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with("surfaces:")) return true;
    if (line.empty() || line.starts_with('#')) continue;
    const std::size_t colon = line.find(':');
    const auto is_key_char = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    if (colon == std::string_view::npos ||
        !std::all_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(colon), is_key_char))
      return false;
  }
  return false;
}

Result<Prescription> read_flaresim(const LensText& in) { return FlareSimReader(in).read(); }

}  // namespace contrejour::inline internal
