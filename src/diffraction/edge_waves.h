// SPDX-License-Identifier: Apache-2.0
// The power spectrum of an opening far from its centre, with fringes averaged out: the diffraction by its edges and
// corners. An edge diffracts along its normal, with a power that falls as k^-2 if it is straight, and as k^-3 over the
// fan of its normals if it is curved; corners diffract in all directions, with a power that falls as k^-4. Derivation
// and domain: docs/physics/diffraction.md.
// Source: Green's theorem as in Komrska 1982 eq. 7 for polygons; the method of stationary phase (Born & Wolf app. III)
// for arcs, made uniform by Fresnel integrals.
#pragma once

#include <optional>
#include <vector>

#include "contrejour/expert/iris.h"

namespace contrejour::inline internal {

class EdgeWaves {
 public:
  explicit EdgeWaves(const IrisOpening& opening);

  // Everything that depends on the direction alone.
  class Direction {
   public:
    // |integral over the opening of exp(-i k u.x)|^2, u the direction, averaged over fringes and over the window of
    // directions. Lengths are in stop radii. Valid for k much larger than 1.
    [[nodiscard]] double power(double k) const;

   private:
    friend class EdgeWaves;
    struct Edge {
      double radius = 0;  // 0: straight
      double length = 0;
      double tau_start = 0, tau_end = 0;  // its ends' normals, from the direction; straight: the same
      double cot_start = 0, cot_end = 0;  // u.n / u.t at the ends
      bool full_circle = false;
      double far_from = 0;  // k from which on its power is constant + slope k
      double constant = 0, slope = 0;
    };
    void add(Edge edge);
    [[nodiscard]] static double straight_power(const Edge& edge, double k, double window_rad);
    [[nodiscard]] static double arc_power(const Edge& edge, double k, double window_rad);
    [[nodiscard]] static double edge_power(const Edge& edge, double k, double window_rad);
    static void find_far(Edge& edge, double window_rad);
    [[nodiscard]] double corner_terms() const;
    // The cross term of two edges' waves at their common corner, and the weight with which it replaces the cotangents'
    // product.
    struct Joined {
      double power = 0.0, weight = 0.0;
    };
    [[nodiscard]] static Joined joined_arcs(const Edge& before, const Edge& after, double k, double window_rad);

    double window_rad_ = 0;
    std::vector<Edge> edges_;
    double far_from_ = 0, constant_ = 0, slope_ = 0;  // of all edges and corners together
  };

  [[nodiscard]] Direction along(double direction_rad, double window_rad) const;
  // Normals at the edges' ends, which limit their fans; both are equal for a straight edge.
  [[nodiscard]] std::vector<double> end_normals() const;

 private:
  struct Outline {
    double radius, length;  // radius 0: straight
    double normal_middle_rad, half_span_rad;
    bool full_circle;
  };
  std::vector<Outline> outline_;
};

}  // namespace contrejour::inline internal
