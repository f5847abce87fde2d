// The power spectrum of dirt far from its centre, fringes between shapes averaged out: the sum of every shape's own.
// By Babinet's principle a shape that blocks light sends what an opening of its form would. A scratch is as wide a
// slit: a streak across it, or a fan where it bends; specks are discs, which send light everywhere.
// Units: those of the strokes, wave numbers k in radians per mm. docs/physics/diffraction.md.
#pragma once

#include <span>
#include <vector>

#include "contrejour/dirt.h"

namespace contrejour {

class DirtWaves {
 public:
  explicit DirtWaves(std::span<const DirtStroke> strokes);

  // All that depends on the direction only.
  class Direction {
   public:
    // Sum of |integral over a shape of exp(-i k u.x)|^2, u the direction, each times the square of the amplitude that
    // it takes away, averaged over the window of directions.
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
    std::vector<Line> near_;  // whose fans the direction lies in or beside
    double ends_k2_ = 0, ends_k4_ = 0;  // of all others: of thin lines, and of thick ones
  };

  // Valid as long as this is.
  [[nodiscard]] Direction along(double direction_rad, double window_rad) const;
  // Normals at the ends of the brightest scratches, so many of them; both are the same where one is straight.
  [[nodiscard]] std::vector<double> brightest_end_normals(std::size_t scratches) const;

 private:
  struct Stroke {
    double normal_rad, half_turn_rad, length, width, weight;
  };
  [[nodiscard]] double specks_power(double k) const;

  std::vector<Stroke> scratches_;
  std::vector<double> specks_;  // log2 of their power, at steps of k from kFirst on
};

}  // namespace contrejour
