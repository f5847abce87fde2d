// What of a box of a ghost's pupil gets through, and where it lands: a sheet's rays, or polynomials through them on a
// mesh so fine that edges are straight lines in its cells.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "ghosts/iris_shape.h"
#include "ghosts/pupils/ray_sheet.h"

namespace contrejour::pupils {

struct OpenMesh {
  Rectangle box;
  int nodes = 0;           // of the sheet that it is made of, along each side
  std::vector<double> at;  // where its columns are, and its rows: from -1 to 1 over the box
  bool is_interpolated = false;  // its vertices lie between the nodes; else they are the nodes
  // One value a vertex, rows by rising y.
  std::vector<float> x_mm, y_mm;  // on the sensor, as the lens has it
  std::vector<float> transmission;
  std::vector<float> blocked;  // how far beyond what blocks: open at 0 and below, infinite where a ray fails

  [[nodiscard]] std::size_t side() const { return at.size(); }
  [[nodiscard]] Vec2 landing_mm(std::size_t vertex) const { return {x_mm[vertex], y_mm[vertex]}; }
};

// By polynomials through the sheet's rays, all of which must have arrived. side: 17, 33, 65 or 129.
void interpolate(const RaySheet& sheet, const LightFrame& light, const IrisShape& iris, int side, OpenMesh& out);
// By the rays alone, some of which may have failed.
void connect(const RaySheet& sheet, const LightFrame& light, const IrisShape& iris, OpenMesh& out);

// A cell of a mesh that lets light through: its vertices in turn, and of each of the triangles 0, 1, 2 and 0, 2, 3 the
// share that is open.
struct OpenCell {
  std::array<std::size_t, 4> vertex;
  std::array<double, 2> open;
  double area_mm2 = 0;  // of the entrance plane, open or not
};
[[nodiscard]] std::vector<OpenCell> open_cells(const OpenMesh& mesh);

// What values at the sheet's nodes are multiplied by, so that their sum is the integral over what is open: of the
// polynomial through them, or of straight lines between them. mm^2 of the entrance plane.
[[nodiscard]] std::vector<double> node_weights(const OpenMesh& mesh, const std::vector<OpenCell>& cells);

}  // namespace contrejour::pupils
