#include "optics/lens_files/sequential/zmx_surface.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/units.h"
#include "optics/lens_files/plain_number.h"

namespace contrejour {
namespace {

constexpr int kFirstTerm =
    3;  // of XDAT: before it stand the number of terms and the radius that heights are divided by

// Coefficients of r^step, r^(2 step), ... that stand in PARM from `first` on.
void add_powers(const ZmxSurface& in, int first, int count, int step, SurfaceShape& shape) {
  for (int k = 0; k < count; ++k) {
    const double value = in.parameter(first + k);
    if (value == 0.0) continue;
    const auto power = static_cast<std::size_t>(step * (k + 1));
    if (shape.powers.size() < power) shape.powers.resize(power);
    shape.powers[power - 1] = value;
  }
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
  const auto tilt = [&](int axis) { return turn_about(axis, rad_from_deg(in.parameter(3 + axis))); };
  const bool tilts_first = in.parameter(6) != 0.0;
  for (const int axis : {0, 1, 2})
    if (const int k = tilts_first ? 2 - axis : axis; in.parameter(3 + k) != 0.0) out = out.then(tilt(k));
  return tilts_first ? out.then(decentre) : decentre.then(out);
}

enum class ZmxType { Standard, EvenAsphere, OddAsphere, ExtendedEven, ExtendedOdd, Toroid, Biconic, Break, Unknown };

ZmxType type_of(std::string_view name) {
  struct Named {
    std::string_view name;
    ZmxType type;
  };
  constexpr Named kTypes[] = {
      {"STANDARD", ZmxType::Standard},     {"EVENASPH", ZmxType::EvenAsphere}, {"ODDASPHE", ZmxType::OddAsphere},
      {"XASPHERE", ZmxType::ExtendedEven}, {"XOSPHERE", ZmxType::ExtendedOdd}, {"XODDASPH", ZmxType::ExtendedOdd},
      {"TOROIDAL", ZmxType::Toroid},       {"BICONICX", ZmxType::Biconic},     {"COORDBRK", ZmxType::Break}};
  for (const Named& known : kTypes)
    if (known.name == name) return known.type;
  return ZmxType::Unknown;
}

// What is wrong, or nothing.
std::optional<std::string> set_shape(const ZmxSurface& in, ZmxType type, SurfaceShape& shape) {
  const std::string too_high =
      fmt::format("its polynomial goes beyond the power {}; no more is computed", SurfaceShape::kHighestPower);
  switch (type) {
    case ZmxType::Standard:
    case ZmxType::Break: break;
    case ZmxType::EvenAsphere: add_powers(in, 1, 8, 2, shape); break;
    case ZmxType::OddAsphere: add_powers(in, 1, 8, 1, shape); break;
    case ZmxType::ExtendedEven:
      if (!add_extended(in, 2, shape)) return too_high;
      break;
    case ZmxType::ExtendedOdd:
      if (!add_extended(in, 1, shape)) return too_high;
      break;
    case ZmxType::Toroid:
      shape.kind = ShapeKind::Toroid;
      shape.curvature_x_per_mm = curvature_of_radius(in.parameter(1));
      add_powers(in, 2, 7, 2, shape);
      if (in.extra(1) != 0.0) return "its Zernike terms are not computed";
      break;
    case ZmxType::Biconic:
      shape.kind = ShapeKind::Biconic;
      shape.curvature_x_per_mm = curvature_of_radius(in.parameter(1));
      shape.conic_x = in.parameter(2);
      break;
    case ZmxType::Unknown:
      return "it is not computed; STANDARD, EVENASPH, ODDASPHE, XASPHERE, XOSPHERE, TOROIDAL, BICONICX and COORDBRK "
             "are";
  }
  return std::nullopt;
}

bool plausible(double n_d, double v_d) { return n_d >= 1.3 && n_d <= 4.2 && (v_d == 0.0 || (v_d >= 10 && v_d <= 150)); }

// What Zemax writes beside a name when it knows no better.
bool is_default(const ZmxGlass& in) { return in.n_d == 1.5 && in.v_d == 40.0; }

Glass model_of(const ZmxGlass& in, std::string name) {
  if (in.v_d == 0.0) return {std::move(name), ConstantIndex{in.n_d}};
  // The partial dispersion of A + B / lambda^2, to all digits: zmx_writer writes those so.
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
  const ZmxType type = type_of(in.type);
  if (const auto problem = set_shape(in, type, out.shape))
    return failure(ErrorCode::Unsupported,
                   fmt::format("surface {} is of type {}: {}", index, shortened(in.type), *problem),
                   {file, in.line, 0});
  if (type == ZmxType::Break) {
    out.is_break = true;
    out.move = coordinate_break(in);
    return out;
  }
  out.is_stop = in.is_stop;
  out.semi_diameter = in.semi_diameter;
  out.is_semi_fixed = in.is_semi_fixed || in.floats;
  out.opening = in.opening;
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
  constexpr double kSameIndex = 2e-3;  // melts and editions of a glass differ by less
  if (in.name == "MIRROR")
    return failure(ErrorCode::Unsupported, "a mirror; lenses of refracting surfaces alone are computed",
                   {file, in.line, 0});
  if (in.name == "AIR" || in.name == "VACUUM") return air();
  const bool blank = in.name.empty() || in.name.starts_with("___");
  if (blank || in.status == 1) {
    if (plausible(in.n_d, in.v_d)) return model_of(in, blank ? "" : in.name);
    return failure(ErrorCode::Parse, fmt::format("a glass of n_d {:g} and V_d {:g}; which is it?", in.n_d, in.v_d),
                   {file, in.line, 0});
  }
  auto found = finder.find(in.name, makers);
  if (!found && !makers.empty()) found = finder.find(in.name);
  if (found) {
    const double n_d = refractive_index(*found, kLineD_nm);
    if (in.n_d > 1.0 && !is_default(in) && in.status == 0 && std::abs(n_d - in.n_d) > kSameIndex)
      warnings.push_back(
          fmt::format("{} (line {}) has n_d {:.5f} in the catalogue, {:.5f} in the file; the catalogue's "
                      "is used",
                      in.name, in.line, n_d, in.n_d));
    if (in.status == 4)
      warnings.push_back(
          fmt::format("{} (line {}) is offset from its catalogue by the file; that of the catalogue is "
                      "used",
                      in.name, in.line));
    return std::move(*found);
  }
  if (plausible(in.n_d, in.v_d) && in.v_d > 0.0 && !is_default(in)) {
    warnings.push_back(fmt::format("no catalogue has the glass {} (line {}); one of its n_d {:g} and V_d {:g} is used",
                                   shortened(in.name), in.line, in.n_d, in.v_d));
    return model_of(in, in.name);
  }
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("{}, or give its catalogue by --catalogue", found.error().message), {file, in.line, 0});
}

}  // namespace contrejour
