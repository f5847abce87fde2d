// SPDX-License-Identifier: Apache-2.0
#include "render/device/kept_device_dirt.h"

#include <cmath>

namespace contrejour::inline internal {
namespace {

constexpr double kStraightBend_rad = 1e-5;  // a line that bends less is straight to a 1e-5 of its length

DeviceStroke device_stroke(const DirtStroke& s) {
  const bool is_bent = std::abs(s.bend_rad) > kStraightBend_rad && s.length_mm > 0.0;
  return {.middle_mm = s.middle_mm,
          .along = {std::cos(s.angle_rad), std::sin(s.angle_rad)},
          .half_length_mm = 0.5 * s.length_mm,
          .half_width_mm = 0.5 * s.width_mm,
          .radius_mm = is_bent ? s.length_mm / s.bend_rad : 0.0,
          .opacity = s.opacity};
}

// Sets the lists of strokes about each cell, and the sums over cells.
void set_cells(const DirtField& field, DeviceDirt& dirt) {
  constexpr int kCells = DirtField::kCells;
  constexpr std::size_t kCorners = kCells + 1;
  const double cell_mm = 2.0 * field.extent_mm() / kCells;
  dirt.cells = kCells;
  dirt.blocked_before.assign(kCorners * kCorners, 0.0F);
  dirt.dirty_before.assign(kCorners * kCorners, 0);
  std::vector<double> blocked_below(kCorners, 0.0);  // by corner of the row
  for (int y = 0; y < kCells; ++y) {
    double blocked = 0.0;
    std::uint32_t dirty = 0;
    for (int x = 0; x < kCells; ++x) {
      const auto strokes = field.shapes_about(x, y);
      dirt.first.push_back(static_cast<std::uint32_t>(dirt.of_cell.size()));
      dirt.of_cell.insert(dirt.of_cell.end(), strokes.begin(), strokes.end());
      const Vec2 middle{(x + 0.5) * cell_mm - field.extent_mm(), (y + 0.5) * cell_mm - field.extent_mm()};
      if (!strokes.empty()) {
        blocked += 1.0 - field.shapes_transmission({middle, cell_mm});
        ++dirty;
      }
      const std::size_t right = static_cast<std::size_t>(x) + 1, row = static_cast<std::size_t>(y) + 1;
      blocked_below[right] += blocked;
      dirt.blocked_before[row * kCorners + right] = static_cast<float>(blocked_below[right]);
      dirt.dirty_before[row * kCorners + right] = dirt.dirty_before[(row - 1) * kCorners + right] + dirty;
    }
  }
  dirt.first.push_back(static_cast<std::uint32_t>(dirt.of_cell.size()));
}

// The squared contrasts of a picture's neighbouring pixels, times the length of their border, by area: as DirtEdges.
double edges_per_mm(const DirtPicture& picture, double clear_radius_mm) {
  const auto width = static_cast<std::size_t>(picture.width()), height = static_cast<std::size_t>(picture.height());
  const auto levels = picture.levels();
  double squares = 0.0;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const double here = levels[y * width + x];
      if (x + 1 < width) squares += std::pow(levels[y * width + x + 1] - here, 2.0);
      if (y + 1 < height) squares += std::pow(levels[(y + 1) * width + x] - here, 2.0);
    }
  }
  return squares / (static_cast<double>(width * height) * picture.pixel() * clear_radius_mm);
}

std::shared_ptr<const DeviceDirt> device_dirt(const DirtField& field) {
  auto dirt = std::make_shared<DeviceDirt>();
  dirt->on_front = field.site().on_front;
  dirt->mm_a_unit = dirt->on_front ? 1.0 : field.site().stop_radius_mm;
  dirt->extent_mm = field.extent_mm();
  dirt->edges_per_mm = field.edges().per_mm;
  dirt->strokes.reserve(field.shapes().size());
  for (const DirtStroke& stroke : field.shapes()) dirt->strokes.push_back(device_stroke(stroke));
  set_cells(field, *dirt);
  dirt->has_outlines = field.outlines() != nullptr;
  dirt->picture = field.picture();
  dirt->clear_radius_mm = field.clear_radius_mm();
  if (dirt->picture) dirt->edges_per_mm += edges_per_mm(*dirt->picture, dirt->clear_radius_mm);
  return dirt;
}

}  // namespace

std::shared_ptr<const DeviceDirt> KeptDeviceDirt::get(const std::shared_ptr<const DirtField>& field) {
  if (field != field_) dirt_ = field ? device_dirt(*field) : nullptr;
  field_ = field;
  return dirt_;
}

std::size_t KeptDeviceDirt::memory_bytes() const {
  if (!dirt_) return 0;
  return dirt_->strokes.size() * sizeof(DeviceStroke) +
         (dirt_->first.size() + dirt_->of_cell.size() + dirt_->dirty_before.size()) * sizeof(std::uint32_t) +
         dirt_->blocked_before.size() * sizeof(float);
}

}  // namespace contrejour::inline internal
