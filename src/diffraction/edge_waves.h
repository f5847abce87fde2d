// The power spectrum of an opening far from its centre, fringes averaged out: what its edges and corners send there.
// An edge sends light along its normal, falling as k^-2 when straight and as k^-3 over the fan of its normals when
// curved; corners send light everywhere, falling as k^-4. Derivation and domain: docs/physics/diffraction.md.
// Source: Green's theorem as in Komrska 1982 eq. 7 for polygons; the method of stationary phase (Born & Wolf app. III)
// for arcs, made uniform by Fresnel integrals.
#pragma once

#include <optional>
#include <vector>

#include "contrejour/iris.h"

namespace contrejour {

class EdgeWaves {
 public:
  explicit EdgeWaves(const IrisOpening& opening);

  // All that depends on the direction only.
  class Direction {
   public:
    // |integral over the opening of exp(-i k u.x)|^2, u the direction, averaged over fringes and over the window of
    // directions. Lengths in stop radii. k much larger than 1.
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
    // What two edges' waves from their common corner add to the sum of both powers, and how far that is to be used in
    // place of the cotangents' product.
    struct Joined {
      double power = 0.0, share = 0.0;
    };
    [[nodiscard]] static Joined joined_arcs(const Edge& before, const Edge& after, double k, double window_rad);

    double window_rad_ = 0;
    std::vector<Edge> edges_;
    double far_from_ = 0, constant_ = 0, slope_ = 0;  // of all edges and corners together
  };

  [[nodiscard]] Direction along(double direction_rad, double window_rad) const;
  // Normals at the edges' ends, where what they send begins and ends; of a straight one both are the same.
  [[nodiscard]] std::vector<double> end_normals() const;

 private:
  struct Outline {
    double radius, length;  // radius 0: straight
    double normal_middle_rad, half_span_rad;
    bool full_circle;
  };
  std::vector<Outline> outline_;
};

}  // namespace contrejour
