// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/limit_error.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/scalar.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kDiagonal = 1.4142135623730951;  // of a cell, in sides
constexpr double kObscurationSag = 3.0;  // an obscuration's edge still curves where that corner is: found by measuring

// How fast heights over that of a rim or the stop rise across its edge, per length of a side, for a paraboloid with the
// cell's middle, slope and mean curvature. Where a ghost is about to vanish its edge lies next to the least height, and
// heights hardly rise there.
template <class Height>
double edge_slope(const Height& height, const Cell& cell) {
  const double middle = height(cell.middle);
  const std::array<double, 4> side = {height(cell.side[0]), height(cell.side[1]), height(cell.side[2]),
                                      height(cell.side[3])};
  const double curvature = 2.0 * (side[0] + side[1] + side[2] + side[3] - 4.0 * middle);
  const double squared = square(side[1] - side[3]) + square(side[2] - side[0]) + 2.0 * curvature * (1.0 - middle);
  return std::sqrt(std::max(squared, 0.0));
}

// The displacement of an edge where heights are off by this much, as a fraction of the cell.
double edge_displacement(double off, double slope) {
  return off <= 0.0 ? 0.0 : off < kDiagonal * slope ? off / (kDiagonal * slope) : 1.0;
}

// The displacement of the iris's edge: its circumscribed circle counts. Squared distances from its middle are heights,
// which rise twice as fast as distances at the edge and are off by twice as much. f: the field of the crossing's x.
double iris_displacement(const Mesh& mesh, int f, const Cell& cell) {
  const Mesh::Field &x = mesh.field(f), &y = mesh.field(f + 1);
  const auto height = [&](std::size_t k) { return static_cast<double>(x[k] * x[k] + y[k] * y[k]); };
  double low = height(cell.middle), high = low, off = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t from = cell.corner[k], middle = cell.side[k], to = cell.corner[(k + 1) % 4];
    low = std::min({low, height(from), height(middle)});
    high = std::max({high, height(from), height(middle)});
    const float off_x = x[middle] - 0.5F * (x[from] + x[to]), off_y = y[middle] - 0.5F * (y[from] + y[to]);
    off = std::max(off, 2.0 * std::abs(static_cast<double>(off_x * x[middle] + off_y * y[middle])));
  }
  return low <= 1.0 && high >= 1.0 ? edge_displacement(off, edge_slope(height, cell)) : 0.0;
}

// How far an edge lies beyond a side that it crosses twice, as a fraction of the side: the polygon ends at the side.
double missed_beyond_side(double from, double middle, double to, double slope) {
  const bool is_crossed_twice = (from - 1.0) * (to - 1.0) > 0.0 && (from - 1.0) * (middle - 1.0) < 0.0;
  if (!is_crossed_twice) return 0.0;
  const double off = std::abs(middle - 1.0);
  return off < slope ? off / slope : 1.0;
}

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
    if (f < first_rim) {
      if (change > 0.0) largest = std::max(largest, off / change);
      if ((f - PatchLayout::kStop) % 2 == 0) largest = std::max(largest, iris_displacement(mesh, f, cell));
      continue;
    }
    const double slope = edge_slope([&](std::size_t k) { return static_cast<double>(v[k]); }, cell);
    if (change > 0.0) largest = std::max(largest, off / change);
    largest = std::max(largest, edge_displacement(off, slope));
    for (std::size_t k = 0; k < 4; ++k) {
      const double from = v[cell.corner[k]], middle = v[cell.side[k]], to = v[cell.corner[(k + 1) % 4]];
      largest =
          std::max({largest, crossing_displacement(from, middle, to), missed_beyond_side(from, middle, to, slope)});
    }
  }
  return largest;
}

}  // namespace contrejour::inline internal::adaptive
