// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/zmx_surface.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/units.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/forbes.h"

namespace contrejour::inline internal {
namespace {

constexpr int kFirstTerm =
    3;  // of XDAT: before it stand the number of terms and the radius that heights are divided by

// Coefficients of r^step, r^(2 step), ... that stand in PARM from `first` on: Zemax has eight, some programs write
// more. False for one of a power that is too high.
bool add_powers(const ZmxSurface& in, int first, int step, SurfaceShape& shape) {
  for (const auto& [k, value] : in.parm) {
    if (k < first || value == 0.0) continue;
    if (k - first >= SurfaceShape::kHighestPower / step) return false;
    const auto power = static_cast<std::size_t>(step * (k - first + 1));
    if (shape.powers.size() < power) shape.powers.resize(power);
    shape.powers[power - 1] = value;
  }
  return true;
}

// Coefficients of (r / R)^step, ... that stand in XDAT. False for one of a power that is too high.
bool add_extended(const ZmxSurface& in, int step, SurfaceShape& shape) {
  const int count = static_cast<int>(std::clamp(in.extra(1), 0.0, 1000.0));
  const double radius = in.extra(2) == 0.0 ? 1.0 : in.extra(2);
  for (int k = 0; k < count; ++k) {
    const double value = in.extra(kFirstTerm + k);
    if (value == 0.0) continue;
    const int power = step * (k + 1);
    if (power > SurfaceShape::kHighestPower) return false;
    if (shape.powers.size() < static_cast<std::size_t>(power)) shape.powers.resize(static_cast<std::size_t>(power));
    shape.powers[static_cast<std::size_t>(power) - 1] += value * std::pow(radius, -power);
  }
  return true;
}

// Decentre, then tilts about x, y and z; with an order that is not 0, tilts about z, y and x and then the decentre.
Placement coordinate_break(const ZmxSurface& in) {
  Placement out;
  const Placement decentre{.shift = {in.parameter(1), in.parameter(2), 0.0}};
  const auto tilt = [&](int axis) { return rotation_about(axis, rad_from_deg(in.parameter(3 + axis))); };
  const bool tilts_first = in.parameter(6) != 0.0;
  for (const int axis : {0, 1, 2})
    if (const int k = tilts_first ? 2 - axis : axis; in.parameter(3 + k) != 0.0) out = out.then(tilt(k));
  return tilts_first ? out.then(decentre) : decentre.then(out);
}

enum class ZmxType {
  Standard,
  EvenAsphere,
  OddAsphere,
  ExtendedEven,
  ExtendedOdd,
  Toroid,
  Biconic,
  Forbes,
  Tilted,
  Break,
  Unknown
};

// A type by its name, with a description of its unsupported terms: such a surface is read if all of these are 0.
struct NamedType {
  std::string_view name;
  ZmxType type = ZmxType::Unknown;
  std::string_view beyond = {};
};

NamedType type_of(std::string_view name) {
  constexpr NamedType kTypes[] = {{"STANDARD", ZmxType::Standard},
                                  {"EVENASPH", ZmxType::EvenAsphere},
                                  {"ODDASPHE", ZmxType::OddAsphere},
                                  {"XASPHERE", ZmxType::ExtendedEven},
                                  {"XOSPHERE", ZmxType::ExtendedOdd},
                                  {"XODDASPH", ZmxType::ExtendedOdd},
                                  {"TOROIDAL", ZmxType::Toroid, "Zernike terms"},
                                  {"BICONICX", ZmxType::Biconic},
                                  {"QED_TYPE", ZmxType::Forbes},
                                  {"TILTSURF", ZmxType::Tilted},
                                  {"COORDBRK", ZmxType::Break},
                                  {"BINARY_1", ZmxType::EvenAsphere, "phase"},
                                  {"BINARY_2", ZmxType::EvenAsphere, "phase"},
                                  {"FZERNSAG", ZmxType::EvenAsphere, "Zernike terms"},
                                  {"SZERNSAG", ZmxType::EvenAsphere, "Zernike terms"},
                                  {"XPOLYNOM", ZmxType::Standard, "polynomial in x and y"},
                                  {"IRREGULA", ZmxType::Standard, "irregularity"}};
  for (const NamedType& known : kTypes)
    if (known.name == name) return known;
  return {name};
}

// True if unsupported terms are not 0: they are in XDAT behind their number and radius, IRREGULA's in PARM.
bool has_terms_beyond(const ZmxSurface& in, const NamedType& type) {
  if (type.beyond.empty()) return false;
  const auto is_term = [](int first) { return [=](const auto& at) { return at.first >= first && at.second != 0.0; }; };
  if (type.name == "IRREGULA") return std::any_of(in.parm.begin(), in.parm.end(), is_term(1));
  if (type.type == ZmxType::Toroid) return in.extra(1) != 0.0;
  return std::any_of(in.xdat.begin(), in.xdat.end(), is_term(kFirstTerm));
}

// A plane that rises by these tangents along x and y.
Placement tilted_plane(double along_x, double along_y) {
  const double slant = std::sqrt(1.0 + along_x * along_x + along_y * along_y);
  return rotation_about(0, std::atan(along_y)).then(rotation_about(1, -std::asin(along_x / slant)));
}

// Forbes' asphere: XDAT 1 is 0 for Qbfs and 1 for Qcon, 2 the number of terms, 3 the norm radius, from 4 on Q_0, Q_1,
// ... What is wrong, or nothing.
std::optional<std::string> set_forbes(const ZmxSurface& in, SurfaceShape& shape) {
  constexpr double kMaxOff = 1e-5;
  constexpr int kFirstOfForbes = 4;
  ForbesAsphere asphere;
  if (in.extra(1) != 0.0 && in.extra(1) != 1.0) return fmt::format("its type is {:g}; 0 and 1 are known", in.extra(1));
  asphere.kind = in.extra(1) == 0.0 ? ForbesKind::Bfs : ForbesKind::Con;
  asphere.norm_radius = in.extra(3);
  if (!(asphere.norm_radius > 0.0)) return fmt::format("its norm radius is {:g}", asphere.norm_radius);
  if (!(in.extra(2) <= static_cast<double>(ForbesAsphere::kMaxTerms)))
    return fmt::format("{:g} terms; at most {} are computed", in.extra(2), ForbesAsphere::kMaxTerms);
  for (int k = 0; k < static_cast<int>(in.extra(2)); ++k) asphere.coefficients.push_back(in.extra(kFirstOfForbes + k));
  const double reach = in.semi_diameter > 0.0 ? in.semi_diameter : asphere.norm_radius;
  const auto fitted = powers_of_forbes(in.curvature, in.conic, asphere, reach);
  if (!fitted) return fmt::format("its conic ends within {:g} of the axis", reach);
  if (fitted->off > kMaxOff)
    return fmt::format("powers up to r^{} miss it by {:.2g}; no more are computed", SurfaceShape::kHighestPower,
                       fitted->off);
  shape.powers = fitted->powers;
  return std::nullopt;
}

// What is wrong, or nothing.
std::optional<std::string> set_shape(const ZmxSurface& in, const NamedType& named, SurfaceShape& shape) {
  if (has_terms_beyond(in, named)) return fmt::format("its {} are not computed", named.beyond);
  const std::string too_high =
      fmt::format("its polynomial goes beyond the power {}; no more is computed", SurfaceShape::kHighestPower);
  switch (named.type) {
    case ZmxType::Standard:
    case ZmxType::Tilted:
    case ZmxType::Break: break;
    case ZmxType::EvenAsphere:
      if (!add_powers(in, 1, 2, shape)) return too_high;
      break;
    case ZmxType::OddAsphere:
      if (!add_powers(in, 1, 1, shape)) return too_high;
      break;
    case ZmxType::ExtendedEven:
      if (!add_extended(in, 2, shape)) return too_high;
      break;
    case ZmxType::ExtendedOdd:
      if (!add_extended(in, 1, shape)) return too_high;
      break;
    case ZmxType::Toroid:
      shape.kind = ShapeKind::Toroid;
      shape.curvature_x_per_mm = curvature_of_radius(in.parameter(1));
      if (!add_powers(in, 2, 2, shape)) return too_high;
      break;
    case ZmxType::Biconic:
      shape.kind = ShapeKind::Biconic;
      shape.curvature_x_per_mm = curvature_of_radius(in.parameter(1));
      shape.conic_x = in.parameter(2);
      break;
    case ZmxType::Forbes: return set_forbes(in, shape);
    case ZmxType::Unknown:
      return "it is not computed; STANDARD, EVENASPH, ODDASPHE, XASPHERE, XOSPHERE, QED_TYPE, TOROIDAL, BICONICX, "
             "TILTSURF and COORDBRK are";
  }
  return std::nullopt;
}

bool plausible(double n_d, double v_d) { return n_d >= 1.3 && n_d <= 4.2 && (v_d == 0.0 || (v_d >= 10 && v_d <= 150)); }

// True for the numbers that Zemax writes with a name by default.
bool is_default(const ZmxGlass& in) { return in.n_d == 1.5 && in.v_d == 40.0; }

// A glass with n_d and V_d changed by these amounts and its other dispersion unchanged, as a table accurate to 1e-6.
Result<Glass> moved_glass(const Glass& glass, std::string name, double more_n_d, double more_v_d) {
  constexpr double kFirst_nm = 340.0, kLast_nm = 1100.0, kStep_nm = 5.0;
  const GlassFigures from = glass_figures(glass);
  const double n_d = from.n_d + more_n_d, v_d = from.v_d + more_v_d;
  const double spread = std::isfinite(v_d) && v_d > 0.0 ? (n_d - 1.0) / v_d * from.v_d / (from.n_d - 1.0) : 1.0;
  GlassData data;
  data.formula = DispersionFormula::Table;
  for (double nm = kFirst_nm; nm <= kLast_nm; nm += kStep_nm) {
    const double n = n_d + spread * (refractive_index(glass, nm) - from.n_d);
    data.coefficients.insert(data.coefficients.end(), {um_from_nm(nm), n});
  }
  return make_glass(std::move(name), std::move(data));
}

Glass model_of(const ZmxGlass& in, std::string name) {
  if (in.v_d == 0.0) return {std::move(name), ConstantIndex{in.n_d}};
  // An AbbeGlass, A + B / lambda^2, is recognised by its exact partial dispersion, which zmx_writer writes.
  Glass abbe{name, AbbeGlass{in.n_d, in.v_d}};
  if (in.d_pgf != 0.0 && std::abs(glass_figures(abbe).d_pgf - in.d_pgf) < 1e-15) return abbe;
  return {std::move(name), ModelGlass{in.n_d, in.v_d, in.d_pgf}};
}

}  // namespace

Result<DesignSurface> zmx_surface(const ZmxSurface& in, int index, const std::string& file) {
  DesignSurface out;
  out.line = in.line;
  out.curvature = in.curvature;
  out.thickness = in.thickness;
  out.solve = in.solve;
  out.shape.conic = in.conic;
  const NamedType type = type_of(in.type);
  if (const auto problem = set_shape(in, type, out.shape))
    return failure(ErrorCode::Unsupported,
                   fmt::format("surface {} is of type {}: {}", index, shortened(in.type), *problem),
                   {file, in.line, 0});
  if (in.own_tilt_line != 0 && !(in.glass && in.glass->name == "MIRROR"))
    return failure(ErrorCode::Unsupported,
                   "a decentre or tilt of the surface's own (SCBD) is not computed; use a coordinate break",
                   {file, in.own_tilt_line, 0});
  if (type.type == ZmxType::Break) {
    out.is_break = true;
    out.move = coordinate_break(in);
    return out;
  }
  if (type.type == ZmxType::Tilted) {
    out.curvature = out.shape.conic = 0.0;
    const double along_x = in.parameter(1), along_y = in.parameter(2);
    if (!std::isfinite(along_x) || !std::isfinite(along_y))
      return failure(ErrorCode::Parse, fmt::format("surface {}: a tilt's tangent is infinite", index),
                     {file, in.line, 0});
    if (along_x != 0.0 || along_y != 0.0) out.own = tilted_plane(along_x, along_y);
  }
  out.is_stop = in.is_stop;
  out.semi_diameter = in.semi_diameter;
  out.is_semi_fixed = in.is_semi_fixed || in.floats;
  out.opening = in.opening;
  out.obscuration = in.obscuration;
  const bool needs_size = out.opening && !(out.opening->half_x > 0.0 && out.opening->half_y > 0.0);
  if ((in.floats && !out.opening && in.semi_diameter > 0.0) || needs_size) {
    if (!out.opening) out.opening = DesignOpening{.line = in.line};
    out.opening->half_x = out.opening->half_y = in.semi_diameter;
    if (in.semi_diameter == 0.0) out.opening.reset();
  }
  return out;
}

Result<Glass> zmx_glass(const ZmxGlass& in, std::span<const std::string> makers, GlassFinder& finder,
                        const std::string& file, std::vector<std::string>& warnings) {
  constexpr double kSameIndex = 2e-3;  // melts and catalogue editions of a glass differ by less
  if (in.name == "MIRROR")
    return failure(ErrorCode::Unsupported, "a mirror; lenses of refracting surfaces alone are computed",
                   {file, in.line, 0});
  if (in.name == "AIR" || in.name == "VACUUM") return air();
  if (in.is_blank() || in.status == ZmxGlass::Status::Model) {
    if (plausible(in.n_d, in.v_d)) return model_of(in, in.is_blank() ? "" : in.name);
    return failure(ErrorCode::Parse, fmt::format("a glass of n_d {:g} and V_d {:g}; which is it?", in.n_d, in.v_d),
                   {file, in.line, 0});
  }
  auto found = finder.find(in.name, makers);
  if (!found && !makers.empty()) found = finder.find(in.name);
  if (found) {
    const double n_d = refractive_index(*found, kLineD_nm);
    if (in.n_d > 1.0 && !is_default(in) && in.status == ZmxGlass::Status::Named && std::abs(n_d - in.n_d) > kSameIndex)
      warnings.push_back(
          fmt::format("{} (line {}) has n_d {:.5f} in the catalogue, {:.5f} in the file; the catalogue's "
                      "is used",
                      in.name, in.line, n_d, in.n_d));
    if (in.status != ZmxGlass::Status::Offset || (in.more_n_d == 0.0 && in.more_v_d == 0.0)) return std::move(*found);
    auto moved = moved_glass(*found, in.name + " offset", in.more_n_d, in.more_v_d);
    if (!moved)
      return failure(ErrorCode::Parse,
                     fmt::format("{} with n_d moved by {:g} and V_d by {:g}: {}", in.name, in.more_n_d, in.more_v_d,
                                 moved.error().message),
                     {file, in.line, 0});
    return moved;
  }
  if (plausible(in.n_d, in.v_d) && in.v_d > 0.0 && !is_default(in)) {
    warnings.push_back(fmt::format("no catalogue has the glass {} (line {}); one of its n_d {:g} and V_d {:g} is used",
                                   shortened(in.name), in.line, in.n_d, in.v_d));
    return model_of(in, in.name);
  }
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("{}, or give its catalogue by --catalogue", found.error().message), {file, in.line, 0});
}

}  // namespace contrejour::inline internal
