// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/limit_error.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kObscurationSag = 3.0;  // an obscuration's edge still curves where that corner is: found by measuring

// The distance between the points at which a side crosses the value 1, for the parabola through the values at its ends
// and its middle, and for the line between its ends: as a fraction of the side; 0 where neither crosses. The local
// slope is used, since heights next to failing rays rise so steeply that the mean slope says little.
double crossing_displacement(double from, double middle, double to) {
  if ((from - 1.0) * (to - 1.0) >= 0.0) return 0.0;
  const double t = (1.0 - from) / (to - from);
  const double curvature = 2.0 * (from - 2.0 * middle + to);
  const double slope = to - from + curvature * (2.0 * t - 1.0);
  const double miss = std::abs(curvature * t * (1.0 - t));
  return miss < std::abs(slope) ? miss / std::abs(slope) : 1.0;
}

// The same displacement for an obscuration, whose edge curves more, so that the deviation in the middle counts too. The
// obscuration may begin and end inside the cell or within one side, where clipping along the outline misses it.
double obscuration_error(const Mesh::Field& v, const Cell& cell) {
  double low = v[cell.middle], off = 0.0, outline = v[cell.corner[0]], mean = 0.0;
  const auto bend = [&](std::size_t a, std::size_t b) { return std::abs(v[a] - 2.0 * v[cell.middle] + v[b]); };
  for (std::size_t k = 0; k < 4; ++k) {
    const double corner = v[cell.corner[k]], side = v[cell.side[k]];
    low = std::min({low, corner, side});
    outline = std::max({outline, corner, side});
    off = std::max(off, std::abs(side - 0.5 * (corner + v[cell.corner[(k + 1) % 4]])));
    mean += 0.25 * corner;
  }
  off = std::max(off, std::abs(v[cell.middle] - mean));
  const double rise = (bend(cell.side[1], cell.side[3]) + bend(cell.side[0], cell.side[2])) / 8.0;
  const double high = std::max(outline, static_cast<double>(v[cell.middle]));
  if (high + rise <= 1.0 || low > 1.0 || !(high > low)) return 0.0;
  return kObscurationSag * (outline > 1.0 ? off : high + rise - 1.0) / (high - low);
}

}  // namespace

double limit_error(const BandContext& band, const Mesh& mesh, const Cell& cell) {
  double largest = 0.0;
  const int first_rim = mesh.layout.rim(0);
  for (int f = band.pattern ? first_rim : PatchLayout::kStop; f < mesh.layout.limits_end(); ++f) {
    const Mesh::Field& v = mesh.field(f);
    if (f >= first_rim && mesh.layout.is_obscuration(f - first_rim)) {
      largest = std::max(largest, obscuration_error(v, cell));
      continue;
    }
    float low = v[cell.corner[0]];
    float high = low;
    for (const std::size_t k : cell.corner) {
      low = std::min(low, v[k]);
      high = std::max(high, v[k]);
    }
    float lowest = std::min(low, v[cell.middle]);  // a rim may pass inside a cell whose corners are all beyond it
    for (const std::size_t k : cell.side) lowest = std::min(lowest, v[k]);
    if (f >= first_rim && (high <= 1.0F || lowest > 1.0F)) continue;
    double off = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      off = std::max(off, std::abs(static_cast<double>(v[cell.side[k]]) -
                                   0.5 * (v[cell.corner[k]] + v[cell.corner[(k + 1) % 4]])));
    }
    // Neighbouring stop fields are the coordinates of one point: the larger of their changes is the scale of both.
    double change = high - low;
    if (f < first_rim) {
      const Mesh::Field& w = mesh.field((f - PatchLayout::kStop) % 2 == 0 ? f + 1 : f - 1);
      for (const std::size_t k : cell.corner)
        change = std::max(change, 2.0 * std::abs(static_cast<double>(w[k]) - w[cell.middle]));
    }
    if (change > 0.0) largest = std::max(largest, off / change);
    for (std::size_t k = 0; f >= first_rim && k < 4; ++k)
      largest =
          std::max(largest, crossing_displacement(v[cell.corner[k]], v[cell.side[k]], v[cell.corner[(k + 1) % 4]]));
  }
  return largest;
}

}  // namespace contrejour::inline internal::adaptive
