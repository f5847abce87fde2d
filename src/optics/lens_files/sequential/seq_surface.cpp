// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/seq_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/units.h"
#include "optics/lens_files/plain_number.h"

namespace contrejour::inline internal {
namespace {

// Commands that set a coefficient of the surface.
bool is_coefficient(std::string_view name) {
  static const std::set<std::string_view> kNames = {"K", "KX", "KY", "A",  "B",  "C",  "D",  "E",  "F",  "G",  "H",
                                                    "J", "AR", "BR", "CR", "DR", "AP", "BP", "CP", "DP", "CUF"};
  return kNames.contains(name);
}

bool is_move(std::string_view name) {
  static const std::set<std::string_view> kNames = {"XDE", "YDE", "ZDE", "ADE", "BDE", "CDE"};
  return kNames.contains(name);
}

bool is_aperture(std::string_view name) {
  static const std::set<std::string_view> kNames = {"CIR", "REX", "REY", "ELX", "ELY", "ADX", "ADY", "ARO"};
  return kNames.contains(name);
}

bool is_shape(std::string_view name) {
  static const std::set<std::string_view> kNames = {"SPH", "CON", "ASP", "CYL", "YTO", "XTO",
                                                    "AAS", "RDY", "CUY", "RDX", "CUX"};
  return kNames.contains(name);
}

// Commands that are not supported, and their meaning.
std::string_view refused(std::string_view name) {
  struct Named {
    std::string_view name, what;
  };
  constexpr Named kRefused[] = {{"RET", "a return to another surface's coordinates"},
                                {"GLB", "global coordinates"},
                                {"DIF", "a diffractive surface"},
                                {"GRT", "a grating"},
                                {"HOE", "a hologram"},
                                {"SPS", "a special surface"},
                                {"SPL", "a spline"},
                                {"GRI", "a gradient index"},
                                {"GRN", "a gradient index"},
                                {"MOD", "a lens module"},
                                {"FRN", "a Fresnel surface"},
                                {"XYP", "a polynomial in x and y"},
                                {"ZRN", "a Zernike surface"},
                                {"INS", "an edit of the lens"},
                                {"DEL", "an edit of the lens"},
                                {"COP", "an edit of the lens"},
                                {"FLP", "an edit of the lens"},
                                {"SCA", "an edit of the lens"},
                                {"NSS", "a non-sequential part"},
                                {"EDR", "a non-sequential part"},
                                {"ARR", "an array of lenses"},
                                {"UDS", "a user's own surface"},
                                {"BIR", "a birefringent medium"}};
  for (const Named& known : kRefused)
    if (known.name == name) return known.what;
  return {};
}

bool is_other(std::string_view name) {
  static const std::set<std::string_view> kNames = {"STO", "THI", "GLA", "RMD", "DAR", "PIK",
                                                    "PIM", "MLT", "BAS", "BEN", "REV"};
  return kNames.contains(name);
}

// The last word as a number.
std::optional<double> last_number(const SeqCommand& command) {
  return command.words.empty() ? std::nullopt : plain_number(command.words.back());
}

void set_shape(std::string_view name, SeqSurface& s) {
  if (name == "CYL" || name == "YTO" || name == "XTO") {
    s.kind = ShapeKind::Toroid;
    s.in_x = name == "XTO";
  } else if (name == "AAS") {
    s.kind = ShapeKind::Biconic;
  }
}

DesignOpening& opening_of(SeqSurface& s, int line) {
  if (!s.opening) s.opening = DesignOpening{.line = line};
  return *s.opening;
}

// CIR OBS 3, ELX HOL 2, ADX OBS 0.5. False for a rectangle, which is not supported.
bool read_obscuration(std::string_view name, double value, Obscuration& obscuration) {
  if (name == "CIR") {
    obscuration.half_mm = {std::abs(value), std::abs(value)};
  } else if (name == "ADX" || name == "ADY") {
    (name == "ADX" ? obscuration.centre_mm.x : obscuration.centre_mm.y) = value;
  } else if (name == "ARO") {
    obscuration.rotation_rad = rad_from_deg(value);
  } else if (name[0] == 'E') {
    (name[2] == 'X' ? obscuration.half_mm.x : obscuration.half_mm.y) = std::abs(value);
  } else {
    return false;
  }
  return true;
}

// CIR 12, CIR L'a' 12; with EDG the glass's edge, with OBS or HOL an obscuration.
std::optional<std::string> read_aperture(const SeqCommand& command, SeqSurface& s, std::vector<std::string>& warnings) {
  const auto value = last_number(command);
  if (!value) return "no number";
  for (const std::string& word : command.words) {
    const std::string label = capitals(word);
    if (label == "EDG") return std::nullopt;
    if (label == "OBS" || label == "HOL") {
      if (!read_obscuration(command.name, *value, s.obscuration)) {
        warnings.push_back(fmt::format("the obscuration {} {} (line {}) is not computed; light goes through",
                                       command.name, label, command.line));
      }
      return std::nullopt;
    }
  }
  DesignOpening& opening = opening_of(s, command.line);
  opening.line = command.line;
  const std::string_view name = command.name;
  if (name == "CIR") {
    opening.circle = std::abs(*value);
  } else if (name == "ADX" || name == "ADY") {
    (name == "ADX" ? opening.centre.x : opening.centre.y) = *value;
  } else if (name == "ARO") {
    opening.rotation_rad = rad_from_deg(*value);
  } else {
    opening.shape = name[0] == 'R' ? OpeningShape::Rectangle : OpeningShape::Ellipse;
    (name[2] == 'X' ? opening.half_x : opening.half_y) = std::abs(*value);
  }
  return std::nullopt;
}

// Whether a range of vertices, S2..4 or S2..I, ends with the gap behind this surface.
bool ends_behind(std::string_view range, int index) {
  const std::size_t dots = range.find("..");
  if (dots == std::string_view::npos) return false;
  std::string_view last = range.substr(dots + 2);
  if (last.starts_with('S') || last.starts_with('s')) last.remove_prefix(1);
  return last == "I" || last == "i" || plain_number(last) == static_cast<double>(index + 1);
}

// THI 5; THI HMY 0 (a solve with its result); THI OAL S2..4 9: those thicknesses add up to 9.
std::optional<std::string> read_thickness(const SeqCommand& command, int index, SeqSurface& s) {
  if (const auto value = number_or_infinity(command.word(0))) {
    s.thickness = *value;
    return std::nullopt;
  }
  const std::string kind = capitals(command.word(0));
  if (kind != "OAL") return std::nullopt;
  const std::string_view range = command.word(1);
  const SeqSurfaceName from = seq_surface_name(range.substr(0, range.find("..")));
  const auto sum = last_number(command);
  if (from.is && from.index >= 0 && sum && ends_behind(range, index))
    s.solve = ThicknessSolve{ThicknessSolve::Kind::Sum, from.index, 1.0, *sum};
  return std::nullopt;
}

// PIK THI S3 Z1 THI S2 Z1 -1: the first follows from the second.
void read_pickup(const SeqCommand& command, SeqSurface& s) {
  std::size_t second = 0;
  for (std::size_t k = 1; k < command.words.size(); ++k)
    if (capitals(command.words[k]) == "THI") second = k;
  if (capitals(command.word(0)) != "THI" || second == 0) return;
  const SeqSurfaceName from = seq_surface_name(command.word(second + 1));
  std::vector<double> numbers;
  for (std::size_t k = second + 2; k < command.words.size(); ++k)
    if (const auto value = plain_number(command.words[k])) numbers.push_back(*value);
  if (!from.is || from.index < 0) return;
  s.solve = ThicknessSolve{ThicknessSolve::Kind::Pickup, from.index, numbers.empty() ? 1.0 : numbers[0],
                           numbers.size() > 1 ? numbers[1] : 0.0};
}

}  // namespace

bool seq_is_of_surface(std::string_view name) {
  return is_coefficient(name) || is_move(name) || is_aperture(name) || is_shape(name) || is_other(name) ||
         !refused(name).empty();
}

std::optional<Error> SeqSurfaceReader::read(const SeqCommand& command, int index, SeqSurface& s,
                                            std::vector<std::string>& warnings) const {
  const std::string& name = command.name;
  const auto error = [&](std::string message, ErrorCode code = ErrorCode::Parse) {
    return Error{code, std::move(message), {file_, command.line, 0}};
  };
  if (const auto what = refused(name); !what.empty())
    return error(fmt::format("{}: {}; it is not computed", name, what), ErrorCode::Unsupported);
  std::optional<std::string> problem;
  const auto value = last_number(command);
  if (name == "STO") {
    s.is_stop = true;
  } else if (name == "DAR") {
    s.returns = true;
  } else if (name == "BAS") {
    s.returns = false;
  } else if (name == "BEN" || name == "REV") {
    s.refused_move = name == "BEN" ? "a bend of the axis (BEN)" : "a reversed decentre (REV)";
    s.refused_move_line = command.line;
  } else if (name == "THI") {
    problem = read_thickness(command, index, s);
  } else if (name == "PIM") {
    s.is_to_focus = true;
  } else if (name == "PIK") {
    read_pickup(command, s);
  } else if (name == "GLA") {
    s.glass = command.word(0);
    s.glass_next = command.word(1);
    s.glass_line = command.line;
  } else if (name == "RMD") {
    if (capitals(command.word(0)).starts_with("REFL"))
      return error("a mirror (RMD REFL); lenses of refracting surfaces alone are computed", ErrorCode::Unsupported);
  } else if (name == "MLT") {
    warnings.push_back(
        fmt::format("coatings are another program's (MLT, line {}); surfaces are bare, --coating puts "
                    "films on them",
                    command.line));
  } else if (is_aperture(name)) {
    problem = read_aperture(command, s, warnings);
  } else if (!is_shape(name) || name == "RDY" || name == "CUY" || name == "RDX" || name == "CUX") {
    // These have a number, or the kind of a solve, whose result S has.
    if (command.words.size() > 1 && !plain_number(command.word(0))) return std::nullopt;
    if (!value) {
      problem = fmt::format("'{}' is no number", shortened(command.words.empty() ? "" : command.words.back()));
    } else if (is_move(name)) {
      s.moves[name] = *value;
    } else if (name == "RDY") {
      s.curvature = curvature_of_radius(*value);
    } else if (name == "CUY") {
      s.curvature = *value;
    } else if (name == "RDX" || name == "CUX") {
      s.curvature_x = name == "RDX" ? curvature_of_radius(*value) : *value;
    } else {
      s.coefficients[name] = *value;
    }
  } else {
    set_shape(name, s);
  }
  if (problem) return error(fmt::format("{}: {}", name, *problem));
  return std::nullopt;
}

namespace {

double coefficient(const SeqSurface& in, std::string_view name) {
  const auto at = in.coefficients.find(name);
  return at == in.coefficients.end() ? 0.0 : at->second;
}

// Tilts about x and y are left-handed, about z right-handed; each about the axes that the preceding ones have rotated.
Placement placement_of(const SeqSurface& in) {
  const auto move = [&](std::string_view name) {
    const auto at = in.moves.find(name);
    return at == in.moves.end() ? 0.0 : at->second;
  };
  Placement out{.shift = {move("XDE"), move("YDE"), move("ZDE")}};
  if (const double a = move("ADE"); a != 0.0) out = out.then(rotation_about(0, -rad_from_deg(a)));
  if (const double b = move("BDE"); b != 0.0) out = out.then(rotation_about(1, -rad_from_deg(b)));
  if (const double c = move("CDE"); c != 0.0) out = out.then(rotation_about(2, rad_from_deg(c)));
  return out;
}

void set_powers(const SeqSurface& in, SurfaceShape& shape) {
  for (std::size_t k = 0; k < std::size(kSeqPowers); ++k) {
    const double value = coefficient(in, kSeqPowers[k]);
    if (value == 0.0) continue;
    shape.powers.resize(4 + 2 * k);
    shape.powers.back() = value;
  }
}

}  // namespace

Result<DesignSurface> seq_design_surface(const SeqSurface& in, int index, const std::string& file) {
  const auto unsupported = [&](std::string_view what, int line) {
    return failure(ErrorCode::Unsupported, fmt::format("surface {}: {}; it is not computed", index, what),
                   {file, line, 0});
  };
  DesignSurface out;
  out.line = in.line;
  out.thickness = in.thickness;
  out.is_stop = in.is_stop;
  out.opening = in.opening;
  out.obscuration = in.obscuration;
  Vec2& half = out.obscuration.half_mm;  // of an ellipse one axis may be left out
  half = {half.x > 0.0 ? half.x : half.y, half.y > 0.0 ? half.y : half.x};
  if (!out.obscuration.any()) out.obscuration = {};
  out.solve = in.solve;
  const double first = in.first.value_or(0.0);
  out.curvature = in.curvature.value_or(in.radius_mode == RadiusMode::Radius ? curvature_of_radius(first) : first);
  if (coefficient(in, "CUF") != 0.0) return unsupported("a Fresnel surface (CUF)", in.line);
  out.shape.kind = in.kind;
  out.shape.conic = coefficient(in, in.kind == ShapeKind::Biconic ? "KY" : "K");
  if (in.kind == ShapeKind::Biconic) {
    for (const char* name : {"AR", "BR", "CR", "DR"})
      if (coefficient(in, name) != 0.0) return unsupported("an anamorphic asphere's polynomial", in.line);
    out.shape.conic_x = coefficient(in, "KX");
  } else {
    set_powers(in, out.shape);
  }
  if (in.kind != ShapeKind::Revolution) out.shape.curvature_x_per_mm = in.curvature_x;
  if (in.in_x) {
    std::swap(out.curvature, out.shape.curvature_x_per_mm);
    out.shape.rotation_rad = 0.5 * std::numbers::pi;
  }
  const Placement placement = placement_of(in);
  if (!in.refused_move.empty() && !(placement == Placement{}))
    return unsupported(in.refused_move, in.refused_move_line);
  (in.returns ? out.own : out.move) = placement;
  return out;
}

}  // namespace contrejour::inline internal
