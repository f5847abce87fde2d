// SPDX-License-Identifier: Apache-2.0
// The power spectrum of dirt far from its centre, with fringes between shapes averaged out: the sum over shapes. By
// Babinet's principle a shape that blocks light diffracts as an opening of its form would. A scratch acts as a slit of
// its width and gives a streak across it, or a fan if it is curved; specks are discs, which diffract in all directions.
// Units: those of the strokes, wave numbers k in radians per mm. docs/physics/diffraction.md.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/dirt.h"

namespace contrejour::inline internal {

class DirtWaves {
 public:
  explicit DirtWaves(std::span<const DirtStroke> strokes);

  // Everything that depends on the direction alone.
  class Direction {
   public:
    // Sum of |integral over a shape of exp(-i k u.x)|^2, u the direction, each times the square of the amplitude that
    // it blocks, averaged over the window of directions.
    [[nodiscard]] double power(double k) const;

   private:
    friend class DirtWaves;
    struct Line {
      double length = 0, radius = 0;  // radius: infinite when straight
      double width = 0, weight = 0;
      double sine = 0, cosine = 0;  // of the direction's angle from the normal at the line's middle
      struct End {
        double sine = 0, cosine = 0;  // of half that angle from the normal at an end
      };
      End first, last;
    };
    [[nodiscard]] double line_power(const Line& line, double k) const;

    const DirtWaves* waves_ = nullptr;
    double window_rad_ = 0;
    std::vector<Line> near_;  // with the direction in their fan or next to it
    double ends_k2_ = 0, ends_k4_ = 0;  // of all other lines: thin ones, and thick ones
  };

  // Valid as long as this is.
  [[nodiscard]] Direction along(double direction_rad, double window_rad) const;
  // Normals at the ends of the brightest scratches, up to `scratches` of them; both are equal for a straight one.
  [[nodiscard]] std::vector<double> brightest_end_normals(std::size_t scratches) const;

 private:
  struct Stroke {
    double normal_rad, half_bend_rad, length, width, weight;
  };
  [[nodiscard]] double specks_power(double k) const;

  std::vector<Stroke> scratches_;
  std::vector<double> specks_;  // log2 of their power, at steps of k from kFirst on
};

}  // namespace contrejour::inline internal
