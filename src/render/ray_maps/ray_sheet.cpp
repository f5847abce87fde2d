// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/ray_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "render/pupils/open_cells.h"
#include "render/ray_maps/lobatto.h"

namespace contrejour::inline internal::ray_maps {
namespace {

// A rim counts if a ray of the sheet exceeds this squared relative height.
constexpr float kNearRim = 0.94F;

// The largest of at least one value: eight independent maxima, since each comparison waits for the preceding one of its
// maximum.
float highest_of(const float* values, std::size_t count) {
  std::array<float, 8> most;
  most.fill(values[0]);
  std::size_t k = 0;
  for (; k + most.size() <= count; k += most.size()) {
    for (std::size_t lane = 0; lane < most.size(); ++lane) most[lane] = std::max(most[lane], values[k + lane]);
  }
  for (; k < count; ++k) most[0] = std::max(most[0], values[k]);
  return *std::max_element(most.begin(), most.end());
}

// Fills the rows below the middle by symmetry from those above it.
void complete(float* values, int nodes, float sign) {
  const auto n = static_cast<std::size_t>(nodes);
  for (std::size_t row = 0; row < n / 2; ++row) {
    for (std::size_t k = 0; k < n; ++k) values[row * n + k] = sign * values[(n - 1 - row) * n + k];
  }
}

// Rows in the opposite order.
void turn_over(float* values, int nodes, float sign) {
  const auto n = static_cast<std::size_t>(nodes);
  for (std::size_t row = 0; row < n / 2; ++row)
    std::swap_ranges(values + row * n, values + (row + 1) * n, values + (n - 1 - row) * n);
  if (sign == 1.0F) return;
  for (std::size_t k = 0; k < n * n; ++k) values[k] *= sign;
}

}  // namespace

void add_light(RaySheet& sheet, std::span<const float> transmission, const std::array<double, 3>& gain) {
  if (sheet.weight.empty()) {
    sheet.weight.emplace_back(transmission.begin(), transmission.end());
    sheet.gain = gain;
    return;
  }
  if (sheet.weight.size() == 1) {
    sheet.weight.resize(3, sheet.weight.front());
    for (std::size_t c = 0; c < 3; ++c)
      for (float& weight : sheet.weight[c]) weight *= static_cast<float>(sheet.gain[c]);
    sheet.gain = {1.0, 1.0, 1.0};
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const auto times = static_cast<float>(gain[c]);
    for (std::size_t node = 0; node < sheet.count(); ++node) sheet.weight[c][node] += times * transmission[node];
  }
}

RaySheet mirrored(const RaySheet& sheet) {
  RaySheet out = sheet;
  out.box = mirrored(sheet.box);
  const auto turn = [&](std::vector<float>& values, float sign) {
    for (std::size_t at = 0; at < values.size(); at += out.count()) turn_over(values.data() + at, out.nodes, sign);
  };
  turn(out.sensor_x_mm, 1.0F);
  turn(out.sensor_y_mm, -1.0F);
  turn(out.transmission, 1.0F);
  for (auto& weight : out.weight) turn(weight, 1.0F);
  turn(out.r_rel, 1.0F);
  for (auto& s : out.stop) {
    turn(s[0], 1.0F);
    turn(s[1], -1.0F);
  }
  turn(out.rim_squared, 1.0F);
  return out;
}

bool may_transmit(const RaySheet& sheet, const CellCorners& corners) {
  std::array<Extremes, 1 + kMaxStopCrossings> extremes;
  bool any = false;
  for (const std::size_t k : corners) {
    if (!sheet.arrives(k)) continue;
    any = true;
    extremes[0].add(sheet.r_rel[k] - 1.0F);
    for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
      const float x = sheet.stop[c][0][k], y = sheet.stop[c][1][k];
      extremes[1 + c].add(std::sqrt(x * x + y * y) - 1.0F);
    }
  }
  return any && std::all_of(extremes.begin(), extremes.begin() + 1 + static_cast<std::ptrdiff_t>(sheet.stop.size()),
                            [](const Extremes& e) { return e.may_transmit(1.0F); });
}

std::optional<Rectangle> bounds_of_cells(const RaySheet& sheet, const std::function<bool(const CellCorners&)>& counts) {
  const auto n = static_cast<std::size_t>(sheet.nodes);
  const auto& points = lobatto_points(sheet.nodes);
  const Vec2 half = (sheet.box.high - sheet.box.low) * 0.5;
  const auto place_of = [&](std::size_t column, std::size_t row) {
    return sheet.box.low + Vec2{half.x * (1.0 + points[column]), half.y * (1.0 + points[row])};
  };
  std::optional<Rectangle> all;
  for (std::size_t row = 0; row + 1 < n; ++row) {
    for (std::size_t column = 0; column + 1 < n; ++column) {
      const std::size_t first = row * n + column;
      if (!counts({first, first + 1, first + n, first + n + 1})) continue;
      const Rectangle cell{place_of(column, row), place_of(column + 1, row + 1)};
      all = all ? both(*all, cell) : cell;
    }
  }
  return all;
}

std::vector<std::size_t> rims_in_play(std::span<const RaySheet> sheets) {
  std::vector<std::pair<float, std::size_t>> found;
  const std::size_t count = sheets.front().count();
  for (std::size_t at = 0; at < sheets.front().rim_squared.size(); at += count) {
    float highest = 0.0F;
    for (const RaySheet& sheet : sheets) {
      const float* rim = sheet.rim_squared.data() + at;
      float high = highest_of(rim, count);
      if (sheet.blocks_at(at / count)) high += high - *std::min_element(rim, rim + count);
      highest = std::max(highest, high);
    }
    if (highest > kNearRim) found.emplace_back(-highest, at / count);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> steps;
  for (const auto& [height, step] : found) steps.push_back(step);
  return steps;
}

SheetTracer::SheetTracer(PacketPath path, const LightFrame& light)
    : light_(light), path_(std::move(path)),
      is_obscured_(std::ranges::any_of(path_.steps(), &PacketStep::blocks_within)) {}

RaySheet SheetTracer::trace(const Rectangle& box, int nodes, PacketPrecision precision) {
  RaySheet sheet;
  sheet.box = box;
  sheet.nodes = nodes;
  const std::size_t count = sheet.count();
  for (auto* v : {&sheet.sensor_x_mm, &sheet.sensor_y_mm, &sheet.r_rel, &sheet.transmission}) v->resize(count);
  sheet.stop.resize(static_cast<std::size_t>(path_.stop_crossings()));
  for (auto& s : sheet.stop) {
    s[0].resize(count);
    s[1].resize(count);
  }
  sheet.rim_squared.resize(steps() * count);

  const int first_row = first_traced_row(box, nodes);
  const auto at = static_cast<std::size_t>(first_row) * static_cast<std::size_t>(nodes);
  TracedArrays out{sheet.sensor_x_mm.data() + at,
                   sheet.sensor_y_mm.data() + at,
                   sheet.transmission.data() + at,
                   sheet.r_rel.data() + at,
                   {},
                   {},
                   sheet.rim_squared.data() + at,
                   count};
  for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
    out.stop_x[c] = sheet.stop[c][0].data() + at;
    out.stop_y[c] = sheet.stop[c][1].data() + at;
  }
  trace_rows(box, nodes, first_row, precision, out);
  if (first_row > 0) {
    complete(sheet.sensor_x_mm.data(), nodes, 1.0F);
    complete(sheet.sensor_y_mm.data(), nodes, -1.0F);
    complete(sheet.transmission.data(), nodes, 1.0F);
    complete(sheet.r_rel.data(), nodes, 1.0F);
    for (auto& s : sheet.stop) {
      complete(s[0].data(), nodes, 1.0F);
      complete(s[1].data(), nodes, -1.0F);
    }
    for (std::size_t step = 0; step < steps(); ++step) complete(sheet.rim_squared.data() + step * count, nodes, 1.0F);
  }
  if (is_obscured_) leave_obscurations_out(sheet);
  sheet.failed = static_cast<int>(std::count(sheet.r_rel.begin(), sheet.r_rel.end(), kFailed));
  return sheet;
}

// Removes obscurations from the relative heights, which searches assume to be those of convex openings.
void SheetTracer::leave_obscurations_out(RaySheet& sheet) const {
  const std::vector<PacketStep>& steps = path_.steps();
  for (const PacketStep& step : steps) sheet.blocks_within.push_back(step.blocks_within);
  for (std::size_t node = 0; node < sheet.count(); ++node) {
    if (sheet.r_rel[node] == kFailed) continue;
    float squared = 0.0F;
    for (std::size_t k = 0; k < steps.size(); ++k)
      if (!steps[k].blocks_within) squared = std::max(squared, sheet.rim_squared[k * sheet.count() + node]);
    sheet.r_rel[node] = std::sqrt(squared);
  }
}

std::vector<float> SheetTracer::transmissions(const Rectangle& box, int nodes, PacketPrecision precision) {
  const auto count = static_cast<std::size_t>(nodes) * static_cast<std::size_t>(nodes);
  std::vector<float> transmission(count);
  scratch_.resize((3 + 2 * kMaxStopCrossings) * count);
  const auto discarded = [&](std::size_t f) { return scratch_.data() + f * count; };
  const int first_row = first_traced_row(box, nodes);
  TracedArrays out{discarded(0),
                   discarded(1),
                   transmission.data() + static_cast<std::size_t>(first_row) * static_cast<std::size_t>(nodes),
                   discarded(2),
                   {},
                   {},
                   nullptr,
                   0};
  for (std::size_t c = 0; c < static_cast<std::size_t>(path_.stop_crossings()); ++c) {
    out.stop_x[c] = discarded(3 + 2 * c);
    out.stop_y[c] = discarded(4 + 2 * c);
  }
  trace_rows(box, nodes, first_row, precision, out);
  if (first_row > 0) complete(transmission.data(), nodes, 1.0F);
  return transmission;
}

// The first row that is traced: in a box that is its own mirror image the rows below follow by symmetry.
int SheetTracer::first_traced_row(const Rectangle& box, int nodes) const {
  return light_.symmetric && box.low.y == -box.high.y ? nodes / 2 : 0;
}

void SheetTracer::trace_rows(const Rectangle& box, int nodes, int first_row, PacketPrecision precision,
                             TracedArrays out) {
  const auto& points = lobatto_points(nodes);
  const Vec2 half = (box.high - box.low) * 0.5;
  x_mm_.clear();
  y_mm_.clear();
  for (int row = first_row; row < nodes; ++row) {
    const double y = (1.0 + points[static_cast<std::size_t>(row)]) * half.y;
    for (int column = 0; column < nodes; ++column) {
      const double x = (1.0 + points[static_cast<std::size_t>(column)]) * half.x;
      x_mm_.push_back(static_cast<float>(bend_.entrance_x(box.low + Vec2{x, y}) - box.low.x));
      y_mm_.push_back(static_cast<float>(y));
    }
  }
  path_.start_from(box.low);
  trace_packets(path_, precision, x_mm_.data(), y_mm_.data(), x_mm_.size(), out);
  rays_ += x_mm_.size();
  for (std::size_t k = 0; k < x_mm_.size(); ++k)
    out.transmission[k] *= static_cast<float>(bend_.stretch(box.low.y + y_mm_[k]));
}

}  // namespace contrejour::inline internal::ray_maps
