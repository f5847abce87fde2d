// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/design_rows.h"

#include <cmath>

#include <fmt/format.h>

#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/sequential/design_opening.h"

namespace contrejour::inline internal {
namespace {

class Rows {
 public:
  Rows(const SequentialDesign& design, std::vector<std::string>& warnings) : design_(design), warnings_(warnings) {}

  Result<std::vector<DesignRow>> make() {
    const DesignSurface& image = design_.surfaces.back();
    Glass medium = air();
    int stops = 0, refracting = 0;
    for (std::size_t k = 1; k + 1 < design_.surfaces.size(); ++k) {
      const DesignSurface& from = design_.surfaces[k];
      if (!std::isfinite(from.thickness)) return wrong(from.line, "an infinite thickness behind a surface of the lens");
      const bool refracts = !from.is_break && !(from.glass_after == medium);
      refracting += refracts ? 1 : 0;
      stops += from.is_stop ? 1 : 0;
      add(k, medium, refracts);
      if (!rows_.empty()) rows_.back().gap.push_back(k);
      if (!from.is_break) medium = from.glass_after;
    }
    if (image.curvature != 0.0 || !image.shape.is_sphere())
      warn(fmt::format("the image surface (line {}) is curved; the sensor is flat", image.line));
    if (refracting == 0) return wrong(image.line, "no lens: no surface refracts");
    rows_.back().gap.push_back(design_.surfaces.size() - 1);
    if (stops != 1)
      return wrong(image.line, stops == 0 ? "no surface is the stop; say which one is" : "more than one stop");
    return std::move(rows_);
  }

 private:
  [[nodiscard]] Result<std::vector<DesignRow>> wrong(int line, std::string message) const {
    return failure(ErrorCode::Parse, std::move(message), {design_.file, line, 0});
  }
  void warn(std::string message) { warnings_.push_back(std::move(message)); }

  void add(std::size_t k, const Glass& medium, bool refracts) {
    const DesignSurface& from = design_.surfaces[k];
    if (!refracts && !from.is_stop && !from.opening && !from.obscuration.any()) return;
    const Surface surface = surface_of(from);
    if (from.is_stop) rows_.push_back({stop_of(from, surface, medium, refracts), {}, from.own, k});
    if (refracts || !from.is_stop) rows_.push_back({surface, {}, from.own, k});
  }

  [[nodiscard]] SurfaceShape shape_in_mm(const DesignSurface& from) const {
    SurfaceShape shape = from.shape;
    if (design_.unit_mm == 1.0) return shape;
    shape.curvature_x_per_mm /= design_.unit_mm;
    for (std::size_t k = 0; k < shape.powers.size(); ++k)
      shape.powers[k] *= std::pow(design_.unit_mm, -static_cast<double>(k));
    return shape;
  }

  [[nodiscard]] Surface surface_of(const DesignSurface& from) {
    Surface surface;
    surface.source_line = from.line;
    surface.curvature_per_mm = tidy_curvature(from.curvature / design_.unit_mm);
    surface.shape = shape_in_mm(from);
    surface.glass_after = from.glass_after;
    set_opening(from, design_.unit_mm, surface, warnings_);
    return surface;
  }

  // The stop's row: flat, in the medium in front. A semi-diameter that the program computed for its own rays is
  // replaced by that of the f-number.
  [[nodiscard]] Surface stop_of(const DesignSurface& from, const Surface& at, const Glass& medium, bool refracts) {
    Surface stop;
    stop.kind = SurfaceKind::Stop;
    stop.source_line = from.line;
    stop.glass_after = medium;
    const bool own = design_.is_by_stop() || from.is_semi_fixed || from.opening;
    if (own) stop.semi_diameter_mm = at.semi_diameter_mm;
    if (!refracts) stop.obscuration = at.obscuration;
    if (at.aperture.kind != ApertureKind::Disc)
      warn(
          fmt::format("the stop (line {}) is not round; the circle around it is used, --blades and --iris-image give "
                      "it a shape",
                      from.line));
    if (!refracts && (at.curvature_per_mm != 0.0 || !at.shape.is_sphere()))
      warn(fmt::format("the stop (line {}) is curved; it is taken as flat", from.line));
    return stop;
  }

  const SequentialDesign& design_;
  std::vector<std::string>& warnings_;
  std::vector<DesignRow> rows_;
};

}  // namespace

Result<std::vector<DesignRow>> rows_of(const SequentialDesign& design, std::vector<std::string>& warnings) {
  return Rows(design, warnings).make();
}

double gap_mm(const DesignRow& row, const std::vector<double>& thickness, double unit_mm) {
  double sum = 0.0;
  for (const std::size_t k : row.gap) sum += thickness[k];
  return sum * unit_mm + 0.0;
}

std::vector<double> gaps_mm(const std::vector<DesignRow>& rows, const std::vector<double>& thickness, double unit_mm) {
  std::vector<double> gaps;
  for (const DesignRow& row : rows) gaps.push_back(gap_mm(row, thickness, unit_mm));
  for (std::size_t k = gaps.size(); k-- > 1;) {
    const bool bends = rows[k].surface.kind == SurfaceKind::Refracting &&
                       !(rows[k].surface.glass_after == rows[k - 1].surface.glass_after);
    if (bends || k + 1 == gaps.size() || gaps[k] >= 0.0 || gaps[k - 1] + gaps[k] < 0.0) continue;
    gaps[k - 1] += gaps[k];
    gaps[k] = 0.0;
  }
  return gaps;
}

}  // namespace contrejour::inline internal
