// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/cells/mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "render/adaptive/cells/ray_map_names.h"

namespace contrejour::inline internal::adaptive {
namespace {

// Matrices from a patch's nodes to the vertices: of values, and of their change from vertex to vertex.
struct MeshMatrices {
  Matrix value, change;

  explicit MeshMatrices(int nodes) {
    std::vector<double> points;
    for (int k = 0; k < Mesh::kSide; ++k) points.push_back(2.0 * k / Mesh::kCells - 1.0);
    value = interpolation_matrix(nodes, points);
    change = derivative_matrix(nodes, points);
    for (float& v : change.values) v *= 2.0F / Mesh::kCells;
  }
};

const MeshMatrices& matrices(int nodes) {
  static const std::map<int, MeshMatrices> all{
      {2, MeshMatrices(2)}, {5, MeshMatrices(5)}, {9, MeshMatrices(9)}, {17, MeshMatrices(17)}};
  return all.at(nodes);
}

using HalfField = std::array<float, 17 * Mesh::kStride>;

// Positions at the vertices, and their change along u and v.
struct Positions {
  Mesh::Field value, along_u, along_v;
};

Positions positions(const float* nodes_field, int nodes, const MeshMatrices& m) {
  Positions out;
  HalfField half;
  multiply(nodes_field, nodes, nodes, nodes, m.value, half.data());
  multiply_transposed(m.value, half.data(), Mesh::kStride, out.value.data());
  multiply_transposed(m.change, half.data(), Mesh::kStride, out.along_v.data());
  multiply(nodes_field, nodes, nodes, nodes, m.change, half.data());
  multiply_transposed(m.value, half.data(), Mesh::kStride, out.along_u.data());
  return out;
}

// Half of a cell's longest diagonal in the plane of a crossing: no ray of a cell is farther than that from all of its
// vertices.
float slack_of(const Mesh& mesh, int crossing) {
  const Mesh::Field& x = mesh.field(PatchLayout::kStop + 2 * crossing);
  const Mesh::Field& y = mesh.field(PatchLayout::kStop + 2 * crossing + 1);
  float longest = 0.0F;
  const auto add = [&](std::size_t a, std::size_t b) {
    const float dx = x[a] - x[b];
    const float dy = y[a] - y[b];
    longest = std::max(longest, dx * dx + dy * dy);
  };
  for (int iy = 0; iy < Mesh::kCells; ++iy) {
    for (int ix = 0; ix < Mesh::kCells; ++ix) {
      add(Mesh::at(ix, iy), Mesh::at(ix + 1, iy + 1));
      add(Mesh::at(ix + 1, iy), Mesh::at(ix, iy + 1));
    }
  }
  return 0.5F * std::sqrt(longest);
}

void mark_outside(Mesh& mesh, const IrisShape& iris) {
  mesh.outside.fill(0);
  Mesh::Field distance;
  for (int c = 0; c < mesh.layout.crossings; ++c) {
    iris.distances(mesh.field(PatchLayout::kStop + 2 * c).data(), mesh.field(PatchLayout::kStop + 2 * c + 1).data(),
                   distance.size(), distance.data());
    // A picture may block light between open vertices.
    const float open = iris.is_picture() ? -slack_of(mesh, c) : 0.0F;
    for (std::size_t k = 0; k < distance.size(); ++k) mesh.outside[k] |= (distance[k] > open ? 1U : 0U) << c;
  }
  for (int r = 0; r < mesh.layout.rims; ++r) {
    const Mesh::Field& rim = mesh.field(mesh.layout.rim(r));
    for (std::size_t k = 0; k < rim.size(); ++k)
      mesh.outside[k] |= (rim[k] > 1.0F ? 1U : 0U) << (mesh.layout.crossings + r);
  }
}

// By how much a field that curves may exceed its values at the vertices between them.
float rise_between(const Mesh::Field& v) {
  float along_u = 0.0F, along_v = 0.0F;
  for (int iy = 0; iy < Mesh::kSide; ++iy) {
    for (int ix = 1; ix < Mesh::kCells; ++ix) {
      const auto nonlinearity = [&](std::size_t a, std::size_t b, std::size_t c) {
        return std::abs(v[a] - 2.0F * v[b] + v[c]);
      };
      along_u = std::max(along_u, nonlinearity(Mesh::at(ix - 1, iy), Mesh::at(ix, iy), Mesh::at(ix + 1, iy)));
      along_v = std::max(along_v, nonlinearity(Mesh::at(iy, ix - 1), Mesh::at(iy, ix), Mesh::at(iy, ix + 1)));
    }
  }
  return (along_u + along_v) / 8.0F;
}

void mark_near_obscurations(Mesh& mesh) {
  for (int r = 0; r < mesh.layout.rims; ++r) {
    if (!mesh.layout.is_obscuration(r)) continue;
    const Mesh::Field& rim = mesh.field(mesh.layout.rim(r));
    const float near = 1.0F - rise_between(rim);
    for (std::size_t k = 0; k < rim.size(); ++k) mesh.outside[k] |= rim[k] > near ? Mesh::kNearObscuration : 0U;
  }
}

void find_rms_irradiance(Mesh& mesh) {
  const PatchLayout& layout = mesh.layout;
  const auto set = [&](auto rms_weight) {
    for (std::size_t k = 0; k < mesh.rms_irradiance.size(); ++k)
      mesh.rms_irradiance[k] = rms_weight(k) / (std::abs(mesh.area[k]) + 1e-20F);
  };
  const auto third = static_cast<float>(mesh.cell_flux_area_mm2 * mesh.cell_flux_area_mm2 / 3.0);
  if (layout.weights == 1) {
    const Mesh::Field& weight = mesh.field(layout.weight(0));
    const Rgb& g = mesh.gain;
    const float times = std::sqrt(static_cast<float>(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]) * third);
    set([&](std::size_t k) { return times * std::abs(weight[k]); });
  } else {
    const std::array weight{&mesh.field(layout.weight(0)), &mesh.field(layout.weight(1)),
                            &mesh.field(layout.weight(2))};
    const auto squared = [&](std::size_t c, std::size_t k) { return (*weight[c])[k] * (*weight[c])[k]; };
    set([&](std::size_t k) { return std::sqrt((squared(0, k) + squared(1, k) + squared(2, k)) * third); });
  }
}

}  // namespace

double Mesh::irradiance(int weight, std::size_t vertex) const {
  return field(layout.weight(weight))[vertex] * cell_flux_area_mm2 / (std::abs(area[vertex]) + 1e-20);
}

void make_mesh(const Patch& patch, const IrisShape& iris, Mesh& mesh) {
  const MeshMatrices& m = matrices(patch.nodes);
  mesh.layout = patch.layout;
  mesh.origin_px = patch.origin_px;
  mesh.box = patch.box;
  mesh.gain = patch.gain;
  mesh.cell_flux_area_mm2 = patch.flux_area_mm2 / (Mesh::kCells * Mesh::kCells);
  mesh.fields.resize(static_cast<std::size_t>(patch.layout.fields()));
  const Positions x = positions(patch.field(PatchLayout::kX), patch.nodes, m);
  const Positions y = positions(patch.field(PatchLayout::kY), patch.nodes, m);
  mesh.fields[PatchLayout::kX] = x.value;
  mesh.fields[PatchLayout::kY] = y.value;
  for (std::size_t k = 0; k < mesh.area.size(); ++k) {
    mesh.area[k] = x.along_u[k] * y.along_v[k] - x.along_v[k] * y.along_u[k];
  }
  HalfField half;
  for (int f = PatchLayout::kStop; f < patch.layout.fields(); ++f) {
    multiply(patch.field(f), patch.nodes, patch.nodes, patch.nodes, m.value, half.data());
    multiply_transposed(m.value, half.data(), Mesh::kStride, mesh.fields[static_cast<std::size_t>(f)].data());
  }
  mark_outside(mesh, iris);
  mark_near_obscurations(mesh);
  find_rms_irradiance(mesh);
}

}  // namespace contrejour::inline internal::adaptive
