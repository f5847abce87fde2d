// SPDX-License-Identifier: Apache-2.0
// The layout of a drawn section: its size in pixels, the scale, and the colours of ink and rays. The functions that
// draw its parts are in section_svg.cpp and section_labels.cpp. Thread-safety: pure functions.
#pragma once

#include <algorithm>
#include <cstddef>

#include "contrejour/expert/lens_section.h"
#include "contrejour/expert/svg.h"

namespace contrejour::inline internal {

inline constexpr double kPageWidth_px = 1400, kPageMargin_px = 48, kPageTop_px = 96, kPageBottom_px = 84;
inline constexpr double kMaxSectionHeight_px = 760;
inline constexpr const char* kInk = "#26323d";
inline constexpr const char* kPaleInk = "#8a97a3";

struct RayStyle {
  const char* colour;
  double width;
  double opacity;
};

// Ghosts have six colours, which are used again after the last.
[[nodiscard]] RayStyle style_of(SectionRayKind kind, std::size_t ghost = 0);

// Millimetres of the section -> pixels of the drawing.
class SectionPage {
 public:
  explicit SectionPage(const LensSection& section) : section_(section) {
    const double length_mm = section.right_mm - section.left_mm;
    scale_ =
        std::min((kPageWidth_px - 2 * kPageMargin_px) / length_mm, kMaxSectionHeight_px / (2 * section.half_height_mm));
    left_px_ = 0.5 * (kPageWidth_px - scale_ * length_mm);
    axis_px_ = kPageTop_px + scale_ * section.half_height_mm;
  }
  [[nodiscard]] Vec2 at(Vec2 mm) const {
    return {left_px_ + (mm.x - section_.left_mm) * scale_, axis_px_ - mm.y * scale_};
  }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] double bottom() const { return axis_px_ + scale_ * section_.half_height_mm; }
  [[nodiscard]] double height() const { return bottom() + kPageBottom_px; }
  [[nodiscard]] double left() const { return left_px_; }

 private:
  const LensSection& section_;
  double scale_ = 1, left_px_ = 0, axis_px_ = 0;
};

void draw_title(Svg& svg, const LensState& lens);
void draw_legend(Svg& svg, const LensSection& section);
void draw_scale_bar(Svg& svg, const SectionPage& page);

// Draws each surface's number below the lens, with a line to its rim. The numbers of surfaces that reflect have the
// colour of their ghost.
void draw_surface_numbers(Svg& svg, const SectionPage& page, const LensSection& section);

}  // namespace contrejour::inline internal
