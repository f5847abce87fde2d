// SPDX-License-Identifier: Apache-2.0
// A zone of the field at several states of a lens, the nodes of a range of zoom or focus: its pupil coordinates at all
// of them, and the zone at a state between them. docs/physics/polynomial.md, "Zoom and focus".
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "contrejour/expert/polynomial.h"

namespace contrejour::inline internal::polynomial {

// The coordinates in [-1, 1] of a range's nodes (Chebyshev-Lobatto, falling from 1), and each node's weight for a
// coordinate (Lagrange, by the barycentric formula: Berrut and Trefethen 2004, eq. 4.2).
[[nodiscard]] double node_coordinate(int node, int count);
[[nodiscard]] std::vector<double> node_weights(int count, double coordinate);

// Chooses the shear that moves the pupil's middle to the origin, and the radius, from the zone's bounds, of which one
// at least must have light.
void set_pupil_coordinates(PolynomialZone& zone);
// The bounds of light at a zone's fields, at a state between nodes.
struct BoundsBetween {
  std::vector<double> weights;
  std::vector<PolynomialBounds> bounds;
};
// For zones of the nodes of a range, with bounds and coordinates of their own: coordinates that change smoothly with
// the nodes' coordinate, and in these the same bounds at all nodes, which contain the light of each and of the states
// between them.
void align_pupils(std::span<PolynomialZone> zones, std::span<const BoundsBetween> between);

// A polynomial between nodes. All have the same degree.
[[nodiscard]] ChebyshevSum interpolated(std::span<const ChebyshevSum> nodes, std::span<const double> weights);
[[nodiscard]] ChebyshevVector interpolated(std::span<const ChebyshevVector> nodes, std::span<const double> weights);

// The zone between nodes: its field, pupil coordinates, bounds and flux alone, or with its polynomials.
[[nodiscard]] PolynomialZone zone_frame(std::span<const PolynomialZone> nodes, std::span<const double> weights);
[[nodiscard]] PolynomialZone zone_between(std::span<const PolynomialZone> nodes, std::span<const double> weights);

}  // namespace contrejour::inline internal::polynomial
