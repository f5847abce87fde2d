// SPDX-License-Identifier: Apache-2.0
// What the stop transmits of one ghost at one wavelength: the iris, its diffraction, the half-tones of a picture as the
// iris, and dirt (also dirt on the front, which is met once). Without a stop pattern the iris is sharp, and a renderer
// tests or clips its rays against it. With one, a renderer traces along widened(path) through traced_iris(), a circle
// that includes the light outside the opening, and multiplies irradiance by the pattern's transmittance.
// Units: stop radii for points in the stop, mm for points on the front. Thread-safety: a value.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "contrejour/expert/trace.h"
#include "render/stop_patterns/dirt_shadows.h"
#include "render/stop_patterns/stop_pattern.h"

namespace contrejour::inline internal {

// The points at which one ray crosses the stop, and the front if there is dirt on it.
struct StopCrossings {
  std::array<Vec2, kMaxStopCrossings> stop{};
  Vec2 front_mm{};
};

struct StopTransmittance {
  std::shared_ptr<const StopPattern> pattern = nullptr;  // null: the iris is sharp
  std::shared_ptr<const DirtShadows> dirt = nullptr;  // null: the lens is clean

  [[nodiscard]] double outer_radius() const { return pattern ? pattern->outer_radius() : 1.0; }
  // The same path with a stop as large as the pattern; TracedRay::stop is then in units of the larger radius.
  [[nodiscard]] OpticalPath widened(OpticalPath path) const {
    path.stop_radius_mm *= outer_radius();
    return path;
  }
  // The iris that rays along a widened path are tested against.
  [[nodiscard]] Iris traced_iris(const Iris& iris) const { return pattern ? Iris{} : iris; }
  // A factor of all of the ghost's light.
  [[nodiscard]] double level() const { return dirt ? dirt->level() : 1.0; }

  [[nodiscard]] bool has_front() const { return dirt && dirt->site().on_front; }
  // How often light that crosses the stop this often meets dirt.
  [[nodiscard]] std::size_t dirt_crossings(std::size_t stop_crossings) const {
    return has_front() ? 1 : stop_crossings;
  }
  [[nodiscard]] Vec2 dirt_point_mm(const StopCrossings& ray, std::size_t crossing) const {
    return has_front() ? ray.front_mm : ray.stop[crossing] * dirt->site().stop_radius_mm;
  }

  // The rays of a cell of the pupil, of which none has failed.
  struct Cell {
    std::span<const StopCrossings> corners;
    StopCrossings middle;
    std::size_t crossings = 0;  // of the stop
  };
  // What the stop pattern is over a disc about the cell's last crossing of the stop. tolerance: the deviation from 1
  // that still counts as uniform.
  [[nodiscard]] PatternRegion region(const Cell& cell, double tolerance) const;
  // Whether dirt takes nothing from a disc about the cell, at any crossing.
  [[nodiscard]] bool is_clean(const Cell& cell) const;

  // A point of a triangle of rays: fractions of the sides from corner 0 to corners 1 and 2, and the number of parts, as
  // large as the square that the mean is taken over, that the triangle has.
  struct Sample {
    const std::array<StopCrossings, 3>& corner;
    std::size_t crossings;  // of the stop
    Vec2 fractions;
    double parts;
  };
  [[nodiscard]] double pattern_transmittance(const Sample& at) const;
  [[nodiscard]] double dirt_transmittance(const Sample& at) const;
};

}  // namespace contrejour::inline internal
