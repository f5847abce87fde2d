#include "ghosts/pupils/open_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "ghosts/open_halves.h"
#include "ghosts/pupils/lobatto.h"

namespace contrejour::pupils {
namespace {

constexpr float kFailed = std::numeric_limits<float>::infinity();
constexpr std::array kNodes{5, 9, 17};
constexpr std::array kSides{17, 33, 65, 129};

// From nodes of a side to a mesh's vertices.
struct Fine {
  std::vector<double> at;
  Matrix from_nodes;
};

const Fine& fine(int nodes, int side) {
  static const auto all = [] {
    std::map<std::pair<int, int>, Fine> out;
    for (const int n : kNodes) {
      for (const int m : kSides) {
        Fine f;
        for (int k = 0; k < m; ++k) f.at.push_back(2.0 * k / (m - 1) - 1.0);
        f.from_nodes = interpolation_matrix(n, f.at);
        out.emplace(std::pair{n, m}, std::move(f));
      }
    }
    return out;
  }();
  return all.at({nodes, side});
}

// A field of the sheet on the mesh, rows of which are apart by the matrix's stride.
class Interpolator {
 public:
  Interpolator(int nodes, int side) : fine_(fine(nodes, side)), nodes_(nodes), side_(static_cast<std::size_t>(side)) {
    half_.resize(static_cast<std::size_t>(nodes * fine_.from_nodes.stride));
    whole_.resize(side_ * static_cast<std::size_t>(fine_.from_nodes.stride));
  }

  void operator()(const float* field, std::vector<float>& out) {
    const Matrix& m = fine_.from_nodes;
    multiply(field, nodes_, nodes_, nodes_, m, half_.data());
    multiply_transposed(m, half_.data(), m.stride, whole_.data());
    out.resize(side_ * side_);
    for (std::size_t row = 0; row < side_; ++row)
      std::copy_n(whole_.data() + row * static_cast<std::size_t>(m.stride), side_, out.data() + row * side_);
  }

 private:
  const Fine& fine_;
  int nodes_;
  std::size_t side_;
  std::vector<float> half_, whole_;
};

// Both coordinates from the meridional frame into place.
void turn(const LightFrame& light, std::vector<float>& x, std::vector<float>& y) {
  const auto c = static_cast<float>(light.cos_turn), s = static_cast<float>(light.sin_turn);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const float along = x[k], across = y[k];
    x[k] = along * c - across * s;
    y[k] = along * s + across * c;
  }
}

void block_more(const std::vector<float>& by, std::vector<float>& blocked) {
  for (std::size_t k = 0; k < blocked.size(); ++k) blocked[k] = by[k] > blocked[k] ? by[k] : blocked[k];
}

// take(field of the sheet, values on the mesh).
template <class Take>
void fill(const RaySheet& sheet, const LightFrame& light, const IrisShape& iris, Take take, OpenMesh& out) {
  out.box = sheet.box;
  out.nodes = sheet.nodes;
  take(sheet.sensor_x_mm.data(), out.x_mm);
  take(sheet.sensor_y_mm.data(), out.y_mm);
  turn(light, out.x_mm, out.y_mm);
  take(sheet.transmission.data(), out.transmission);
  out.blocked.assign(out.x_mm.size(), -1.0F);
  std::vector<float> x, y, distance;
  for (const std::size_t step : rims_in_play({&sheet, 1})) {
    take(sheet.rim_squared.data() + step * sheet.count(), x);
    for (float& squared : x) squared = std::sqrt(std::max(squared, 0.0F)) - 1.0F;
    block_more(x, out.blocked);
  }
  distance.resize(out.x_mm.size());
  for (const auto& crossing : sheet.stop) {
    take(crossing[0].data(), x);
    take(crossing[1].data(), y);
    turn(light, x, y);
    iris.distances(x.data(), y.data(), x.size(), distance.data());
    block_more(distance, out.blocked);
  }
}

}  // namespace

void interpolate(const RaySheet& sheet, const LightFrame& light, const IrisShape& iris, int side, OpenMesh& out) {
  out.at = fine(sheet.nodes, side).at;
  out.is_interpolated = true;
  fill(sheet, light, iris, Interpolator(sheet.nodes, side), out);
}

void connect(const RaySheet& sheet, const LightFrame& light, const IrisShape& iris, OpenMesh& out) {
  out.at = lobatto_points(sheet.nodes);
  out.is_interpolated = false;
  fill(
      sheet, light, iris, [&](const float* field, std::vector<float>& to) { to.assign(field, field + sheet.count()); },
      out);
  for (std::size_t k = 0; k < sheet.count(); ++k)
    if (std::isinf(sheet.r_rel[k])) out.blocked[k] = kFailed;
}

std::vector<OpenCell> open_cells(const OpenMesh& mesh) {
  const std::size_t side = mesh.side();
  const Vec2 size = mesh.box.high - mesh.box.low;
  std::vector<OpenCell> cells;
  for (std::size_t row = 0; row + 1 < side; ++row) {
    const double height = 0.25 * size.x * size.y * (mesh.at[row + 1] - mesh.at[row]);
    for (std::size_t column = 0; column + 1 < side; ++column) {
      const std::size_t k = row * side + column;
      const std::array<std::size_t, 4> v{k, k + 1, k + side + 1, k + side};
      const float a = mesh.blocked[v[0]], b = mesh.blocked[v[1]], c = mesh.blocked[v[2]], d = mesh.blocked[v[3]];
      if (std::min(std::min(a, b), std::min(c, d)) > 0.0F) continue;
      const auto open = [](float p, float q, float r) {
        return std::max(p, std::max(q, r)) < kFailed ? share_below_zero(p, q, r) : 0.0;
      };
      OpenCell cell{v, {1.0, 1.0}, height * (mesh.at[column + 1] - mesh.at[column])};
      if (std::max(std::max(a, b), std::max(c, d)) > 0.0F) cell.open = {open(a, b, c), open(a, c, d)};
      if (cell.open[0] + cell.open[1] > 0.0) cells.push_back(cell);
    }
  }
  return cells;
}

std::vector<double> node_weights(const OpenMesh& mesh, const std::vector<OpenCell>& cells) {
  std::vector<double> at_vertex(mesh.x_mm.size(), 0.0);
  for (const OpenCell& cell : cells) {
    const double first = cell.area_mm2 * cell.open[0] / 6.0, second = cell.area_mm2 * cell.open[1] / 6.0;
    at_vertex[cell.vertex[0]] += first + second;
    at_vertex[cell.vertex[1]] += first;
    at_vertex[cell.vertex[2]] += first + second;
    at_vertex[cell.vertex[3]] += second;
  }
  if (!mesh.is_interpolated) return at_vertex;
  // The transpose of the interpolation, along x and then along y.
  const Matrix& m = fine(mesh.nodes, static_cast<int>(mesh.side())).from_nodes;
  const std::size_t side = mesh.side();
  const auto nodes = static_cast<std::size_t>(mesh.nodes);
  std::vector<double> rows(side * nodes, 0.0), out(nodes * nodes, 0.0);
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t node = 0; node < nodes; ++node)
      for (std::size_t k = 0; k < side; ++k)
        rows[row * nodes + node] += m.row(static_cast<int>(node))[k] * at_vertex[row * side + k];
  for (std::size_t node = 0; node < nodes; ++node)
    for (std::size_t row = 0; row < side; ++row)
      for (std::size_t k = 0; k < nodes; ++k)
        out[node * nodes + k] += m.row(static_cast<int>(node))[row] * rows[row * nodes + k];
  return out;
}

}  // namespace contrejour::pupils
