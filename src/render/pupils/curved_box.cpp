// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/curved_box.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Dense>

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kProbeColumns = 64, kProbeRows = 12;     // of the upper half
constexpr std::size_t kMinRows = 4;       // with light, to fit a side to
constexpr double kCurvedMargin = 0.1;              // of the light's extent, on a side without failing rays within it
constexpr double kMinMargin = 0.03;        // closer to failing rays polynomials are inaccurate
constexpr double kTopMargin = 0.02;          // of its height, where a pupil next to a rim is narrow
constexpr double kMinJacobian = 0.1;
constexpr std::array kCurveFractions{0.0, 0.25, 0.5, 0.75,
                                     1.0};  // of the fitted curve; curved cells are harder to draw
constexpr double kNone = std::numeric_limits<double>::infinity();

double x_of(const ClearanceGrid& grid, int column) { return grid.box().low.x + column * grid.cell_size().x; }
double y_of(const ClearanceGrid& grid, int row) { return grid.box().low.y + row * grid.cell_size().y; }

// One row of a grid: the ends of its light, and the nearest failing rays on either side, if any.
struct Row {
  double y = 0.0, low = 0.0, high = 0.0, fails_below = -kNone, fails_above = kNone;
};

// The light's edge between an open column and its neighbour, which is not open.
double light_edge(const ClearanceGrid& grid, int row, int open, int beyond) {
  if (grid.fails(grid.at(beyond, row))) return x_of(grid, beyond);
  const double inside = grid.excess(grid.at(open, row)), outside = grid.excess(grid.at(beyond, row));
  return x_of(grid, open) + (x_of(grid, beyond) - x_of(grid, open)) * inside / (inside - outside);
}

// The edge between a column that fails and the next in the direction of step, 1 or -1, which does not.
double failing_edge(const ClearanceGrid& grid, int row, int column, int step) {
  const int before = column - step;
  const bool known = before >= 0 && before <= grid.columns() && grid.fails(grid.at(before, row));
  const double fraction = known ? grid.arrives_after(grid.at(before, row), grid.at(column, row)) : 1.0;
  return x_of(grid, column) + step * std::min(fraction, 1.0) * grid.cell_size().x;
}

std::vector<Row> illuminated_rows(const ClearanceGrid& grid) {
  std::vector<Row> rows;
  for (int row = 0; row <= grid.rows(); ++row) {
    const auto open = [&](int column) { return grid.is_open(grid.at(column, row)); };
    const auto fails = [&](int column) { return grid.fails(grid.at(column, row)); };
    int first = 0, last = grid.columns();
    while (first <= last && !open(first)) ++first;
    while (last > first && !open(last)) --last;
    if (first > last) continue;
    Row illuminated{.y = y_of(grid, row)};
    illuminated.low = first == 0 ? x_of(grid, 0) : light_edge(grid, row, first, first - 1);
    illuminated.high = last == grid.columns() ? x_of(grid, last) : light_edge(grid, row, last, last + 1);
    int below = first, above = last;
    while (below >= 0 && !fails(below)) --below;
    while (above <= grid.columns() && !fails(above)) ++above;
    if (below >= 0) illuminated.fails_below = failing_edge(grid, row, below, 1);
    if (above <= grid.columns()) illuminated.fails_above = failing_edge(grid, row, above, -1);
    rows.push_back(illuminated);
  }
  return rows;
}

// The upper end of the light: where the smallest excess of a row, interpolated between rows, becomes 0.
double top_of(const ClearanceGrid& grid) {
  double y = 0.0, before = 0.0;
  for (int row = 0; row <= grid.rows(); ++row) {
    double smallest = kNone;
    for (int column = 0; column <= grid.columns(); ++column) {
      const std::size_t ray = grid.at(column, row);
      if (!grid.fails(ray)) smallest = std::min<double>(smallest, grid.excess(ray));
    }
    if (smallest <= 0.0)
      y = y_of(grid, row);
    else if (before < 0.0)
      y = y_of(grid, row) + grid.cell_size().y * (std::isinf(smallest) ? 0.0 : smallest / (before - smallest));
    before = smallest;
  }
  return y;
}

// The data of a box at one wavelength.
struct Probe {
  const ClearanceGrid& grid;
  std::vector<Row> rows;  // with light
  double top;
};

// A least-squares curve midway between the light's edge and the failing rays next to it: the box's curved side.
struct Between {
  double x_mm;  // on the axis
  Side side;
};

Between fitted(const std::vector<Row>& rows, bool low) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixX3d powers(count, 3);
  Eigen::VectorXd x(count);
  const double unit = rows.back().y;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Row& row = rows[static_cast<std::size_t>(k)];
    const double edge = low ? row.low : row.high, fails = low ? row.fails_below : row.fails_above;
    const double squared = row.y * row.y / (unit * unit);
    powers.row(k) << 1.0, squared, squared * squared;
    x[k] = std::isinf(fails) ? edge : 0.5 * (edge + fails);
  }
  const Eigen::Vector3d c = powers.colPivHouseholderQr().solve(x);
  return {c[0], {c[1] / (unit * unit), c[2] / (unit * unit * unit * unit)}};
}

struct Extent {
  double low = kNone, high = -kNone;
};

// Shrinks `extent` along x until it contains no failing ray of the probe, on either side of `middle`.
void keep_failing_out(Extent& extent, const ClearanceGrid& grid, double middle, double top, const SideCurve& curve) {
  for (int row = 0; row <= grid.rows() && y_of(grid, row) < top + 0.5 * grid.cell_size().y; ++row) {
    const double y = y_of(grid, row);
    for (int column = 0; column <= grid.columns(); ++column) {
      if (!grid.fails(grid.at(column, row))) continue;
      const bool below = curve.box_x({x_of(grid, column), y}) < middle;
      const int step = below ? 1 : -1, next = column + step;
      const bool last = next < 0 || next > grid.columns() || grid.fails(grid.at(next, row));
      const double x = curve.box_x({last ? x_of(grid, column) : failing_edge(grid, row, column, step), y});
      if (below)
        extent.low = std::max(extent.low, x);
      else
        extent.high = std::min(extent.high, x);
    }
  }
}

// The box with this curvature that contains the light of all probes, if failing rays can be kept out of it.
std::optional<CurvedBox> box_about(std::span<const Probe> probes, const SideCurve& curve, double highest) {
  Extent light;
  double top = 0.0, min_jacobian = 1.0;
  for (const Probe& probe : probes) {
    top = std::max(top, probe.top);
    for (const Row& row : probe.rows) {
      min_jacobian = std::min(min_jacobian, curve.jacobian_x(row.y));
      light.low = std::min(light.low, curve.box_x({row.low, row.y}));
      light.high = std::max(light.high, curve.box_x({row.high, row.y}));
    }
  }
  top = std::min(top * (1.0 + kTopMargin), highest);
  const double width = light.high - light.low;
  min_jacobian = std::min(min_jacobian, curve.jacobian_x(top));
  if (min_jacobian < kMinJacobian || !(width > 0.0)) return std::nullopt;
  Extent extent{light.low - kCurvedMargin * width, light.high + kCurvedMargin * width};
  for (const Probe& probe : probes) keep_failing_out(extent, probe.grid, 0.5 * (light.low + light.high), top, curve);
  const double min_margin = kMinMargin * width;
  if (extent.low > light.low - min_margin || extent.high < light.high + min_margin) return std::nullopt;
  return CurvedBox{{{extent.low, -top}, {extent.high, top}}, curve};
}

}  // namespace

std::optional<CurvedBox> curved_box(std::span<ClearanceGrid> wavelengths, const Rectangle& box) {
  std::vector<Probe> probes;
  const auto probe = [&](ClearanceGrid& grid) {
    grid.trace({{box.low.x, 0.0}, box.high}, kProbeColumns, kProbeRows);
    probes.push_back({grid, illuminated_rows(grid), top_of(grid)});
    return probes.back().rows.size() >= kMinRows;
  };
  if (!probe(wavelengths.front())) return std::nullopt;
  const std::vector<Row> rows = probes.front().rows;
  const auto failing_below = std::ranges::count_if(rows, [](const Row& r) { return std::isfinite(r.fails_below); });
  const auto failing_above = std::ranges::count_if(rows, [](const Row& r) { return std::isfinite(r.fails_above); });
  const bool low = failing_below > failing_above;
  const Between between = fitted(rows, low);
  for (const double part : kCurveFractions) {
    const Side side{part * between.side.by_y2, part * between.side.by_y4};
    const SideCurve curve =
        low ? SideCurve{between.x_mm, box.high.x, side, {}} : SideCurve{box.low.x, between.x_mm, {}, side};
    auto found = box_about(probes, curve, box.high.y);
    // The other wavelengths are traced once a box fits the first.
    while (found && probes.size() < wavelengths.size()) {
      if (!probe(wavelengths[probes.size()])) return std::nullopt;
      found = box_about(probes, curve, box.high.y);
    }
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace contrejour::inline internal::pupils
