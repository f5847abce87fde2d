// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/lobatto_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "render/pupils/open_cells.h"
#include "render/ray_maps/lobatto.h"

namespace contrejour::inline internal::ray_maps {
namespace {

// A rim counts if a ray of the ray set exceeds this squared relative height.
constexpr float kNearRim = 0.94F;

// The largest of at least one value: eight independent maxima, since each comparison waits for the preceding one of its
// maximum.
float highest_of(const float* values, std::size_t count) {
  std::array<float, 8> largest;
  largest.fill(values[0]);
  std::size_t k = 0;
  for (; k + largest.size() <= count; k += largest.size()) {
    for (std::size_t lane = 0; lane < largest.size(); ++lane) largest[lane] = std::max(largest[lane], values[k + lane]);
  }
  for (; k < count; ++k) largest[0] = std::max(largest[0], values[k]);
  return *std::max_element(largest.begin(), largest.end());
}

// Fills the rows below the middle by symmetry from those above it.
void complete(float* values, int nodes, float sign) {
  const auto n = static_cast<std::size_t>(nodes);
  for (std::size_t row = 0; row < n / 2; ++row) {
    for (std::size_t k = 0; k < n; ++k) values[row * n + k] = sign * values[(n - 1 - row) * n + k];
  }
}

// Rows in the opposite order.
void mirror(float* values, int nodes, float sign) {
  const auto n = static_cast<std::size_t>(nodes);
  for (std::size_t row = 0; row < n / 2; ++row)
    std::swap_ranges(values + row * n, values + (row + 1) * n, values + (n - 1 - row) * n);
  if (sign == 1.0F) return;
  for (std::size_t k = 0; k < n * n; ++k) values[k] *= sign;
}

}  // namespace

void add_light(LobattoRays& ray_set, std::span<const float> transmission, const std::array<double, 3>& gain) {
  if (ray_set.weight.empty()) {
    ray_set.weight.emplace_back(transmission.begin(), transmission.end());
    ray_set.gain = gain;
    return;
  }
  if (ray_set.weight.size() == 1) {
    ray_set.weight.resize(3, ray_set.weight.front());
    for (std::size_t c = 0; c < 3; ++c)
      for (float& weight : ray_set.weight[c]) weight *= static_cast<float>(ray_set.gain[c]);
    ray_set.gain = {1.0, 1.0, 1.0};
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const auto times = static_cast<float>(gain[c]);
    for (std::size_t node = 0; node < ray_set.count(); ++node) ray_set.weight[c][node] += times * transmission[node];
  }
}

LobattoRays mirrored(const LobattoRays& ray_set) {
  LobattoRays out = ray_set;
  out.box = mirrored(ray_set.box);
  const auto mirror_all = [&](std::vector<float>& values, float sign) {
    for (std::size_t at = 0; at < values.size(); at += out.count()) mirror(values.data() + at, out.nodes, sign);
  };
  mirror_all(out.sensor_x_mm, 1.0F);
  mirror_all(out.sensor_y_mm, -1.0F);
  mirror_all(out.transmission, 1.0F);
  for (auto& weight : out.weight) mirror_all(weight, 1.0F);
  mirror_all(out.relative_height, 1.0F);
  for (auto& s : out.stop) {
    mirror_all(s[0], 1.0F);
    mirror_all(s[1], -1.0F);
  }
  mirror_all(out.rim_squared, 1.0F);
  return out;
}

bool may_transmit(const LobattoRays& ray_set, const CellCorners& corners) {
  std::array<Extremes, 1 + kMaxStopCrossings> extremes;
  bool any = false;
  for (const std::size_t k : corners) {
    if (!ray_set.arrives(k)) continue;
    any = true;
    extremes[0].add(ray_set.relative_height[k] - 1.0F);
    for (std::size_t c = 0; c < ray_set.stop.size(); ++c) {
      const float x = ray_set.stop[c][0][k], y = ray_set.stop[c][1][k];
      extremes[1 + c].add(std::sqrt(x * x + y * y) - 1.0F);
    }
  }
  return any && std::all_of(extremes.begin(), extremes.begin() + 1 + static_cast<std::ptrdiff_t>(ray_set.stop.size()),
                            [](const Extremes& e) { return e.may_transmit(1.0F); });
}

std::optional<Rectangle> bounds_of_cells(const LobattoRays& ray_set,
                                         const std::function<bool(const CellCorners&)>& counts) {
  const auto n = static_cast<std::size_t>(ray_set.nodes);
  const auto& points = lobatto_points(ray_set.nodes);
  const Vec2 half = (ray_set.box.high - ray_set.box.low) * 0.5;
  const auto position_of = [&](std::size_t column, std::size_t row) {
    return ray_set.box.low + Vec2{half.x * (1.0 + points[column]), half.y * (1.0 + points[row])};
  };
  std::optional<Rectangle> all;
  for (std::size_t row = 0; row + 1 < n; ++row) {
    for (std::size_t column = 0; column + 1 < n; ++column) {
      const std::size_t first = row * n + column;
      if (!counts({first, first + 1, first + n, first + n + 1})) continue;
      const Rectangle cell{position_of(column, row), position_of(column + 1, row + 1)};
      all = all ? both(*all, cell) : cell;
    }
  }
  return all;
}

std::vector<std::size_t> rims_in_play(std::span<const LobattoRays> ray_sets) {
  std::vector<std::pair<float, std::size_t>> found;
  const std::size_t count = ray_sets.front().count();
  for (std::size_t at = 0; at < ray_sets.front().rim_squared.size(); at += count) {
    float highest = 0.0F;
    for (const LobattoRays& ray_set : ray_sets) {
      const float* rim = ray_set.rim_squared.data() + at;
      float high = highest_of(rim, count);
      if (ray_set.blocks_at(at / count)) high += high - *std::min_element(rim, rim + count);
      highest = std::max(highest, high);
    }
    if (highest > kNearRim) found.emplace_back(-highest, at / count);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> steps;
  for (const auto& [height, step] : found) steps.push_back(step);
  return steps;
}

LobattoTracer::LobattoTracer(std::unique_ptr<RaySource> source, const LightFrame& light)
    : light_(light), source_(std::move(source)) {
  for (std::size_t rim = 0; rim < source_->rims(); ++rim) is_obscured_ = is_obscured_ || source_->blocks_within(rim);
}

LobattoRays LobattoTracer::trace(const Rectangle& box, int nodes, PacketPrecision precision) {
  LobattoRays ray_set;
  ray_set.box = box;
  ray_set.nodes = nodes;
  ray_set.reach = source_->reach();
  const std::size_t count = ray_set.count();
  for (auto* v : {&ray_set.sensor_x_mm, &ray_set.sensor_y_mm, &ray_set.relative_height, &ray_set.transmission})
    v->resize(count);
  ray_set.stop.resize(static_cast<std::size_t>(source_->stop_crossings()));
  for (auto& s : ray_set.stop) {
    s[0].resize(count);
    s[1].resize(count);
  }
  ray_set.rim_squared.resize(source_->rims() * count);

  const int first_row = first_traced_row(box, nodes);
  const auto at = static_cast<std::size_t>(first_row) * static_cast<std::size_t>(nodes);
  TracedArrays out{ray_set.sensor_x_mm.data() + at,
                   ray_set.sensor_y_mm.data() + at,
                   ray_set.transmission.data() + at,
                   ray_set.relative_height.data() + at,
                   {},
                   {},
                   ray_set.rim_squared.data() + at,
                   count};
  for (std::size_t c = 0; c < ray_set.stop.size(); ++c) {
    out.stop_x[c] = ray_set.stop[c][0].data() + at;
    out.stop_y[c] = ray_set.stop[c][1].data() + at;
  }
  set_starts(box, nodes, first_row);
  source_->rays(box.low, precision, x_mm_.data(), y_mm_.data(), x_mm_.size(), out);
  weigh(box, out.transmission);
  if (first_row > 0) {
    complete(ray_set.sensor_x_mm.data(), nodes, 1.0F);
    complete(ray_set.sensor_y_mm.data(), nodes, -1.0F);
    complete(ray_set.transmission.data(), nodes, 1.0F);
    complete(ray_set.relative_height.data(), nodes, 1.0F);
    for (auto& s : ray_set.stop) {
      complete(s[0].data(), nodes, 1.0F);
      complete(s[1].data(), nodes, -1.0F);
    }
    for (std::size_t rim = 0; rim < source_->rims(); ++rim)
      complete(ray_set.rim_squared.data() + rim * count, nodes, 1.0F);
  }
  if (is_obscured_) leave_obscurations_out(ray_set);
  ray_set.failed =
      static_cast<int>(std::count(ray_set.relative_height.begin(), ray_set.relative_height.end(), kFailed));
  return ray_set;
}

// Removes obscurations from the relative heights, which searches assume to be those of convex openings.
void LobattoTracer::leave_obscurations_out(LobattoRays& ray_set) const {
  for (std::size_t rim = 0; rim < source_->rims(); ++rim) ray_set.blocks_within.push_back(source_->blocks_within(rim));
  for (std::size_t node = 0; node < ray_set.count(); ++node) {
    if (ray_set.relative_height[node] == kFailed) continue;
    float squared = 0.0F;
    for (std::size_t k = 0; k < source_->rims(); ++k)
      if (!ray_set.blocks_within[k]) squared = std::max(squared, ray_set.rim_squared[k * ray_set.count() + node]);
    ray_set.relative_height[node] = std::sqrt(squared);
  }
}

std::vector<float> LobattoTracer::transmissions(const Rectangle& box, int nodes, PacketPrecision precision) {
  const auto count = static_cast<std::size_t>(nodes) * static_cast<std::size_t>(nodes);
  std::vector<float> transmission(count);
  const int first_row = first_traced_row(box, nodes);
  float* const out = transmission.data() + static_cast<std::size_t>(first_row) * static_cast<std::size_t>(nodes);
  set_starts(box, nodes, first_row);
  source_->transmissions(box.low, precision, x_mm_.data(), y_mm_.data(), x_mm_.size(), out);
  weigh(box, out);
  if (first_row > 0) complete(transmission.data(), nodes, 1.0F);
  return transmission;
}

// The first row that is traced: in a box that is its own mirror image the rows below follow by symmetry.
int LobattoTracer::first_traced_row(const Rectangle& box, int nodes) const {
  return light_.symmetric && box.low.y == -box.high.y ? nodes / 2 : 0;
}

// Sets the starts of the rows from the first traced one on, relative to the box's corner.
void LobattoTracer::set_starts(const Rectangle& box, int nodes, int first_row) {
  const auto& points = lobatto_points(nodes);
  const Vec2 half = (box.high - box.low) * 0.5;
  x_mm_.clear();
  y_mm_.clear();
  for (int row = first_row; row < nodes; ++row) {
    const double y = (1.0 + points[static_cast<std::size_t>(row)]) * half.y;
    for (int column = 0; column < nodes; ++column) {
      const double x = (1.0 + points[static_cast<std::size_t>(column)]) * half.x;
      x_mm_.push_back(static_cast<float>(curve_.entrance_x(box.low + Vec2{x, y}) - box.low.x));
      y_mm_.push_back(static_cast<float>(y));
    }
  }
  rays_ += x_mm_.size();
}

// Multiplies the transmissions of these starts by the area of the entrance plane that a part of the box stands for.
void LobattoTracer::weigh(const Rectangle& box, float* transmission) const {
  for (std::size_t k = 0; k < x_mm_.size(); ++k)
    transmission[k] *= static_cast<float>(curve_.jacobian_x(box.low.y + y_mm_[k]));
}

}  // namespace contrejour::inline internal::ray_maps
