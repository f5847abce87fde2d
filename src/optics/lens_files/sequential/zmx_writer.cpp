// SPDX-License-Identifier: Apache-2.0
// Writes sequential Zemax files (docs/formats/zemax.md), which zmx_reader reads back.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/units.h"
#include "optics/lens_files/glass_finder.h"
#include "optics/lens_files/sequential/design_text.h"
#include "optics/lens_files/sequential/design_writer.h"
#include "optics/lens_files/sequential/ghost_rows.h"

namespace contrejour {
namespace {

constexpr double kShownIndexError = 1e-7;

// The largest power with a coefficient, and whether all are even.
struct Powers {
  int highest = 0;
  bool even = true;
};
Powers powers_of(const SurfaceShape& shape) {
  Powers out;
  for (std::size_t k = 0; k < shape.powers.size(); ++k) {
    if (shape.powers[k] == 0.0) continue;
    out.highest = static_cast<int>(k) + 1;
    out.even = out.even && out.highest % 2 == 0;
  }
  return out;
}

class ZmxWriter {
 public:
  explicit ZmxWriter(const WritableDesign& rows)
      : design_(rows), lens_(rows.lens), written_{"", common_losses(rows.lens)} {}

  Result<WrittenLens> write() {
    collect_makers();
    const auto sensor_mm = write_surfaces(design_, [&](std::size_t k, double gap_mm) { return add_row(k, gap_mm); });
    if (!sensor_mm) return tl::unexpected(sensor_mm.error());
    if (!lens_.sensor_distance_mm) rows_ += "  MAZH 0 0\n";
    written_.text = header() + surf("  TYPE STANDARD\n  CURV 0\n", "INFINITY", 0) + rows_;
    written_.text += surf("  TYPE STANDARD\n  CURV 0\n", "0", next_) +
                     fmt::format("  DIAM {} 0 0 0 1 \"\"\n", number_text(half_diagonal_mm()));
    written_.text += configurations(*sensor_mm);
    return std::move(written_);
  }

 private:
  [[nodiscard]] double half_diagonal_mm() const {
    return 0.5 * std::hypot(lens_.sensor_width_mm, lens_.sensor_height_mm);
  }

  void collect_makers() {
    for (const Surface& surface : lens_.surfaces) {
      const auto named = catalogued_name(surface.glass_after);
      if (named && std::find(makers_.begin(), makers_.end(), named->maker) == makers_.end())
        makers_.push_back(named->maker);
    }
  }

  [[nodiscard]] std::string header() const {
    std::string out = "VERS 140124 258 36214\nMODE SEQ\n";
    out += "NAME " + plain_title(lens_.name) + "\nNOTE 0 " + plain_title(lens_.source) + "\n";
    // The stop limits a path's bundle.
    const std::string opening = design_.is_path() ? "FLOA" : "FNUM " + number_text(lens_.f_number) + " 0";
    out += "UNIT MM X W X CM MR CPMM\n" + opening + "\nENVD 20 1 0\n";
    if (!makers_.empty()) {
      out += "GCAT";
      for (const std::string& maker : makers_) out += " " + maker;
      out += "\n";
    }
    // The picture's middle, and its corner.
    const double half_width = 0.5 * lens_.sensor_width_mm, half_height = 0.5 * lens_.sensor_height_mm;
    out += design_.is_path() ? "FTYP 0 0 2 3 0 0 0\n" : "FTYP 3 0 2 3 0 0 0\n";
    out += design_.is_path()
               ? fmt::format("XFLN 0 0\nYFLN 0 {}\nFWGN 1 1\n", number_text(design_.field_deg))
               : fmt::format("XFLN 0 {}\nYFLN 0 {}\nFWGN 1 1\n", number_text(half_width), number_text(half_height));
    const double nm = lens_.stated.wavelength_nm;
    const auto um = text_giving(nm, nm / 1e3, [](double read) { return read * 1e3; });
    out += fmt::format("WAVM 1 0.4861327 1\nWAVM 2 {} 1\nWAVM 3 0.6562725 1\nPWAV 2\n",
                       um.value_or(number_text(nm / 1e3)));
    return out;
  }

  [[nodiscard]] static std::string surf(const std::string& body, const std::string& thickness, int number) {
    return fmt::format("SURF {}\n{}  DISZ {}\n", number, body, thickness);
  }

  void add(const std::string& body, double thickness_mm) { rows_ += surf(body, number_text(thickness_mm), next_++); }

  // Adds a coordinate break with decentre and tilts, or its inverse.
  void add_break(Vec3 shift, const Tilts& tilts, bool back, double thickness_mm) {
    const double sign = back ? -1.0 : 1.0;
    const double parameters[] = {shift.x, shift.y, deg_from_rad(tilts.x_rad), deg_from_rad(tilts.y_rad),
                                 deg_from_rad(tilts.z_rad)};
    std::string body = "  TYPE COORDBRK\n";
    for (int k = 0; k < 5; ++k) body += fmt::format("  PARM {} {}\n", k + 1, number_text(sign * parameters[k] + 0.0));
    add(body + fmt::format("  PARM 6 {}\n", back ? 1 : 0), thickness_mm);
  }

  // What is wrong, or nothing.
  std::optional<std::string> add_row(std::size_t k, double gap_mm) {
    const Surface& s = lens_.surfaces[k];
    const auto shape = shape_rows(s);
    if (!shape) return shape.error().message;
    // Zemax rotates coordinates, but neither shapes nor apertures.
    const bool rim_is_round = s.aperture.kind == ApertureKind::Disc;
    const double rotation_rad = !s.shape.has_axial_symmetry() ? s.shape.rotation_rad
                                : rim_is_round                ? s.obscuration.rotation_rad
                                                              : s.aperture.rotation_rad;
    if (s.obscuration.any() && !rim_is_round)
      return "a rim that is no circle and an obscuration; a surface of Zemax has one aperture";
    const auto rim = s.obscuration.any() ? obscuration_rows(s, rotation_rad) : aperture_rows(k, rotation_rad);
    if (!rim) return "its rim is turned otherwise than itself; Zemax has no such apertures";
    const std::string glass = design_.reflects(k) ? "  GLAS MIRROR 0 0 1.5 40 0 0 0 0 0 0\n" : glass_row(s);
    const std::string body = *shape + glass + *rim;
    const bool displaced = !(s.pose == SurfacePose{}) || rotation_rad != 0.0;
    if (!displaced) {
      gap_at_.push_back({next_, 0.0});
      add(body, gap_mm);
      return std::nullopt;
    }
    // The gaps in front and behind absorb a shift along the axis.
    const double along_mm = s.pose.shift_mm.z;
    if (along_mm != 0.0) {
      written_.losses.push_back(
          fmt::format("surface {}: its shift of {:g} mm along the axis is written as gaps", k + 1, along_mm));
      add("  TYPE STANDARD\n  CURV 0\n" + glass_row_before(k), along_mm);
    }
    const Tilts tilts = tilts_of(s, rotation_rad);
    add_break(s.pose.shift_mm, tilts, false, 0.0);
    add(body, 0.0);
    gap_at_.push_back({next_, along_mm});
    add_break(s.pose.shift_mm, tilts, true, gap_mm - along_mm);
    return std::nullopt;
  }

  // DIAM and an obscuration.
  static std::optional<std::string> obscuration_rows(const Surface& s, double rotation_rad) {
    const Obscuration own = obscuration_in_rotated(s.obscuration, rotation_rad);
    const std::string semi = number_text(s.semi_diameter_mm);
    std::string out = fmt::format("  DIAM {} 1 0 0 1 \"\"\n", semi);
    if (own.has_axial_symmetry()) return out + fmt::format("  CLAP {} {} 0\n", number_text(own.half_mm.x), semi);
    if (own.rotation_rad != 0.0) return std::nullopt;
    out += fmt::format("  ELOB {} {} 0\n", number_text(own.half_mm.x), number_text(own.half_mm.y));
    if (own.centre_mm == Vec2{}) return out;
    return out + fmt::format("  OBDC {} {}\n", number_text(own.centre_mm.x), number_text(own.centre_mm.y));
  }

  // DIAM and a rim that is no circle about the axis.
  std::optional<std::string> aperture_rows(std::size_t k, double rotation_rad) {
    const Surface& s = lens_.surfaces[k];
    std::string out = fmt::format("  DIAM {} 1 0 0 1 \"\"\n", number_text(s.semi_diameter_mm));
    const Glass before = k == 0 ? air() : lens_.surfaces[k - 1].glass_after;
    const ClearAperture rim = aperture_in_rotated(s.aperture, rotation_rad);
    if (rim.kind == ApertureKind::Disc) {
      if (s.kind == SurfaceKind::Refracting && s.glass_after == before)
        out += fmt::format("  CLAP 0 {} 0\n", number_text(s.semi_diameter_mm));
      return out;
    }
    if (rim.rotation_rad != 0.0) return std::nullopt;
    if (rims_of({rim.kind, rim.half_mm, rim.centre_mm, 0.0}, s.semi_diameter_mm).size() >
        rims_of({rim.kind, rim.half_mm, rim.centre_mm, 0.0}, 1e9).size())
      written_.losses.push_back(
          fmt::format("surface {}: its rim is written whole, not cut by its semi-diameter", k + 1));
    out += fmt::format("  {} {} {} 0\n", rim.kind == ApertureKind::Rectangle ? "SQAP" : "ELAP",
                       number_text(rim.half_mm.x), number_text(rim.half_mm.y));
    if (!(rim.centre_mm == Vec2{}))
      out += fmt::format("  OBDC {} {}\n", number_text(rim.centre_mm.x), number_text(rim.centre_mm.y));
    return out;
  }

  [[nodiscard]] Result<std::string> shape_rows(const Surface& s) const {
    const SurfaceShape& shape = s.shape;
    const Powers powers = powers_of(shape);
    const auto no = [](std::string what) -> Result<std::string> {
      return failure(ErrorCode::Unsupported, std::move(what) + "; Zemax has no such surface");
    };
    std::string type = "STANDARD", numbers;
    const auto parameter = [&](int k, double value) {
      numbers += fmt::format("  PARM {} {}\n", k, number_text(value));
    };
    const auto coefficient = [&](int power) {
      return static_cast<std::size_t>(power) > shape.powers.size() ? 0.0
                                                                   : shape.powers[static_cast<std::size_t>(power) - 1];
    };
    if (shape.kind == ShapeKind::Toroid) {
      if (powers.highest > 14 || !powers.even) return no("a toroid's polynomial with odd powers or beyond y^14");
      type = "TOROIDAL";
      parameter(1, 0.0);
      numbers = fmt::format("  PARM 1 {}\n", radius_text(shape.curvature_x_per_mm));
      for (int p = 2; p <= powers.highest; p += 2) parameter(1 + p / 2, coefficient(p));
    } else if (shape.kind == ShapeKind::Biconic) {
      type = "BICONICX";
      numbers = fmt::format("  PARM 1 {}\n", radius_text(shape.curvature_x_per_mm));
      parameter(2, shape.conic_x);
    } else if (powers.highest > 0) {
      const int step = powers.even ? 2 : 1;
      if (powers.highest <= 8 * step) {
        type = powers.even ? "EVENASPH" : "ODDASPHE";
        for (int k = 1; k <= 8; ++k) parameter(k, coefficient(k * step));
      } else {
        type = powers.even ? "XASPHERE" : "XOSPHERE";
        const int terms = powers.highest / step;
        numbers = fmt::format("  XDAT 1 {} 0 0 1 0 0 \"\"\n  XDAT 2 1 0 0 1 0 0 \"\"\n", terms);
        for (int k = 1; k <= terms; ++k)
          numbers += fmt::format("  XDAT {} {} 0 0 1 0 0 \"\"\n", k + 2, number_text(coefficient(k * step)));
      }
    }
    std::string out = s.kind == SurfaceKind::Stop ? "  STOP\n" : "";
    out += fmt::format("  TYPE {}\n  CURV {} 0 0 0 0 \"\"\n", type, number_text(s.curvature_per_mm));
    if (shape.conic != 0.0) out += "  CONI " + number_text(shape.conic) + "\n";
    return out + numbers;
  }

  [[nodiscard]] std::string glass_row_before(std::size_t k) {
    return k == 0 ? std::string() : glass_row(lens_.surfaces[k - 1]);
  }

  [[nodiscard]] std::string glass_row(const Surface& s) {
    const Glass& glass = s.glass_after;
    if (is_air(glass)) return {};
    if (const auto named = catalogued_name(glass)) {
      const auto again = finder_.find(named->name, makers_);
      if (again && again->dispersion == glass.dispersion)
        return fmt::format("  GLAS {} 0 0 {:.6g} {:.6g} 0 0 0 0 0 0\n", named->name, refractive_index(glass, kLineD_nm),
                           glass_figures(glass).v_d);
    }
    return model_row(glass);
  }

  [[nodiscard]] std::string model_row(const Glass& glass) {
    const auto row = [](double n_d, double v_d, double d_pgf) {
      return fmt::format("  GLAS ___BLANK 1 0 {} {} {} 0 0 0 0 0\n", number_text(n_d), number_text(v_d),
                         number_text(d_pgf));
    };
    if (const auto* constant = std::get_if<ConstantIndex>(&glass.dispersion)) return row(constant->n, 0, 0);
    if (const auto* model = std::get_if<ModelGlass>(&glass.dispersion))
      return row(model->n_d, model->v_d, model->d_pgf);
    const GlassFigures figures = glass_figures(glass);
    if (const auto* abbe = std::get_if<AbbeGlass>(&glass.dispersion)) {
      return abbe->v_d == 0.0 ? row(abbe->n_d, 0, 0) : row(abbe->n_d, abbe->v_d, figures.d_pgf);
    }
    const Glass model{"", ModelGlass{figures.n_d, figures.v_d, figures.d_pgf}};
    double error = 0.0;
    for (double nm = 400.0; nm <= 700.0; nm += 10.0)
      error = std::max(error, std::abs(refractive_index(glass, nm) - refractive_index(model, nm)));
    const std::string loss =
        fmt::format("the glass {} is written as a model glass, its index right to {:.1g} from 400 to 700 nm",
                    glass.name.empty() ? "of a formula" : glass.name, std::max(error, kShownIndexError));
    if (std::find(written_.losses.begin(), written_.losses.end(), loss) == written_.losses.end())
      written_.losses.push_back(loss);
    return row(figures.n_d, figures.v_d, figures.d_pgf);
  }

  // The gaps that change, and the title of each position.
  [[nodiscard]] std::string configurations(const std::vector<double>& sensor_mm) const {
    const std::size_t count = std::max<std::size_t>(lens_.zoom.size(), 1);
    std::string out = fmt::format("MNUM {} 1\n", count);
    if (count == 1) return out;
    for (std::size_t p = 0; p < count; ++p)
      out +=
          fmt::format("LTTL 0 {} \"{} mm\" 0 0 0 1 1 0 0.0 \"\"\n", p + 1, number_text(lens_.zoom[p].focal_length_mm));
    const auto operand = [&](std::size_t row, std::size_t position, double gap_mm) {
      const GapPosition& at = gap_at_[row];
      out += fmt::format("THIC {} {} {} 0 0 0 1 1 0 0.0 \"\"\n", at.surface, position + 1,
                         number_text(gap_mm - at.less_mm));
    };
    for (std::size_t k = 0; k < lens_.zoom.front().thickness_mm.size(); ++k)
      for (std::size_t p = 0; p < count; ++p) {
        const int row = lens_.zoom.front().thickness_mm[k].first;
        for (const auto& [index, gap_mm] : lens_.zoom[p].thickness_mm)
          if (index == row) operand(static_cast<std::size_t>(row), p, gap_mm);
      }
    for (std::size_t p = 0; p < count; ++p) operand(lens_.surfaces.size() - 1, p, sensor_mm[p]);
    return out;
  }

  struct GapPosition {
    int surface = 0;
    double less_mm = 0;  // reduces the gap by a shift along the axis
  };

  const WritableDesign& design_;
  const Prescription& lens_;
  WrittenLens written_;
  GlassFinder finder_;
  std::vector<std::string> makers_;
  std::string rows_;
  int next_ = 1;
  std::vector<GapPosition> gap_at_;
};

}  // namespace

Result<WrittenLens> write_lens_zmx(const Prescription& lens) { return ZmxWriter(WritableDesign{lens}).write(); }

Result<WrittenLens> write_ghost_zmx(const LensState& lens, const Ghost& ghost) {
  const auto rows = ghost_rows(lens, ghost);
  if (!rows) return tl::unexpected(rows.error());
  return ZmxWriter(*rows).write();
}

}  // namespace contrejour
