// SPDX-License-Identifier: Apache-2.0
#include "render/planning/dirt_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal {
namespace {

constexpr double kFrontExtent = 2.0;  // clear radii: inclined beams cross the first vertex's plane outside the surface
constexpr double kStopExtent = 1.02;  // stop radii
constexpr double kDiagonal = 0.7072;  // half a square's diagonal over its side, rounded up
constexpr double kThinnest_mm = 1e-5;  // the lower end of the classes of width
constexpr int kMaxParts = 8;  // parts a side, for a square that is wider than a cell
constexpr double kDark = 1e-5;  // once shapes leave less light than this, further ones do not matter
constexpr int kFewCells = 3;  // cells across a disc, up to which its distance from every shape is computed
constexpr int kPointsOfCell = 2;  // a side, for a cell's mean transmittance
constexpr int kMaxSubsamples = 4;  // a side of the square, where a picture is finer

// The fraction of a square about a point that a shape covers; the square lies along the shape. If the square is
// narrower than the shape, the fraction follows from the distance to the edge; at round ends the distance is shifted
// inwards so that a disc's fraction integrates to its area. For a wider square the shape is replaced by a rectangle of
// the same width and area, whose fraction integrates to the area as well.
double covered_fraction(const DirtStroke& s, Vec2 point, double width) {
  const double distance = s.distance_mm(point);
  if (!(width > 0.0)) return distance < 0.0 ? 1.0 : 0.0;
  if (width < s.width_mm) {
    if (std::abs(distance) > width) return distance < 0.0 ? 1.0 : 0.0;
    const double radius = 0.5 * s.width_mm;
    const bool at_end = std::abs(s.along_and_across_mm(point).x) > 0.5 * s.length_mm;
    const double inwards = at_end ? radius - std::sqrt(radius * radius - width * width / 12.0) : 0.0;
    return std::clamp(0.5 - (distance + inwards) / width, 0.0, 1.0);
  }
  const auto overlap = [&](double at, double length) {
    return std::clamp(std::min(at + 0.5 * width, 0.5 * length) - std::max(at - 0.5 * width, -0.5 * length), 0.0, width);
  };
  const Vec2 own = s.along_and_across_mm(point);
  const double length = s.length_mm + 0.25 * std::numbers::pi * s.width_mm;
  return overlap(own.x, length) * overlap(own.y, s.width_mm) / (width * width);
}

// The mean of body(offset) over the middles of side x side parts of a unit square about 0.
template <class Body>
double mean_of_parts(int side, const Body& body) {
  double sum = 0.0;
  for (int k = 0; k < side * side; ++k) sum += body(Vec2{(k % side + 0.5) / side - 0.5, (k / side + 0.5) / side - 0.5});
  return sum / (side * side);
}

}  // namespace

std::shared_ptr<const DirtField> DirtField::of(const LensState& lens) {
  return lens.dirt.any() ? std::make_shared<const DirtField>(lens) : nullptr;
}

DirtField::DirtField(const LensState& lens)
    : site_{lens.dirt.plane == DirtPlane::Front, lens.stop_radius_mm, lens.surfaces.front().z_mm},
      clear_radius_mm_(lens.surfaces[site_.on_front ? 0 : static_cast<std::size_t>(lens.stop_index)].semi_diameter_mm),
      extent_mm_(site_.on_front ? kFrontExtent * clear_radius_mm_ : kStopExtent * lens.stop_radius_mm),
      cell_mm_(2.0 * extent_mm_ / kCells), picture_(lens.dirt.picture),
      dirty_(kCells, extent_mm_, [](int, int) { return false; }) {
  shapes_ = dirt_within(lens.dirt, {-extent_mm_, -extent_mm_}, {extent_mm_, extent_mm_});
  std::vector<std::vector<std::uint32_t>> cells(static_cast<std::size_t>(kCells) * kCells);
  std::vector<double> left(cells.size(), 1.0);  // what passes the shapes that cover a cell and its surroundings
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const DirtStroke& s = shapes_[k];
    count(s);
    const double outer_radius = s.outer_radius_mm() + cell_mm_;
    for (int y = cell_of(s.middle_mm.y - outer_radius); y <= cell_of(s.middle_mm.y + outer_radius); ++y)
      for (int x = cell_of(s.middle_mm.x - outer_radius); x <= cell_of(s.middle_mm.x + outer_radius); ++x) {
        // Half the cell's diagonal, and as much again for a square about a point in the cell.
        const auto cell = static_cast<std::size_t>(y * kCells + x);
        if (left[cell] < kDark) continue;
        const Vec2 middle{(x + 0.5) * cell_mm_ - extent_mm_, (y + 0.5) * cell_mm_ - extent_mm_};
        const double distance = s.distance_mm(middle);
        if (distance <= 2.0 * kDiagonal * cell_mm_) cells[cell].push_back(static_cast<std::uint32_t>(k));
        if (distance < -2.0 * kDiagonal * cell_mm_) left[cell] *= 1.0 - s.opacity;
      }
  }
  for (const auto& of_cell : cells) {
    first_.push_back(static_cast<std::uint32_t>(shapes_of_cell_.size()));
    shapes_of_cell_.insert(shapes_of_cell_.end(), of_cell.begin(), of_cell.end());
  }
  first_.push_back(static_cast<std::uint32_t>(shapes_of_cell_.size()));
  sum_up_cells();
}

void DirtField::count(const DirtStroke& s) {
  const double field_mm2 = 4.0 * extent_mm_ * extent_mm_;
  const double covered = s.width_mm * (s.length_mm + 0.25 * std::numbers::pi * s.width_mm) / field_mm2;
  const double coverage = covered * s.opacity * s.opacity;
  edges_per_mm_ += s.opacity * s.opacity * (2.0 * s.length_mm + std::numbers::pi * s.width_mm) / field_mm2;
  const auto octave = static_cast<std::size_t>(std::clamp(std::log2(s.width_mm / kThinnest_mm), 0.0, 31.0));
  if (sizes_.size() <= octave) sizes_.resize(octave + 1);
  Size& size = sizes_[octave];
  size.coverage += coverage;
  if (!(size.coverage > 0.0)) return;
  size.width_mm += (s.width_mm - size.width_mm) * coverage / size.coverage;
  size.length_mm += (s.length_mm + s.width_mm - size.length_mm) * coverage / size.coverage;
}

void DirtField::sum_up_cells() {
  dirty_ = CellFlags(kCells, extent_mm_, [&](int x, int y) { return !shapes_about(x, y).empty(); });
  for (int y = 0; y < kCells; ++y) {
    transmitted_.push_back(0.0);
    for (int x = 0; x < kCells; ++x) {
      const Vec2 middle{(x + 0.5) * cell_mm_ - extent_mm_, (y + 0.5) * cell_mm_ - extent_mm_};
      const bool clean = !picture_ && shapes_about(x, y).empty();
      const double transmitted =
          clean ? 1.0
                : mean_of_parts(kPointsOfCell, [&](Vec2 off) { return transmission({middle + off * cell_mm_, 0.0}); });
      transmitted_.push_back(transmitted_.back() + transmitted);
      covered_ += (1.0 - transmitted) / (kCells * kCells);
    }
  }
  if (!shapes_.empty()) covered_ /= shapes_.front().opacity;  // all shapes have the same opacity
}

// Sums whole cells, row by row, between the points where the ellipse crosses the row.
double DirtField::mean_within(Vec2 low_mm, Vec2 high_mm) const {
  const Vec2 middle = (low_mm + high_mm) * 0.5, half = (high_mm - low_mm) * 0.5;
  double sum = 0.0, cells = 0.0;
  for (int y = cell_of(low_mm.y); y <= cell_of(high_mm.y); ++y) {
    const double up = ((y + 0.5) * cell_mm_ - extent_mm_ - middle.y) / std::max(half.y, 0.5 * cell_mm_);
    const double across = half.x * std::sqrt(std::max(0.0, 1.0 - up * up));
    const int left = cell_of(middle.x - across), right = cell_of(middle.x + across) + 1;
    const double* const row = transmitted_.data() + y * (kCells + 1);
    sum += row[right] - row[left];
    cells += right - left;
  }
  return std::clamp(sum / cells, 0.0, 1.0);
}

// A shape smaller than a pixel dims it by the fraction of the pixel that it covers.
double DirtField::variance(double pixel_mm) const {
  constexpr double kMaxVariance = 0.25;  // the largest variance of a value that is 0 or 1
  if (picture_) return kMaxVariance;
  double sum = 0.0;
  for (const Size& size : sizes_)
    if (size.coverage > 0.0)
      sum += size.coverage * std::min(1.0, size.width_mm / pixel_mm) * std::min(1.0, size.length_mm / pixel_mm);
  return std::min(sum, kMaxVariance);
}

std::span<const std::uint32_t> DirtField::shapes_about(int x, int y) const {
  const auto cell = static_cast<std::size_t>(y * kCells + x);
  return {shapes_of_cell_.data() + first_[cell], first_[cell + 1] - first_[cell]};
}

// A square no wider than a cell meets only shapes that are listed for the cell of its middle.
double DirtField::small_transmission(Vec2 at, double width) const {
  double all = 1.0;
  for (const std::uint32_t k : shapes_about(cell_of(at.x), cell_of(at.y))) {
    const DirtStroke& s = shapes_[k];
    const Vec2 from = at - s.middle_mm;
    const double outer_radius = s.outer_radius_mm() + kDiagonal * width;
    if (dot(from, from) > outer_radius * outer_radius) continue;
    all *= 1.0 - s.opacity * covered_fraction(s, at, width);
    if (!(all > 0.0)) break;
  }
  return all;
}

double DirtField::transmission(const DirtPoint& point) const {
  if (!std::isfinite(point.at_mm.x + point.at_mm.y)) return 1.0;
  const double of_picture = picture_ ? picture_transmission(point) : 1.0;
  return shapes_.empty() ? of_picture : of_picture * shapes_transmission(point);
}

double DirtField::shapes_transmission(const DirtPoint& point) const {
  const int parts = std::clamp(static_cast<int>(std::ceil(point.width_mm / cell_mm_)), 1, kMaxParts);
  return mean_of_parts(
      parts, [&](Vec2 off) { return small_transmission(point.at_mm + off * point.width_mm, point.width_mm / parts); });
}

double DirtField::picture_transmission(const DirtPoint& point) const {
  const Vec2 at = point.at_mm * (1.0 / clear_radius_mm_);
  const double width = point.width_mm / clear_radius_mm_;
  const int parts = std::clamp(static_cast<int>(std::ceil(width / picture_->pixel())), 1, kMaxSubsamples);
  return mean_of_parts(parts, [&](Vec2 off) { return picture_->transmission(at + off * width); });
}

bool DirtField::is_clean(Vec2 middle_mm, double radius_mm) const {
  if (picture_) return false;
  const int left = cell_of(middle_mm.x - radius_mm), right = cell_of(middle_mm.x + radius_mm);
  const int low = cell_of(middle_mm.y - radius_mm), high = cell_of(middle_mm.y + radius_mm);
  for (int y = low; y <= high; ++y) {
    if (!dirty_.any(left, right, y)) continue;
    if (high - low > kFewCells) return false;
    for (int x = left; x <= right; ++x)
      for (const std::uint32_t k : shapes_about(x, y))
        if (shapes_[k].distance_mm(middle_mm) <= radius_mm) return false;
  }
  return true;
}

void DirtField::find_within(Vec2 low_mm, Vec2 high_mm, std::vector<std::uint32_t>& found) const {
  found.clear();
  for (int y = cell_of(low_mm.y); y <= cell_of(high_mm.y); ++y)
    for (int x = cell_of(low_mm.x); x <= cell_of(high_mm.x); ++x)
      for (const std::uint32_t k : shapes_about(x, y)) {
        const DirtStroke& s = shapes_[k];
        const double outer_radius = s.outer_radius_mm();
        if (s.middle_mm.x + outer_radius >= low_mm.x && s.middle_mm.x - outer_radius <= high_mm.x &&
            s.middle_mm.y + outer_radius >= low_mm.y && s.middle_mm.y - outer_radius <= high_mm.y)
          found.push_back(k);
      }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

std::size_t DirtField::bytes() const {
  return shapes_.size() * sizeof(DirtStroke) + (first_.size() + shapes_of_cell_.size()) * sizeof(std::uint32_t) +
         transmitted_.size() * sizeof(double);
}

}  // namespace contrejour::inline internal
