// SPDX-License-Identifier: Apache-2.0
// Dirt with sharp shadows: the shapes and the picture of a lens's dirt in the plane that they lie in, and the
// transmittance of the dirt at any point. A grid of cells lists the shapes that come near each cell. Units: mm of the
// dirt's plane. Accuracy: a small square is covered as by a rectangle of the shape's width and area; dirt on the front
// counts within two clear radii of the axis.
// Thread-safety: constant after construction. Source: docs/physics/diffraction.md, "Dirt".
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/expert/light_source.h"
#include "contrejour/lens.h"
#include "render/planning/cell_flags.h"

namespace contrejour::inline internal {

// A point where light crosses the dirt's plane, and the side of the square about it over which the mean is taken.
struct DirtPoint {
  Vec2 at_mm;
  double width_mm = 0.0;
};

// The shadows' edges: their length per area, times opacity^2, and their approximate width (0: sharp).
struct DirtEdges {
  double per_mm = 0.0, edge_width_mm = 0.0;
};

// The plane that the dirt lies in.
struct DirtSite {
  bool on_front = false;
  double stop_radius_mm = 0.0;
  double front_z_mm = 0.0;

  // Where a light's ray through a point of the plane z = z_mm crosses the front.
  [[nodiscard]] Vec2 front_point(Vec2 entrance_mm, double z_mm, const LightSource& light) const {
    const Vec3 along = light.direction_at({entrance_mm.x, entrance_mm.y, z_mm});
    return entrance_mm + Vec2{along.x, along.y} * ((front_z_mm - z_mm) / along.z);
  }
};

class DirtField {
 public:
  static constexpr int kCells = 128;  // across the field

  // Null where the lens is clean.
  [[nodiscard]] static std::shared_ptr<const DirtField> of(const LensState& lens);
  explicit DirtField(const LensState& lens);

  [[nodiscard]] const DirtSite& site() const { return site_; }
  // The mean transmittance over the square about the point.
  [[nodiscard]] double transmission(const DirtPoint& point) const;
  // The same without the picture.
  [[nodiscard]] double shapes_transmission(const DirtPoint& point) const;
  // Whether transmission() is 1 all over a disc. A large disc counts as not clean where dirt comes near its bounds.
  [[nodiscard]] bool is_clean(Vec2 middle_mm, double radius_mm) const;
  [[nodiscard]] DirtEdges edges() const { return {edges_per_mm_, 0.0}; }
  // This field, whose shadows may be drawn as the shapes' outlines; null if there is a picture, or if overlaps of
  // shapes cannot be ignored because they cover much of the field.
  [[nodiscard]] const DirtField* outlines() const {
    return picture_ == nullptr && covered_ < kMaxCovered ? this : nullptr;
  }

  // Approximate mean transmittance over the ellipse with these bounds; approximate variance of the transmittance of
  // pixels of this width.
  [[nodiscard]] double mean_within(Vec2 low_mm, Vec2 high_mm) const;
  [[nodiscard]] double variance(double pixel_mm) const;

  [[nodiscard]] bool has_picture() const { return picture_ != nullptr; }
  [[nodiscard]] const std::shared_ptr<const DirtPicture>& picture() const { return picture_; }
  [[nodiscard]] double clear_radius_mm() const { return clear_radius_mm_; }  // that the picture spans
  [[nodiscard]] double extent_mm() const { return extent_mm_; }
  [[nodiscard]] const std::vector<DirtStroke>& shapes() const { return shapes_; }
  // The numbers of the shapes that a square no wider than a cell about any point of a cell may meet.
  [[nodiscard]] std::span<const std::uint32_t> shapes_about(int x, int y) const;
  // Appends the shapes that may meet a box, in order of index.
  void find_within(Vec2 low_mm, Vec2 high_mm, std::vector<std::uint32_t>& found) const;
  [[nodiscard]] std::size_t bytes() const;  // of its arrays

 private:
  static constexpr double kMaxCovered = 0.3;  // fraction of the field
  [[nodiscard]] int cell_of(double coordinate_mm) const { return dirty_.cell_of(coordinate_mm); }
  [[nodiscard]] double small_transmission(Vec2 at, double width) const;
  [[nodiscard]] double picture_transmission(const DirtPoint& point) const;

  DirtSite site_;
  double clear_radius_mm_;
  double extent_mm_;  // the field is the square from -extent to extent
  double cell_mm_;
  std::vector<DirtStroke> shapes_;
  std::vector<std::uint32_t> first_, shapes_of_cell_;  // those of cell k: shapes_of_cell_[first_[k]..first_[k + 1]]
  std::shared_ptr<const DirtPicture> picture_;
  struct Size {  // the shapes of a class of width, an octave
    double coverage = 0.0;  // fraction of the field that they cover, times opacity^2
    double width_mm = 0.0, length_mm = 0.0;  // means, weighted by that fraction
  };
  void count(const DirtStroke& shape);
  void sum_up_cells();

  std::vector<Size> sizes_;
  CellFlags dirty_;  // cells that are near a shape
  std::vector<double> transmitted_;  // sum of the transmittances of the cells to the left of each border, row by row
  double covered_ = 0.0, edges_per_mm_ = 0.0;
};

}  // namespace contrejour::inline internal
