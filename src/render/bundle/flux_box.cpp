// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/flux_box.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contrejour::inline internal::bundle {
namespace {

// A polygon with a side of more pixels is split in two first, so that its coverage fits into the processor's cache.
constexpr int kMaxSide = 62;
constexpr std::size_t kPitch = kMaxSide + 2;

constexpr float kNegligibleCoverage = 1e-6F;  // of a pixel: rounding error outside a polygon

using Polygon = std::vector<Vec2>;

// Sutherland-Hodgman against a line parallel to an axis: the part where sign * (coordinate - bound) >= 0 is kept.
template <double Vec2::* coordinate>
Polygon clipped(std::span<const Vec2> polygon, double bound, double sign) {
  Polygon out;
  out.reserve(polygon.size() + 2);
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k];
    const Vec2 b = polygon[k + 1 == polygon.size() ? 0 : k + 1];
    const double da = sign * (a.*coordinate - bound);
    const double db = sign * (b.*coordinate - bound);
    if (da >= 0.0) out.push_back(a);
    if ((da < 0.0) != (db < 0.0)) {
      Vec2 cut = a + (b - a) * (da / (da - db));
      cut.*coordinate = bound;
      out.push_back(cut);
    }
  }
  return out;
}

// The signed area to the right of an edge, pixel by pixel, as differences along the row, whose running sum is the
// coverage. This function adds the part of an edge within one row of pixels, from (x0, .) to (x1, .), of height dy.
void add_stretch(float* row, double x0, double x1, double dy) {
  if (x0 > x1) std::swap(x0, x1);
  const auto first = static_cast<int>(x0);
  const auto last = static_cast<int>(x1);
  if (first == last) {
    const double right = dy * (0.5 * (x0 + x1) - first);
    row[first] += static_cast<float>(dy - right);
    row[first + 1] += static_cast<float>(right);
    return;
  }
  // A trapezium one pixel wide: the area to the right of the edge in columns first .. last is the integral of a ramp.
  const double slope = dy / (x1 - x0);
  const double in_first = first + 1 - x0;
  double before = 0.5 * slope * in_first * in_first;
  double filled = slope * in_first;
  row[first] += static_cast<float>(before);
  for (int x = first + 1; x < last; ++x) {
    const double covered = filled + 0.5 * slope;
    row[x] += static_cast<float>(covered - before);
    before = covered;
    filled += slope;
  }
  const double in_last = x1 - last;
  const double covered = dy - 0.5 * slope * in_last * in_last;
  // The column after the last receives the remaining dy - covered.
  row[last] += static_cast<float>(covered - before);
  row[last + 1] += static_cast<float>(dy - covered);
}

// Notes the columns of a row that edges touch: a convex polygon's coverage is constant between its left and right
// edges.
void note_columns(RowSpan& span, double x0, double x1, bool left) {
  if (left) {
    span.left_end = std::max(span.left_end, static_cast<int>(std::max(x0, x1)) + 1);
  } else {
    span.right_begin = std::min(span.right_begin, static_cast<int>(std::min(x0, x1)));
  }
}

void add_edge(float* cover, RowSpan* spans, Vec2 a, Vec2 b, double sign) {
  if (a.y == b.y) return;
  if (a.y > b.y) {
    std::swap(a, b);
    sign = -sign;
  }
  const double dx_dy = (b.x - a.x) / (b.y - a.y);
  const auto last_row = static_cast<int>(b.y);
  double x = a.x;
  double y = a.y;
  for (int row = static_cast<int>(a.y); row <= last_row; ++row) {
    const double y_next = std::min<double>(row + 1, b.y);
    const double dy = y_next - y;
    if (dy <= 0.0) break;
    const double x_next = y_next == b.y ? b.x : a.x + dx_dy * (y_next - a.y);
    add_stretch(cover + static_cast<std::size_t>(row) * kPitch, x, x_next, sign * dy);
    note_columns(spans[row], x, x_next, sign > 0.0);
    x = x_next;
    y = y_next;
  }
}

// Irradiance along a row of pixels.
struct Ramp {
  float first, slope;
};

// Adds coverage times irradiance to a row's pixels and clears the coverage. Between the edges the running sum is
// constant, so that the loop needs no chain of additions.
void add_row(float* cover, const RowSpan& span, int count, float* out, Ramp ramp) {
  float covered = 0.0F;
  const auto add_summed = [&](int from, int to) {
    for (int k = from; k < to; ++k) {
      covered += cover[k];
      cover[k] = 0.0F;
      out[k] += covered * (ramp.first + ramp.slope * static_cast<float>(k));
    }
  };
  const int level_from = std::min(span.left_end + 1, count);
  const int level_to = std::clamp(span.right_begin, level_from, count);
  add_summed(0, level_from);
  const float level = covered;
  for (int k = level_from; k < level_to; ++k) out[k] += level * (ramp.first + ramp.slope * static_cast<float>(k));
  add_summed(level_to, count);
  cover[count] = 0.0F;
  cover[count + 1] = 0.0F;
}

// The same row with a transmittance for each pixel.
template <class Transmittance>
void add_shared_row(float* cover, int count, float* out, Ramp ramp, const Transmittance& transmittance) {
  float covered = 0.0F;
  for (int k = 0; k < count; ++k) {
    covered += cover[k];
    cover[k] = 0.0F;
    if (covered > kNegligibleCoverage)
      out[k] += covered * (ramp.first + ramp.slope * static_cast<float>(k)) * static_cast<float>(transmittance(k));
  }
  cover[count] = 0.0F;
  cover[count + 1] = 0.0F;
}

double signed_area(std::span<const Vec2> p) {
  double twice = 0.0;
  for (std::size_t k = 2; k < p.size(); ++k) twice += cross(p[k - 1] - p[0], p[k] - p[0]);
  return 0.5 * twice;
}

struct Bounds {
  Vec2 low, high;
};
Bounds bounds_of(std::span<const Vec2> p) {
  Bounds b{p[0], p[0]};
  for (const Vec2 q : p) {
    b.low = {std::min(b.low.x, q.x), std::min(b.low.y, q.y)};
    b.high = {std::max(b.high.x, q.x), std::max(b.high.y, q.y)};
  }
  return b;
}

}  // namespace

FluxBox::FluxBox(const PixelBox& box)
    : box_(box),
      flux_(box.empty() ? 0 : static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height())),
      cover_(kPitch * (kMaxSide + 1)), span_(kMaxSide + 1) {}

void FluxBox::add_point(Vec2 point, double flux) {
  if (!(point.x >= box_.x0 && point.x < box_.x1 && point.y >= box_.y0 && point.y < box_.y1)) return;
  flux_[index(static_cast<int>(point.x), static_cast<int>(point.y))] += static_cast<float>(flux);
}

void FluxBox::add_polygon(std::span<const Vec2> polygon, const Density& density) {
  add_clipped(polygon, density, nullptr);
}

void FluxBox::add_polygon(std::span<const Vec2> polygon, const Density& density,
                          const PixelTransmittance& transmittance) {
  add_clipped(polygon, density, &transmittance);
}

void FluxBox::add_clipped(std::span<const Vec2> polygon, const Density& density,
                          const PixelTransmittance* transmittance) {
  if (polygon.size() < 3) return;
  const Bounds b = bounds_of(polygon);
  if (!(b.high.x > box_.x0 && b.low.x < box_.x1 && b.high.y > box_.y0 && b.low.y < box_.y1)) return;
  const bool crosses = b.low.x < box_.x0 || b.low.y < box_.y0 || b.high.x > box_.x1 || b.high.y > box_.y1;
  if (!crosses) {
    add_inside(polygon, density, transmittance);
    return;
  }
  Polygon part = clipped<&Vec2::x>(polygon, box_.x0, 1.0);
  part = clipped<&Vec2::x>(part, box_.x1, -1.0);
  part = clipped<&Vec2::y>(part, box_.y0, 1.0);
  part = clipped<&Vec2::y>(part, box_.y1, -1.0);
  if (part.size() >= 3) add_inside(part, density, transmittance);
}

void FluxBox::add_halves(std::span<const Vec2> polygon, const Density& density, const PixelTransmittance* transmittance,
                         bool cut_columns, double at) {
  const Polygon low = cut_columns ? clipped<&Vec2::x>(polygon, at, -1.0) : clipped<&Vec2::y>(polygon, at, -1.0);
  const Polygon high = cut_columns ? clipped<&Vec2::x>(polygon, at, 1.0) : clipped<&Vec2::y>(polygon, at, 1.0);
  if (low.size() >= 3) add_inside(low, density, transmittance);
  if (high.size() >= 3) add_inside(high, density, transmittance);
}

void FluxBox::add_inside(std::span<const Vec2> polygon, const Density& density,
                         const PixelTransmittance* transmittance) {
  const Bounds b = bounds_of(polygon);
  const int x0 = std::min(static_cast<int>(b.low.x), box_.x1 - 1);
  const int y0 = std::min(static_cast<int>(b.low.y), box_.y1 - 1);
  const int x1 = std::min(static_cast<int>(b.high.x), box_.x1 - 1);
  const int y1 = std::min(static_cast<int>(b.high.y), box_.y1 - 1);
  const double area = signed_area(polygon);
  if (x1 - x0 >= kMaxSide || y1 - y0 >= kMaxSide) {
    const bool columns = x1 - x0 > y1 - y0;
    add_halves(polygon, density, transmittance, columns, columns ? (x0 + x1 + 1) / 2 : (y0 + y1 + 1) / 2);
    return;
  }
  const auto level = [&](int x, int y) {
    return density.value + dot(density.gradient, Vec2{x + 0.5, y + 0.5} - density.point);
  };
  if (x0 == x1 && y0 == y1) {
    const double passed = transmittance != nullptr ? (*transmittance)({x0 + 0.5, y0 + 0.5}) : 1.0;
    flux_[index(x0, y0)] += static_cast<float>(std::abs(area) * level(x0, y0) * passed);
    return;
  }
  const Vec2 origin{static_cast<double>(x0), static_cast<double>(y0)};
  const double sign = area > 0.0 ? -1.0 : 1.0;  // y increases downwards in memory: left edges rise
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    add_edge(cover_.data(), span_.data(), polygon[k] - origin, polygon[k + 1 == polygon.size() ? 0 : k + 1] - origin,
             sign);
  }
  for (int y = y0; y <= y1; ++y) {
    const auto row = static_cast<std::size_t>(y - y0);
    float* cover = cover_.data() + row * kPitch;
    const Ramp ramp{static_cast<float>(level(x0, y)), static_cast<float>(density.gradient.x)};
    if (transmittance == nullptr)
      add_row(cover, span_[row], x1 - x0 + 1, flux_.data() + index(x0, y), ramp);
    else
      add_shared_row(cover, x1 - x0 + 1, flux_.data() + index(x0, y), ramp,
                     [&](int k) { return (*transmittance)({x0 + k + 0.5, y + 0.5}); });
    span_[row] = {};
  }
}

// Exact lengths pixel by pixel: the line is cut where it crosses the pixels' borders.
void FluxBox::add_line(Vec2 from, Vec2 to, double flux) {
  const Vec2 along = to - from;
  // The part inside the box, as fractions of the line (Liang-Barsky).
  double t0 = 0.0;
  double t1 = 1.0;
  const auto keep = [&](double start, double change, double low, double high) {
    if (change == 0.0) {
      if (start < low || start >= high) t1 = -1.0;
      return;
    }
    const double a = (low - start) / change;
    const double b = (high - start) / change;
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  };
  keep(from.x, along.x, box_.x0, box_.x1);
  keep(from.y, along.y, box_.y0, box_.y1);
  const double step_x = along.x != 0.0 ? 1.0 / std::abs(along.x) : 2.0;
  const double step_y = along.y != 0.0 ? 1.0 / std::abs(along.y) : 2.0;
  const auto next_border = [](double start, double change, double t) {
    if (change == 0.0) return 2.0;
    const double p = start + change * t;
    const double border = change > 0.0 ? std::floor(p) + 1.0 : std::ceil(p) - 1.0;
    return (border - start) / change;
  };
  while (t0 < t1) {
    double next = std::min(next_border(from.x, along.x, t0), next_border(from.y, along.y, t0));
    next = std::clamp(next, t0 + 1e-6 * std::min({step_x, step_y, t1 - t0}), t1);
    add_point(from + along * (0.5 * (t0 + next)), flux * (next - t0));
    t0 = next;
  }
}

FluxBox FluxBox::coarser(int factor) const {
  if (box_.empty()) return FluxBox({});
  FluxBox out({box_.x0 / factor, box_.y0 / factor, (box_.x1 - 1) / factor + 1, (box_.y1 - 1) / factor + 1});
  for (int y = box_.y0; y < box_.y1; ++y) {
    const auto from = row(y);
    for (int x = box_.x0; x < box_.x1; ++x) {
      out.flux_[out.index(x / factor, y / factor)] += from[static_cast<std::size_t>(x - box_.x0)];
    }
  }
  return out;
}

}  // namespace contrejour::inline internal::bundle
