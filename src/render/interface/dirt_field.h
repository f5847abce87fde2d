// Dirt as ghosts see it: the shapes and the picture of a lens's dirt in the plane that they lie in, to be asked place
// by place. A grid of squares knows which shapes come near each. Light meets dirt in the stop at every crossing of it,
// dirt on the front once, where it came in. Units: mm of the dirt's plane. Accuracy: a small square's covered share as
// that of a rectangle of the shape's width and area; dirt on the front counts within two clear radii of the axis.
// Thread-safety: constant after it is made. Source: docs/physics/diffraction.md, "Dirt".
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/lens.h"
#include "contrejour/light_source.h"

namespace contrejour {

// A place where light crosses the dirt's plane, and the side of the square about it that is asked about.
struct DirtPlace {
  Vec2 at_mm;
  double width_mm = 0.0;
};

class DirtField {
 public:
  // None where the lens is clean.
  [[nodiscard]] static std::shared_ptr<const DirtField> of(const LensState& lens);
  explicit DirtField(const LensState& lens);

  [[nodiscard]] bool on_front() const { return on_front_; }
  [[nodiscard]] double stop_radius_mm() const { return stop_radius_mm_; }
  // Where a light's ray through a point of the plane z = z_mm crosses the front.
  [[nodiscard]] Vec2 front_place(Vec2 entrance_mm, double z_mm, const LightSource& light) const;

  // The share of light that passes: mean over each place's square, the product of all.
  [[nodiscard]] double transmission(std::span<const DirtPlace> places) const;
  [[nodiscard]] double transmission(const DirtPlace& place) const;
  // Of a disc: nothing comes near it. A large one counts as not clean where dirt comes near its bounds.
  [[nodiscard]] bool is_clean(Vec2 middle_mm, double radius_mm) const;

  // About what passes an ellipse with these bounds on the average, and how much pixels of some width vary (a variance).
  [[nodiscard]] double mean_within(Vec2 low_mm, Vec2 high_mm) const;
  [[nodiscard]] double variance(double pixel_mm) const;

  // Whether all of it may be drawn as the shapes' outlines: no picture, nor more than a few shapes over each other.
  [[nodiscard]] bool is_shapes() const { return picture_ == nullptr && covered_ < kMostCovered; }
  [[nodiscard]] const std::vector<DirtStroke>& shapes() const { return shapes_; }
  [[nodiscard]] double edges_per_mm() const { return edges_per_mm_; }  // length of outlines over area, times opacity^2
  // The shapes that may meet a box, by rising index.
  void find_within(Vec2 low_mm, Vec2 high_mm, std::vector<std::uint32_t>& found) const;

 private:
  static constexpr int kCells = 128;  // across the field
  static constexpr double kMostCovered = 0.3;  // of the field
  [[nodiscard]] int cell_of(double coordinate_mm) const;
  [[nodiscard]] std::span<const std::uint32_t> shapes_about(int x, int y) const;
  [[nodiscard]] double small_transmission(Vec2 at, double width) const;
  [[nodiscard]] double picture_transmission(const DirtPlace& place) const;

  bool on_front_;
  double stop_radius_mm_, front_z_mm_, clear_radius_mm_;
  double extent_mm_;  // the field is the square from -extent to extent
  double cell_mm_;
  std::vector<DirtStroke> shapes_;
  std::vector<std::uint32_t> first_, shapes_of_cell_;  // cell k's are shapes_of_cell_[first_[k]..first_[k + 1]]
  std::shared_ptr<const DirtPicture> picture_;
  struct Size {  // of the shapes of about one width
    double share = 0.0;  // of the field that they cover, times opacity^2
    double width_mm = 0.0, length_mm = 0.0;  // means, by that
  };
  void count(const DirtStroke& shape);
  void sum_up_cells();

  std::vector<Size> sizes_;
  std::vector<std::uint16_t> dirty_;  // counts of the cells that shapes come near, summed as `passed_` is
  std::vector<double> passed_;  // summed over the cells to the left of each border of cells, row by row
  double covered_ = 0.0, edges_per_mm_ = 0.0;
};

}  // namespace contrejour
