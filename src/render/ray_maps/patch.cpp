// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/patch.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "render/ray_maps/lobatto.h"

namespace contrejour::inline internal::ray_maps {
namespace {

// The interpolation matrices for one number of nodes.
struct NodeMatrices {
  std::array<Matrix, 2> half;  // to the nodes of the low and the high half

  explicit NodeMatrices(int nodes) {
    for (std::size_t side = 0; side < 2; ++side) {
      auto points = lobatto_points(nodes);
      for (double& p : points) p = 0.5 * (p + (side == 0 ? -1.0 : 1.0));
      half[side] = interpolation_matrix(nodes, points);
    }
  }
};

const NodeMatrices& matrices(int nodes) {
  static const std::map<int, NodeMatrices> all{
      {2, NodeMatrices(2)}, {5, NodeMatrices(5)}, {9, NodeMatrices(9)}, {17, NodeMatrices(17)}};
  return all.at(nodes);
}

// Copies the heights at the rims of `steps` to fields of their own. Rims beyond kMaxRims share the last field.
void copy_rims(const LobattoRays& ray_set, const std::vector<std::size_t>& steps, Patch& patch) {
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const float* rim = ray_set.rim_squared.data() + steps[k] * ray_set.count();
    const int to_rim = std::min(static_cast<int>(k), kMaxRims - 1);
    float* to = patch.field(patch.layout.rim(to_rim));
    if (ray_set.blocks_at(steps[k])) patch.layout.obscurations |= 1U << to_rim;
    const bool shared = k >= static_cast<std::size_t>(kMaxRims);
    for (std::size_t node = 0; node < patch.size(); ++node)
      to[node] = shared ? std::max(to[node], rim[node]) : rim[node];
  }
}

// Returns whether no light gets through between four rays: all of them are beyond one rim, or on one side of the stop
// beyond its circle. Values between the rays are means of theirs.
bool is_closed(const LobattoRays& ray_set, const std::array<std::size_t, 4>& corners) {
  const auto all = [&](auto beyond) { return std::all_of(corners.begin(), corners.end(), beyond); };
  for (std::size_t at = 0; at < ray_set.rim_squared.size(); at += ray_set.count()) {
    if (all([&](std::size_t k) { return ray_set.rim_squared[at + k] > 1.0F; })) return true;
  }
  for (const auto& crossing : ray_set.stop) {
    for (const auto& coordinate : crossing) {
      if (all([&](std::size_t k) { return coordinate[k] > 1.0F; })) return true;
      if (all([&](std::size_t k) { return coordinate[k] < -1.0F; })) return true;
    }
  }
  return false;
}

// The largest size of a field at the nodes that count, or at all if none does.
double largest_size(const Patch& patch, int of_field) {
  const float* const field = patch.field(of_field);
  float largest = 0.0F;
  for (std::size_t k = 0; k < patch.counts.size(); ++k)
    if (patch.counts[k]) largest = std::max(largest, std::abs(field[k]));
  if (largest > 0.0F) return largest;
  for (std::size_t k = 0; k < patch.size(); ++k) largest = std::max(largest, std::abs(field[k]));
  return largest;
}

Vec2 on_frame(const LobattoRays& ray_set, std::size_t node, const LightFrame& light, const Frame& frame) {
  return frame.pixel_from_sensor(light.to_lens_frame({ray_set.sensor_x_mm[node], ray_set.sensor_y_mm[node]}));
}

// A corner of a pixel near the middle of the ray set's image.
Vec2 origin_of(const LobattoRays& ray_set, const LightFrame& light, const Frame& frame) {
  const Vec2 middle = on_frame(ray_set, ray_set.count() / 2, light, frame);
  return {std::floor(middle.x), std::floor(middle.y)};
}

// steps: path steps whose rims become fields.
Patch make_patch(const LobattoRays& ray_set, const std::vector<std::size_t>& steps, Vec2 origin_px,
                 const LightFrame& light, const Frame& frame) {
  Patch patch;
  patch.nodes = ray_set.nodes;
  patch.box = ray_set.box;
  patch.layout = {static_cast<int>(ray_set.stop.size()), std::min(static_cast<int>(steps.size()), kMaxRims),
                  static_cast<int>(ray_set.weight.size())};
  patch.gain = ray_set.gain;
  patch.values.resize(static_cast<std::size_t>(patch.layout.fields()) * ray_set.count());
  const Vec2 size = ray_set.box.high - ray_set.box.low;
  patch.flux_area_mm2 = size.x * size.y * light.source.shared_flux();
  patch.origin_px = origin_px;
  if (std::isfinite(ray_set.reach))
    for (std::size_t k = 0; k < ray_set.count(); ++k) patch.counts.push_back(ray_set.counts(k));
  for (std::size_t k = 0; k < ray_set.count(); ++k) {
    const Vec2 p = on_frame(ray_set, k, light, frame) - origin_px;
    patch.field(PatchLayout::kX)[k] = static_cast<float>(p.x);
    patch.field(PatchLayout::kY)[k] = static_cast<float>(p.y);
    for (std::size_t c = 0; c < ray_set.stop.size(); ++c) {
      const Vec2 s = light.to_lens_frame({ray_set.stop[c][0][k], ray_set.stop[c][1][k]});
      patch.field(PatchLayout::kStop + 2 * static_cast<int>(c))[k] = static_cast<float>(s.x);
      patch.field(PatchLayout::kStop + 2 * static_cast<int>(c) + 1)[k] = static_cast<float>(s.y);
    }
  }
  for (int k = 0; k < patch.layout.weights; ++k)
    std::ranges::copy(ray_set.weight[static_cast<std::size_t>(k)], patch.field(patch.layout.weight(k)));
  copy_rims(ray_set, steps, patch);
  return patch;
}

}  // namespace

Patch make_patch(const LobattoRays& ray_set, const LightFrame& light, const Frame& frame) {
  return make_patch(ray_set, rims_in_play({&ray_set, 1}), origin_of(ray_set, light, frame), light, frame);
}

std::vector<Patch> make_patches(std::span<const LobattoRays> ray_sets, const LightFrame& light, const Frame& frame) {
  const auto steps = rims_in_play(ray_sets);
  const Vec2 origin_px = origin_of(ray_sets.front(), light, frame);
  std::vector<Patch> patches;
  for (const LobattoRays& ray_set : ray_sets) patches.push_back(make_patch(ray_set, steps, origin_px, light, frame));
  return patches;
}

void blend(std::span<const Patch> patches, const PatchBlend& factors, Patch& out) {
  const Patch& first = patches.front();
  out.layout = first.layout;
  out.layout.weights = static_cast<int>(factors.weight.size());
  out.nodes = first.nodes;
  out.box = first.box;
  out.origin_px = first.origin_px;
  out.counts = first.counts;
  out.flux_area_mm2 = first.flux_area_mm2;
  out.gain = factors.gain;
  out.values.assign(static_cast<std::size_t>(out.layout.fields()) * first.size(), 0.0F);
  const auto add = [&](const float* from, double factor, int field, int count) {
    const auto times = static_cast<float>(factor);
    float* to = out.field(field);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count) * out.size(); ++k) to[k] += times * from[k];
  };
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const float* weight = patches[k].field(first.layout.weight(0));
    add(patches[k].field(0), factors.geometry[k], 0, first.layout.limits_end());
    for (int w = 0; w < out.layout.weights; ++w)
      add(weight, factors.weight[static_cast<std::size_t>(w)][k], out.layout.weight(w), 1);
  }
}

std::vector<Patch> patches_of_cells(const LobattoRays& ray_set, const LightFrame& light, const Frame& frame) {
  const auto& points = lobatto_points(ray_set.nodes);
  const Vec2 half = (ray_set.box.high - ray_set.box.low) * 0.5;
  const auto n = static_cast<std::size_t>(ray_set.nodes);
  std::vector<Patch> patches;
  for (std::size_t iy = 0; iy + 1 < n; ++iy) {
    for (std::size_t ix = 0; ix + 1 < n; ++ix) {
      const std::array<std::size_t, 4> corners{iy * n + ix, iy * n + ix + 1, (iy + 1) * n + ix, (iy + 1) * n + ix + 1};
      if (std::any_of(corners.begin(), corners.end(),
                      [&](std::size_t k) { return std::isinf(ray_set.relative_height[k]); }))
        continue;
      if (is_closed(ray_set, corners)) continue;
      const auto pick = [&](const std::vector<float>& from, std::vector<float>& to, std::size_t offset = 0) {
        for (const std::size_t k : corners) to.push_back(from[offset + k]);
      };
      LobattoRays cell;
      cell.nodes = 2;
      cell.box = {ray_set.box.low + Vec2{half.x * (1.0 + points[ix]), half.y * (1.0 + points[iy])},
                  ray_set.box.low + Vec2{half.x * (1.0 + points[ix + 1]), half.y * (1.0 + points[iy + 1])}};
      pick(ray_set.sensor_x_mm, cell.sensor_x_mm);
      pick(ray_set.sensor_y_mm, cell.sensor_y_mm);
      pick(ray_set.relative_height, cell.relative_height);
      cell.gain = ray_set.gain;
      cell.weight.resize(ray_set.weight.size());
      for (std::size_t k = 0; k < ray_set.weight.size(); ++k) pick(ray_set.weight[k], cell.weight[k]);
      cell.stop.resize(ray_set.stop.size());
      for (std::size_t c = 0; c < ray_set.stop.size(); ++c) {
        for (std::size_t axis = 0; axis < 2; ++axis) pick(ray_set.stop[c][axis], cell.stop[c][axis]);
      }
      for (std::size_t at = 0; at < ray_set.rim_squared.size(); at += ray_set.count())
        pick(ray_set.rim_squared, cell.rim_squared, at);
      cell.blocks_within = ray_set.blocks_within;
      patches.push_back(make_patch(cell, light, frame));
    }
  }
  return patches;
}

PatchError estimated_error(const Patch& patch) {
  PatchError error;
  const PatchLayout& layout = patch.layout;
  error.position_px = std::max(highest_terms(patch.field(PatchLayout::kX), patch.nodes),
                               highest_terms(patch.field(PatchLayout::kY), patch.nodes));
  for (int k = 0; k < 2 * layout.crossings; ++k)
    error.stop = std::max(error.stop, highest_terms(patch.field(PatchLayout::kStop + k), patch.nodes));
  for (int k = 0; k < layout.rims; ++k)
    error.rim = std::max(error.rim, highest_terms(patch.field(layout.rim(k)), patch.nodes));
  double largest = 0.0;
  for (int k = 0; k < layout.weights; ++k) {
    largest = std::max(largest, largest_size(patch, layout.weight(k)));
    error.weight = std::max(error.weight, highest_terms(patch.field(layout.weight(k)), patch.nodes));
  }
  if (largest > 0.0) error.weight /= largest;
  return error;
}

Patch quarter(const Patch& patch, int ix, int iy) {
  const NodeMatrices& m = matrices(patch.nodes);
  Patch out = patch;
  const Vec2 half = (patch.box.high - patch.box.low) * 0.5;
  out.box.low = patch.box.low + Vec2{half.x * ix, half.y * iy};
  out.box.high = out.box.low + half;
  out.flux_area_mm2 = 0.25 * patch.flux_area_mm2;
  out.counts.clear();
  for (int f = 0; f < patch.layout.fields(); ++f) {
    transform(patch.field(f), patch.nodes, m.half[static_cast<std::size_t>(ix)], m.half[static_cast<std::size_t>(iy)],
              out.field(f));
  }
  return out;
}

}  // namespace contrejour::inline internal::ray_maps
