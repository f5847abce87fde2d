// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/design_positions.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace contrejour::inline internal {
namespace {

std::vector<double> own_thicknesses(const SequentialDesign& design) {
  std::vector<double> out;
  for (const DesignSurface& surface : design.surfaces) out.push_back(surface.thickness);
  return out;
}

void solve(const SequentialDesign& design, std::vector<double>& thickness) {
  for (std::size_t k = 0; k < thickness.size(); ++k) {
    if (!design.surfaces[k].solve) continue;
    const ThicknessSolve& by = *design.surfaces[k].solve;
    if (by.from < 0 || static_cast<std::size_t>(by.from) >= k) continue;
    const auto from = static_cast<std::size_t>(by.from);
    double sum = 0.0;
    for (std::size_t j = from; j < k; ++j) sum += thickness[j];
    switch (by.kind) {
      case ThicknessSolve::Kind::Pickup: thickness[k] = by.scale * thickness[from] + by.offset; break;
      case ThicknessSolve::Kind::Sum: thickness[k] = by.offset - sum; break;
      case ThicknessSolve::Kind::Pair: thickness[k] = by.offset - thickness[from]; break;
    }
  }
}

}  // namespace

std::vector<DesignPosition> positions_of(const SequentialDesign& design, std::vector<std::string>& warnings) {
  std::vector<DesignPosition> positions = design.positions;
  for (auto& position : positions) solve(design, position.thickness);
  if (positions.empty()) positions.push_back({own_thicknesses(design)});
  const auto distant = [](const DesignPosition& p) { return std::isinf(p.thickness.front()); };
  const std::size_t near = static_cast<std::size_t>(
      std::count_if(positions.begin(), positions.end(), [&](const auto& position) { return !distant(position); }));
  if (near == positions.size()) {
    warnings.push_back(fmt::format("designed for an object {:.6g} mm in front of it (line {}); focus is set by --focus",
                                   positions.front().thickness.front() * design.unit_mm, design.surfaces.front().line));
  } else if (near > 0) {
    std::erase_if(positions, [&](const auto& position) { return !distant(position); });
    warnings.push_back(fmt::format("{} of {} positions are for near objects and left out: focusing moves the sensor",
                                   near, design.positions.size()));
  }
  return positions;
}

}  // namespace contrejour::inline internal
