// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/zmx_block.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/near_name.h"

namespace contrejour::inline internal {
namespace {

DesignOpening& opening_of(ZmxSurface& surface, int line) {
  if (!surface.opening) surface.opening = DesignOpening{.line = line};
  return *surface.opening;
}

void obscure(ZmxSurface& surface, double half_x, double half_y) {
  if (half_x > 0.0 && half_y > 0.0) surface.obscuration.half_mm = {half_x, half_y};
}

void read_glass(const ZmxRow& row, ZmxSurface& surface) {
  ZmxGlass glass{.line = row.line(), .name = std::string(row.word(1))};
  glass.status = static_cast<ZmxGlass::Status>(std::clamp(row.whole(2), 0, 5));
  glass.from = row.whole(3);
  glass.n_d = row.number(4);
  glass.v_d = row.number(5);
  glass.d_pgf = row.number(6);
  glass.more_n_d = row.number(10);
  glass.more_v_d = row.number(11);
  surface.glass = std::move(glass);
}

bool read_opening(const ZmxRow& row, ZmxSurface& surface, std::vector<std::string>& warnings) {
  const int line = row.line();
  if (row.is("CLAP")) {
    obscure(surface, row.number(1), row.number(1));
    DesignOpening& opening = opening_of(surface, line);
    opening.half_x = opening.half_y = row.number(2);
  } else if (row.is("FLAP")) {
    surface.floats = true;
    obscure(surface, row.number(1), row.number(1));
  } else if (row.is_one_of({"SQAP", "ELAP"})) {
    opening_of(surface, line).shape = row.is("SQAP") ? OpeningShape::Rectangle : OpeningShape::Ellipse;
    surface.opening->half_x = row.number(1);
    surface.opening->half_y = row.number(2);
  } else if (row.is("OBDC")) {
    const Vec2 centre{row.number(1), row.number(2)};
    if (surface.obscuration.any()) surface.obscuration.centre_mm = centre;
    if (surface.opening || !surface.obscuration.any()) opening_of(surface, line).centre = centre;
  } else if (row.is("OBSC") && row.number(1) == 0.0) {
    obscure(surface, row.number(2), row.number(2));
  } else if (row.is("ELOB")) {
    obscure(surface, row.number(1), row.number(2));
  } else if (row.is_one_of({"OBSC", "SQOB", "SPID"})) {
    warnings.push_back(
        fmt::format("the obscuration {} (line {}) is not computed; light goes through", row.word(0), line));
  } else if (row.is_one_of({"UDAP", "USAP", "UDOB", "USOB"})) {
    warnings.push_back(fmt::format("the aperture {} (line {}) is drawn in a file of its own; the semi-diameter is used",
                                   row.word(0), line));
  } else {
    return false;
  }
  return true;
}

bool read_solve(const ZmxRow& row, ZmxSurface& surface) {
  auto& solve = surface.solve;
  if (row.is("PZUP")) {
    solve = ThicknessSolve{ThicknessSolve::Kind::Pickup, row.whole(1), row.number(2), row.number(3)};
  } else if (row.is("TOLE")) {
    solve = ThicknessSolve{ThicknessSolve::Kind::Sum, row.whole(1), 1.0, row.number(2)};
  } else if (row.is("TCOM")) {
    solve = ThicknessSolve{ThicknessSolve::Kind::Pair, row.whole(1), 1.0, row.number(2)};
  } else if (row.is("MAZH")) {
    surface.is_to_focus = row.number(1) == 0.0 && row.number(2) == 0.0;
  } else {
    return false;
  }
  return true;
}

}  // namespace

bool zmx_is_passed_over(std::string_view keyword) {
  static const std::set<std::string_view> kWords = {
      "SSID", "COMM", "FIMP", "HIDE", "MIRR", "SLAB", "POPS", "OEMA", "MEMA", "VPAR", "PPAR", "VDSZ", "CAZH", "VCON",
      "PCON", "TCED", "GLRS", "PKUP", "PZSP", "ISNA", "FZSP", "VXDT", "PXDT", "THIC", "BLNK", "DRAW", "SCAT", "CHZN",
      "EMAR", "PMAR", "LSMO", "ARTP", "ROWC", "SHAD", "OPDM", "MARG", "MRGA", "CHRA", "EDGE", "NOTE", "IDNT"};
  return kWords.contains(keyword);
}

bool read_zmx_surface_row(const ZmxRow& row, ZmxSurface& s, std::vector<std::string>& warnings) {
  constexpr std::size_t kMaxZmxNumbers = 1000;
  if (row.is("TYPE")) {
    s.type = row.word(1);
  } else if (row.is("CURV")) {
    s.curvature = row.number(1);
  } else if (row.is("DISZ")) {
    s.thickness = row.number_or_infinity(1);
  } else if (row.is("CONI")) {
    s.conic = row.number(1);
  } else if (row.is("PARM")) {
    if (s.parm.size() < kMaxZmxNumbers) s.parm[row.whole(1)] = row.number_or_infinity(2);
  } else if (row.is("XDAT")) {
    if (s.xdat.size() < kMaxZmxNumbers) s.xdat[row.whole(1)] = row.number(2);
  } else if (row.is("STOP")) {
    s.is_stop = true;
  } else if (row.is("GLAS")) {
    read_glass(row, s);
  } else if (row.is("DIAM")) {
    const double semi = std::abs(row.number_or_infinity(1));
    s.semi_diameter = std::isinf(semi) ? 0.0 : semi;
    s.is_semi_fixed = row.whole(2) != 0;
  } else if (row.is("SCBD")) {
    for (std::size_t k = 4; k < row.size(); ++k)  // before or behind it, two flags, decentre and tilts
      if (row.number(k) != 0.0) s.own_tilt_line = row.line();
  } else if (row.is("COAT")) {
    if (s.coating.empty() && row.size() > 1)
      s.coating = fmt::format("{} (line {})", shortened(row.word(1)), row.line());
  } else {
    return read_opening(row, s, warnings) || read_solve(row, s);
  }
  return true;
}

}  // namespace contrejour::inline internal
