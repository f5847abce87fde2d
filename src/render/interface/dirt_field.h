// Dirt with sharp shadows: the shapes and the picture of a lens's dirt in the plane that they lie in, to be asked place
// by place. A grid of squares knows which shapes come near each. Units: mm of the dirt's plane. Accuracy: a small
// square's covered share as that of a rectangle of the shape's width and area; dirt on the front counts within two
// clear radii of the axis. Thread-safety: constant after it is made. Source: docs/physics/diffraction.md, "Dirt".
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/lens.h"
#include "render/interface/cell_flags.h"
#include "render/interface/dirt_screen.h"

namespace contrejour {

class DirtField final : public DirtScreen {
 public:
  // None where the lens is clean.
  [[nodiscard]] static std::shared_ptr<const DirtField> of(const LensState& lens);
  explicit DirtField(const LensState& lens);

  using DirtScreen::transmission;
  [[nodiscard]] double transmission(const DirtPlace& place, std::size_t crossing = 0) const override;
  [[nodiscard]] bool is_clean(Vec2 middle_mm, double radius_mm, std::size_t crossing = 0) const override;
  [[nodiscard]] Edges edges() const override { return {edges_per_mm_, 0.0}; }
  // Null where there is a picture, or more than a few shapes lie over each other.
  [[nodiscard]] const DirtField* outlines() const override {
    return picture_ == nullptr && covered_ < kMostCovered ? this : nullptr;
  }

  // About what passes an ellipse with these bounds on the average, and how much pixels of some width vary (a variance).
  [[nodiscard]] double mean_within(Vec2 low_mm, Vec2 high_mm) const;
  [[nodiscard]] double variance(double pixel_mm) const;

  [[nodiscard]] bool has_picture() const { return picture_ != nullptr; }
  [[nodiscard]] double extent_mm() const { return extent_mm_; }
  [[nodiscard]] const std::vector<DirtStroke>& shapes() const { return shapes_; }
  // The shapes that may meet a box, by rising index.
  void find_within(Vec2 low_mm, Vec2 high_mm, std::vector<std::uint32_t>& found) const;

 private:
  static constexpr int kCells = 128;  // across the field
  static constexpr double kMostCovered = 0.3;  // of the field
  [[nodiscard]] int cell_of(double coordinate_mm) const { return dirty_.cell_of(coordinate_mm); }
  [[nodiscard]] std::span<const std::uint32_t> shapes_about(int x, int y) const;
  [[nodiscard]] double small_transmission(Vec2 at, double width) const;
  [[nodiscard]] double picture_transmission(const DirtPlace& place) const;

  double clear_radius_mm_;
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
  CellFlags dirty_;  // cells that shapes come near
  std::vector<double> passed_;  // summed over the cells to the left of each border of cells, row by row
  double covered_ = 0.0, edges_per_mm_ = 0.0;
};

}  // namespace contrejour
