// SPDX-License-Identifier: Apache-2.0
// A plane of dirt out of focus: the transmittance of its shapes for a ghost's light at a wavelength, or in a band, as
// shadows with fringes. Each shape subtracts its own wave from the light's. The results multiply, and the transmittance
// is |product|^2, which is exact for shapes apart from each other and for sharp ones that overlap. A scratch's wave is
// that of a slit of its width along its line. A speck's wave is a sum over slices, or that of its outline where this is
// nearly straight. Light that a shape sends farther than its fringes are drawn, or that is too weak to be drawn, is
// spread evenly over the plane, so that each shape takes as much light as its sharp shadow.
//
// Units: mm; a "unit" is sqrt(lambda z), about a fringe's width. Accuracy: 5 per cent of the level, root mean square,
// within StraightEdge::kTaperFrom units of a shape; waves weaker than kMinWave are left out.
// Thread-safety: const members may run concurrently. See docs/physics/diffraction.md, "Dirt".
#pragma once

#include <array>
#include <atomic>
#include <complex>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/expert/dirt.h"
#include "diffraction/straight_edge.h"
#include "render/planning/cell_flags.h"

namespace contrejour::inline internal::stop_patterns {

class DirtDiffraction {
 public:
  static constexpr double kMinWave = 0.005;  // relative to the light's

  // shapes: those of the square from -extent to extent. lambda_z_mm2: the wavelength times the effective distance.
  DirtDiffraction(std::span<const DirtStroke> shapes, double extent_mm, double lambda_z_mm2,
                  std::shared_ptr<const StraightEdge> edge);
  ~DirtDiffraction();
  DirtDiffraction(const DirtDiffraction&) = delete;
  DirtDiffraction& operator=(const DirtDiffraction&) = delete;

  // The transmittance far from all shapes.
  [[nodiscard]] double level() const { return level_; }
  // Relative to the level, as DirtShadows's.
  [[nodiscard]] double transmission(Vec2 at_mm, double width_mm) const;
  [[nodiscard]] bool is_clean(Vec2 middle_mm, double radius_mm) const;
  [[nodiscard]] double fringe_unit_mm() const { return fringe_unit_mm_; }  // about a fringe's width
  [[nodiscard]] std::size_t bytes() const;  // of shapes and of the tiles that were made

 private:
  static constexpr double kSamplesOfUnit = 8.0;
  static constexpr int kMaxSlices = 16;
  using Wave = std::complex<float>;
  struct Shape {
    DirtStroke stroke;
    float amplitude = 1.0F;  // amplitude that an opaque point takes away
    double outer_radius_mm = 0.0;  // reach of its wave from its edge
    Vec2 along = {}, bent_about_mm = {};  // at its middle; the centre of its circle
    double radius_mm = 0.0;  // of that circle, positive if its centre lies to the left; 0: straight
    double inner_cosine = 2.0;  // cosine of the angle about the centre within which its ends have no effect
    int slices = 0;  // of a speck, along it; 0: a speck drawn by its outline, or a scratch
    std::array<float, kMaxSlices> half_length{};  // of each slice, in units
    [[nodiscard]] double around_mm() const { return stroke.outer_radius_mm() + outer_radius_mm; }
  };
  // Round specks of about one size: the power of their wave over their area, and how far from the edge it is strong.
  struct Speck {
    double power = 1.0, outer_radius = 0.0;
  };
  struct Tile;

  [[nodiscard]] Shape shape_of(const DirtStroke& stroke) const;
  [[nodiscard]] Speck speck_of(double width) const;
  [[nodiscard]] bool set_outer_radius(Shape& shape, std::map<int, Speck>& specks, double& taken_mm2) const;
  [[nodiscard]] double scratch_flux(const Shape& shape) const;
  void add_shapes(std::span<const DirtStroke> shapes);
  void sort_into_cells();

  [[nodiscard]] Wave slit(double at, double half) const { return edge_->at(at + half) - edge_->at(at - half); }
  [[nodiscard]] Wave wave(const Shape& shape, Vec2 at_mm) const;
  [[nodiscard]] Wave speck_wave(const Shape& shape, Vec2 own) const;
  [[nodiscard]] Wave scratch_wave(const Shape& shape, Vec2 at_mm) const;
  [[nodiscard]] double transmitted(Wave amplitude) const;
  [[nodiscard]] double transmitted(Vec2 at_mm) const;
  [[nodiscard]] std::span<const std::uint32_t> shapes_about(int x, int y) const;

  // Samples of 1 - transmittance in tiles, which any thread makes when they are first needed. Each level has half the
  // sampling density of the level below and is smoothed by 1, 2, 1.
  struct Level {
    double per_mm = 0.0;  // samples
    unsigned tiles = 0;  // a side
    mutable std::vector<std::atomic<const Tile*>> tile;
  };
  [[nodiscard]] const Tile& tile(std::size_t level, unsigned x, unsigned y) const;
  [[nodiscard]] std::unique_ptr<Tile> sampled_tile(unsigned x, unsigned y) const;
  [[nodiscard]] std::unique_ptr<Tile> smoothed_tile(std::size_t level, unsigned x, unsigned y) const;
  [[nodiscard]] float sample(std::size_t level, long column, long row) const;
  [[nodiscard]] double between_samples(std::size_t level, Vec2 at_mm) const;

  double extent_mm_, fringe_unit_mm_, per_mm_;  // 1 / unit
  std::shared_ptr<const StraightEdge> edge_;
  double level_ = 1.0;
  std::vector<Shape> shapes_;
  int cells_ = 1;
  std::vector<std::uint32_t> first_, shapes_of_cell_;
  CellFlags dirty_;
  double pitch_mm_;  // of the first level; 0: it would need too many tiles
  std::array<Level, 5> levels_;
};

}  // namespace contrejour::inline internal::stop_patterns
