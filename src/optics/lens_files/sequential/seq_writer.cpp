// SPDX-License-Identifier: Apache-2.0
// Writes CODE V's sequence files (docs/formats/codev.md), which seq_reader reads back.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/units.h"
#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/sequential/design_writer.h"
#include "optics/lens_files/sequential/ghost_rows.h"
#include "optics/lens_files/sequential/seq_commands.h"
#include "optics/lens_files/sequential/seq_surface.h"

namespace contrejour {
namespace {

constexpr double kFirst_nm = 340.0, kLast_nm = 1100.0, kStep_nm = 5.0;                 // of a table of indices

// Numbers, a few to a line.
std::string list_text(const std::vector<double>& values) {
  constexpr std::size_t kALine = 6;
  std::string out;
  for (std::size_t k = 0; k < values.size(); ++k)
    out += (k > 0 && k % kALine == 0 ? " &\n   " : " ") + number_text(values[k]);
  return out;
}

class SeqWriter {
 public:
  explicit SeqWriter(const WritableDesign& rows)
      : design_(rows), lens_(rows.lens), written_{"", common_losses(rows.lens)} {}

  Result<WrittenLens> write() {
    std::string rows = "SO    0.0 0.1e14\n";
    const auto sensor_mm = write_surfaces(design_, [&](std::size_t k, double gap_mm) -> std::optional<std::string> {
      const auto row = row_text(k, gap_mm);
      if (!row) return row.error().message;
      rows += *row;
      return std::nullopt;
    });
    if (!sensor_mm) return tl::unexpected(sensor_mm.error());
    if (!lens_.sensor_distance_mm) rows += "  PIM\n";
    written_.text = header() + private_glasses() + rows + "SI    0.0 0.0\n" + positions(*sensor_mm) + "GO\n";
    return std::move(written_);
  }

 private:
  [[nodiscard]] std::string header() const {
    std::string out = fmt::format("RDM;LEN\n! {}\nTITLE '{}'\n", plain_title(lens_.source), plain_title(lens_.name));
    out += design_.is_path() ? fmt::format("EPD   {}\nDIM   M\n", number_text(design_.pupil_mm))
                             : fmt::format("FNO   {}\nDIM   M\n", number_text(lens_.f_number));
    out += fmt::format("WL    656.2725 {} 486.1327\nREF   2\nWTW   1 1 1\n", number_text(lens_.stated.wavelength_nm));
    if (design_.is_path()) return out + fmt::format("XAN   0.0 0.0\nYAN   0.0 {}\n", number_text(design_.field_deg));
    // The picture's middle, and its corner.
    out += fmt::format("XIM   0.0 {}\nYIM   0.0 {}\n", number_text(0.5 * lens_.sensor_width_mm),
                       number_text(0.5 * lens_.sensor_height_mm));
    return out;
  }

  Result<std::string> row_text(std::size_t k, double gap_mm) {
    const Surface& s = lens_.surfaces[k];
    const SurfaceShape& shape = s.shape;
    // CODE V has a type for a toroid rotated by a right angle; other rotations rotate the coordinates.
    const bool crossed = shape.kind == ShapeKind::Toroid && shape.rotation_rad == 0.5 * std::numbers::pi;
    const double own = crossed ? shape.curvature_x_per_mm : s.curvature_per_mm;
    std::string out = "S     " + (own == 0.0 ? "0.0" : radius_text(own)) + " " + number_text(gap_mm) +
                      (design_.reflects(k) ? " REFL" : glass_text(s.glass_after)) + "\n";
    if (!radius_is_exact(own)) out += "  CUY " + number_text(own) + "\n";
    if (s.kind == SurfaceKind::Stop) out += "  STO\n";
    const double rotation_rad = crossed ? 0.0 : s.shape.rotation_rad;
    out += "  CIR " + number_text(s.semi_diameter_mm) + "\n" + rim_text(s, rotation_rad) +
           obscuration_text(s, rotation_rad);
    const auto coefficients = shape_text(s, crossed);
    if (!coefficients) return coefficients;
    return out + *coefficients + decentre_text(s, crossed);
  }

  static bool radius_is_exact(double curvature_per_mm) {
    return curvature_per_mm == 0.0 ||
           text_giving(curvature_per_mm, 1.0 / curvature_per_mm, [](double r) { return 1.0 / r; }).has_value();
  }
  // CON or ASP, CYL, YTO, XTO, AAS, with their numbers.
  static Result<std::string> shape_text(const Surface& s, bool crossed) {
    const SurfaceShape& shape = s.shape;
    std::string powers;
    for (std::size_t p = 1; p <= shape.powers.size(); ++p) {
      const double value = shape.powers[p - 1];
      if (value == 0.0) continue;
      if (p % 2 != 0 || p < 4)
        return failure(ErrorCode::Unsupported,
                       fmt::format("a polynomial with r^{}; CODE V's aspheres have r^4, r^6, ... r^20", p));
      powers += fmt::format("  {} {}\n", kSeqPowers[(p - 4) / 2], number_text(value));
    }
    const std::string conic = shape.conic == 0.0 ? "" : "  K " + number_text(shape.conic) + "\n";
    if (shape.kind == ShapeKind::Revolution) {
      if (powers.empty()) return conic.empty() ? conic : "  CON\n" + conic;
      return "  ASP\n" + conic + powers;
    }
    const double across = crossed ? s.curvature_per_mm : shape.curvature_x_per_mm;
    const std::string other = "  CUX " + number_text(across) + "\n";
    if (shape.kind == ShapeKind::Biconic)
      return "  AAS\n" + other +
             fmt::format("  KY {}\n  KX {}\n", number_text(shape.conic), number_text(shape.conic_x));
    return (crossed ? "  XTO\n" : "  YTO\n") + other + conic + powers;
  }

  // The rim within the semi-diameter's circle, in the surface's coordinates, which may be rotated.
  static std::string rim_text(const Surface& s, double rotation_rad) {
    const ClearAperture rim = aperture_in_rotated(s.aperture, rotation_rad);
    if (rim.kind == ApertureKind::Disc) return {};
    const char* name = rim.kind == ApertureKind::Rectangle ? "RE" : "EL";
    std::string out =
        fmt::format("  {0}X {1}; {0}Y {2}\n", name, number_text(rim.half_mm.x), number_text(rim.half_mm.y));
    if (!(rim.centre_mm == Vec2{}))
      out += fmt::format("  ADX {}; ADY {}\n", number_text(rim.centre_mm.x), number_text(rim.centre_mm.y));
    if (rim.rotation_rad != 0.0) out += "  ARO " + number_text(deg_from_rad(rim.rotation_rad)) + "\n";
    return out;
  }

  static std::string obscuration_text(const Surface& s, double rotation_rad) {
    if (!s.obscuration.any()) return {};
    const Obscuration own = obscuration_in_rotated(s.obscuration, rotation_rad);
    const Vec2 half = own.half_mm, at = own.centre_mm;
    std::string out = half.x == half.y
                          ? fmt::format("  CIR OBS {}\n", number_text(half.x))
                          : fmt::format("  ELX OBS {}; ELY OBS {}\n", number_text(half.x), number_text(half.y));
    if (!(at == Vec2{})) out += fmt::format("  ADX OBS {}; ADY OBS {}\n", number_text(at.x), number_text(at.y));
    if (own.rotation_rad != 0.0) out += "  ARO OBS " + number_text(deg_from_rad(own.rotation_rad)) + "\n";
    return out;
  }

  static std::string decentre_text(const Surface& s, bool crossed) {
    const Tilts tilts = tilts_of(s, crossed ? 0.0 : s.shape.rotation_rad);
    const Vec3 shift = s.pose.shift_mm;
    if (s.pose == SurfacePose{} && tilts.z_rad == 0.0) return {};
    const auto move = [](const char* name, double value) {
      return value == 0.0 ? std::string() : fmt::format("  {} {}\n", name, number_text(value));
    };
    return move("XDE", shift.x) + move("YDE", shift.y) + move("ZDE", shift.z) +
           move("ADE", -deg_from_rad(tilts.x_rad)) + move("BDE", -deg_from_rad(tilts.y_rad)) +
           move("CDE", deg_from_rad(tilts.z_rad)) + "  DAR\n";
  }

  std::string glass_text(const Glass& glass) {
    if (is_air(glass)) return {};
    if (const auto named = catalogued_name(glass)) {
      std::string name;
      for (const char c : named->name)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
      name += "_" + named->maker;
      const auto again = finder_.find(name);
      if (again && again->dispersion == glass.dispersion) return " " + name;
    }
    if (const auto* model = std::get_if<ModelGlass>(&glass.dispersion); model != nullptr && model->d_pgf == 0.0)
      return fmt::format(" {}:{}", number_text(model->n_d), number_text(model->v_d));
    return " '" + private_name(glass) + "'";
  }

  std::string private_name(const Glass& glass) {
    for (const auto& [name, known] : own_)
      if (known.dispersion == glass.dispersion) return name;
    const auto is_plain = [](const std::string& text) {
      const auto fits = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-'; };
      return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
             std::all_of(text.begin(), text.end(), fits) && text.size() <= 16;
    };
    std::string name = is_plain(glass.name) ? glass.name : "G";
    const std::string upper = capitals(name);
    const bool reserved = name == "G" || upper == "AIR" || upper == "END" || upper == "PWL" || upper == "REFL" ||
                          upper == "REFR" || seq_surface_name(name).is ||
                          std::any_of(own_.begin(), own_.end(), [&](auto& o) { return capitals(o.first) == upper; });
    if (reserved) name = fmt::format("{}-{}", name, own_.size() + 1);
    own_.emplace_back(name, glass);
    return name;
  }

  // Coefficients of n^2 where CODE V has the formula, else indices.
  [[nodiscard]] std::string private_glasses() {
    if (own_.empty()) return {};
    std::vector<double> wavelengths_nm;
    for (double nm = kFirst_nm; nm <= kLast_nm; nm += kStep_nm) wavelengths_nm.push_back(nm);
    std::string out = "PRV\n  PWL" + list_text(wavelengths_nm) + "\n";
    for (const auto& [name, glass] : own_) {
      out += "  '" + name + "'";
      if (const auto laurent = laurent_of(glass)) {
        out += " LAU" + list_text(*laurent) + "\n";
      } else if (const auto sellmeier = sellmeier_of(glass)) {
        out += " GMS" + list_text(*sellmeier) + "\n";
      } else {
        std::vector<double> indices;
        for (const double nm : wavelengths_nm) indices.push_back(refractive_index(glass, nm));
        out += list_text(indices) + "\n";
        written_.losses.push_back(
            fmt::format("the glass {} is written as a table of indices, right to 1e-6 between them", name));
      }
    }
    return out + "END\n";
  }

  static std::optional<std::vector<double>> laurent_of(const Glass& glass) {
    if (const auto* constant = std::get_if<ConstantIndex>(&glass.dispersion))
      return std::vector<double>{constant->n * constant->n, 0, 0, 0, 0, 0};
    if (const auto* abbe = std::get_if<AbbeGlass>(&glass.dispersion)) {
      // n = a + b / l^2, from two wavelengths.
      const double l1 = um_from_nm(kLineD_nm), l2 = um_from_nm(kLineF_nm);
      const double q1 = 1.0 / (l1 * l1), q2 = 1.0 / (l2 * l2);
      const double b = abbe->v_d == 0.0 ? 0.0 : (refractive_index(glass, kLineF_nm) - abbe->n_d) / (q2 - q1);
      const double a = abbe->n_d - b * q1;
      return std::vector<double>{a * a, 0, 2 * a * b, b * b, 0, 0};
    }
    const auto* known = std::get_if<CatalogueGlass>(&glass.dispersion);
    if (known == nullptr || known->data().formula != DispersionFormula::Schott || is_against_vacuum(*known))
      return std::nullopt;
    return padded(known->data().coefficients);
  }

  static std::optional<std::vector<double>> sellmeier_of(const Glass& glass) {
    if (const auto* own = std::get_if<Sellmeier>(&glass.dispersion))
      return std::vector<double>{own->b[0], own->c_um2[0], own->b[1], own->c_um2[1], own->b[2], own->c_um2[2]};
    const auto* known = std::get_if<CatalogueGlass>(&glass.dispersion);
    if (known == nullptr || known->data().formula != DispersionFormula::Sellmeier1 || is_against_vacuum(*known))
      return std::nullopt;
    return padded(known->data().coefficients);
  }

  static bool is_against_vacuum(const CatalogueGlass& glass) {
    return glass.data().index_in_vacuum || glass.data().wavelength_in_vacuum;
  }
  static std::vector<double> padded(std::vector<double> coefficients) {
    coefficients.resize(6);
    return coefficients;
  }

  [[nodiscard]] std::string positions(const std::vector<double>& sensor_mm) const {
    if (lens_.zoom.empty()) return {};
    std::string out = fmt::format("ZOO   {}\nZOO TIT\n", lens_.zoom.size());
    for (std::size_t p = 0; p < lens_.zoom.size(); ++p)
      out += fmt::format("TIT Z{} '{} mm'\n", p + 1, number_text(lens_.zoom[p].focal_length_mm));
    for (const auto& [row, first_mm] : lens_.zoom.front().thickness_mm) {
      std::vector<double> gaps;
      for (const ZoomPosition& position : lens_.zoom)
        for (const auto& [index, gap_mm] : position.thickness_mm)
          if (index == row) gaps.push_back(gap_mm);
      out += fmt::format("ZOO THI S{}{}\n", row + 1, list_text(gaps));
    }
    return out + fmt::format("ZOO THI S{}{}\n", lens_.surfaces.size(), list_text(sensor_mm));
  }

  const WritableDesign& design_;
  const Prescription& lens_;
  WrittenLens written_;
  GlassFinder finder_;
  std::vector<std::pair<std::string, Glass>> own_;  // by the name that they get here
};

}  // namespace

Result<WrittenLens> write_lens_seq(const Prescription& lens) { return SeqWriter(WritableDesign{lens}).write(); }

Result<WrittenLens> write_ghost_seq(const LensState& lens, const Ghost& ghost) {
  const auto rows = ghost_rows(lens, ghost);
  if (!rows) return tl::unexpected(rows.error());
  return SeqWriter(*rows).write();
}

}  // namespace contrejour
