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

// Copies the heights at the rims of `steps` to fields of their own. Rims beyond kMostRims share the last field.
void copy_rims(const RaySheet& sheet, const std::vector<std::size_t>& steps, Patch& patch) {
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const float* rim = sheet.rim_squared.data() + steps[k] * sheet.count();
    const int to_rim = std::min(static_cast<int>(k), kMostRims - 1);
    float* to = patch.field(patch.layout.rim(to_rim));
    if (sheet.blocks_at(steps[k])) patch.layout.obscurations |= 1U << to_rim;
    const bool shared = k >= static_cast<std::size_t>(kMostRims);
    for (std::size_t node = 0; node < patch.size(); ++node)
      to[node] = shared ? std::max(to[node], rim[node]) : rim[node];
  }
}

// Whether no light gets through between four rays: all of them are beyond one rim, or on one side of the stop beyond
// its circle. Values between the rays are means of theirs.
bool is_closed(const RaySheet& sheet, const std::array<std::size_t, 4>& corners) {
  const auto all = [&](auto beyond) { return std::all_of(corners.begin(), corners.end(), beyond); };
  for (std::size_t at = 0; at < sheet.rim_squared.size(); at += sheet.count()) {
    if (all([&](std::size_t k) { return sheet.rim_squared[at + k] > 1.0F; })) return true;
  }
  for (const auto& crossing : sheet.stop) {
    for (const auto& coordinate : crossing) {
      if (all([&](std::size_t k) { return coordinate[k] > 1.0F; })) return true;
      if (all([&](std::size_t k) { return coordinate[k] < -1.0F; })) return true;
    }
  }
  return false;
}

double largest_size(const float* field, std::size_t count) {
  float largest = 0.0F;
  for (std::size_t k = 0; k < count; ++k) largest = std::max(largest, std::abs(field[k]));
  return largest;
}

Vec2 on_frame(const RaySheet& sheet, std::size_t node, const LightFrame& light, const Frame& frame) {
  return frame.pixel_from_sensor(light.into_place({sheet.sensor_x_mm[node], sheet.sensor_y_mm[node]}));
}

// A corner of a pixel near the middle of the sheet's image.
Vec2 origin_of(const RaySheet& sheet, const LightFrame& light, const Frame& frame) {
  const Vec2 middle = on_frame(sheet, sheet.count() / 2, light, frame);
  return {std::floor(middle.x), std::floor(middle.y)};
}

// steps: path steps whose rims become fields.
Patch make_patch(const RaySheet& sheet, const std::vector<std::size_t>& steps, Vec2 origin_px, const LightFrame& light,
                 const Frame& frame) {
  Patch patch;
  patch.nodes = sheet.nodes;
  patch.box = sheet.box;
  patch.layout = {static_cast<int>(sheet.stop.size()), std::min(static_cast<int>(steps.size()), kMostRims),
                  static_cast<int>(sheet.weight.size())};
  patch.gain = sheet.gain;
  patch.values.resize(static_cast<std::size_t>(patch.layout.fields()) * sheet.count());
  const Vec2 size = sheet.box.high - sheet.box.low;
  patch.flux_area_mm2 = size.x * size.y * light.source.shared_flux();
  patch.origin_px = origin_px;
  for (std::size_t k = 0; k < sheet.count(); ++k) {
    const Vec2 p = on_frame(sheet, k, light, frame) - origin_px;
    patch.field(PatchLayout::kX)[k] = static_cast<float>(p.x);
    patch.field(PatchLayout::kY)[k] = static_cast<float>(p.y);
    for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
      const Vec2 s = light.into_place({sheet.stop[c][0][k], sheet.stop[c][1][k]});
      patch.field(PatchLayout::kStop + 2 * static_cast<int>(c))[k] = static_cast<float>(s.x);
      patch.field(PatchLayout::kStop + 2 * static_cast<int>(c) + 1)[k] = static_cast<float>(s.y);
    }
  }
  for (int k = 0; k < patch.layout.weights; ++k)
    std::ranges::copy(sheet.weight[static_cast<std::size_t>(k)], patch.field(patch.layout.weight(k)));
  copy_rims(sheet, steps, patch);
  return patch;
}

}  // namespace

Patch make_patch(const RaySheet& sheet, const LightFrame& light, const Frame& frame) {
  return make_patch(sheet, rims_in_play({&sheet, 1}), origin_of(sheet, light, frame), light, frame);
}

std::vector<Patch> make_patches(std::span<const RaySheet> sheets, const LightFrame& light, const Frame& frame) {
  const auto steps = rims_in_play(sheets);
  const Vec2 origin_px = origin_of(sheets.front(), light, frame);
  std::vector<Patch> patches;
  for (const RaySheet& sheet : sheets) patches.push_back(make_patch(sheet, steps, origin_px, light, frame));
  return patches;
}

void blend(std::span<const Patch> patches, const PatchBlend& factors, Patch& out) {
  const Patch& first = patches.front();
  out.layout = first.layout;
  out.layout.weights = static_cast<int>(factors.weight.size());
  out.nodes = first.nodes;
  out.box = first.box;
  out.origin_px = first.origin_px;
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

std::vector<Patch> patches_of_cells(const RaySheet& sheet, const LightFrame& light, const Frame& frame) {
  const auto& points = lobatto_points(sheet.nodes);
  const Vec2 half = (sheet.box.high - sheet.box.low) * 0.5;
  const auto n = static_cast<std::size_t>(sheet.nodes);
  std::vector<Patch> patches;
  for (std::size_t iy = 0; iy + 1 < n; ++iy) {
    for (std::size_t ix = 0; ix + 1 < n; ++ix) {
      const std::array<std::size_t, 4> corners{iy * n + ix, iy * n + ix + 1, (iy + 1) * n + ix, (iy + 1) * n + ix + 1};
      if (std::any_of(corners.begin(), corners.end(), [&](std::size_t k) { return std::isinf(sheet.r_rel[k]); }))
        continue;
      if (is_closed(sheet, corners)) continue;
      const auto pick = [&](const std::vector<float>& from, std::vector<float>& to, std::size_t offset = 0) {
        for (const std::size_t k : corners) to.push_back(from[offset + k]);
      };
      RaySheet cell;
      cell.nodes = 2;
      cell.box = {sheet.box.low + Vec2{half.x * (1.0 + points[ix]), half.y * (1.0 + points[iy])},
                  sheet.box.low + Vec2{half.x * (1.0 + points[ix + 1]), half.y * (1.0 + points[iy + 1])}};
      pick(sheet.sensor_x_mm, cell.sensor_x_mm);
      pick(sheet.sensor_y_mm, cell.sensor_y_mm);
      pick(sheet.r_rel, cell.r_rel);
      cell.gain = sheet.gain;
      cell.weight.resize(sheet.weight.size());
      for (std::size_t k = 0; k < sheet.weight.size(); ++k) pick(sheet.weight[k], cell.weight[k]);
      cell.stop.resize(sheet.stop.size());
      for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
        for (std::size_t axis = 0; axis < 2; ++axis) pick(sheet.stop[c][axis], cell.stop[c][axis]);
      }
      for (std::size_t at = 0; at < sheet.rim_squared.size(); at += sheet.count())
        pick(sheet.rim_squared, cell.rim_squared, at);
      cell.blocks_within = sheet.blocks_within;
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
    const float* field = patch.field(layout.weight(k));
    largest = std::max(largest, largest_size(field, patch.size()));
    error.weight = std::max(error.weight, highest_terms(field, patch.nodes));
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
  for (int f = 0; f < patch.layout.fields(); ++f) {
    transform(patch.field(f), patch.nodes, m.half[static_cast<std::size_t>(ix)], m.half[static_cast<std::size_t>(iy)],
              out.field(f));
  }
  return out;
}

}  // namespace contrejour::inline internal::ray_maps
