// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/sequential_design.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "optics/lens_files/complete.h"
#include "optics/lens_files/sequential/design_light.h"
#include "optics/lens_files/sequential/design_poses.h"
#include "optics/lens_files/sequential/design_positions.h"
#include "optics/lens_files/sequential/design_rows.h"
#include "optics/lens_files/sequential/design_text.h"

namespace contrejour::inline internal {
namespace {

constexpr double kNearFocus = 0.05;  // of the focal length: an image surface nearer to the focus is kept as defocused
constexpr double kInFocus = 1e-6;  // of the focal length: rounding of printed distances
constexpr double kSameZoomPosition = 1e-6;  // relative: zoom positions nearer than this are merged
constexpr double kNearNominal = 0.2;  // relative: an engraved focal length and the real one
constexpr double kDefaultDiagonal_mm = 43.2666;  // 36 x 24

// A position of a zoom, and its line in the file.
struct Position {
  double focal_mm = 0;
  std::size_t index = 0;
};

class Builder {
 public:
  explicit Builder(const SequentialDesign& design) : design_(design) {}

  Result<Prescription> build() {
    lens_.name = design_.name.empty() ? stem_of(design_.file) : design_.name;
    lens_.source = design_.source;
    lens_.file = {design_.file, 0, 0};
    lens_.warnings = design_.warnings;
    set_wavelength();
    if (design_.surfaces.size() < 3)
      return failure(ErrorCode::Parse, "no lens: it has an object, an image and nothing between", lens_.file);
    auto rows = rows_of(design_, lens_.warnings);
    if (!rows) return tl::unexpected(rows.error());
    rows_ = std::move(*rows);
    positions_ = positions_of(design_, lens_.warnings);
    if (const auto placed = place_rows(design_, positions_, rows_); !placed) return tl::unexpected(placed.error());
    for (const DesignRow& row : rows_) lens_.surfaces.push_back(row.surface);
    set_gaps();
    return finish();
  }

 private:
  void warn(std::string message) { lens_.warnings.push_back(std::move(message)); }

  void set_wavelength() {
    if (!design_.wavelength_nm) return;
    if (*design_.wavelength_nm >= 300.0 && *design_.wavelength_nm <= 1100.0) {
      lens_.stated.wavelength_nm = *design_.wavelength_nm;
    } else {
      warn(fmt::format("designed for {:g} nm; focal length and focus are those of {:g} nm", *design_.wavelength_nm,
                       lens_.stated.wavelength_nm));
    }
  }

  [[nodiscard]] std::vector<double> gaps_at(std::size_t position) const {
    return gaps_mm(rows_, positions_[position].thickness, design_.unit_mm);
  }
  // From the last row to the image surface.
  [[nodiscard]] double image_gap_mm(const DesignPosition& position) const {
    return gap_mm(rows_.back(), position.thickness, design_.unit_mm);
  }

  void set_gaps(std::size_t position = 0) {
    const auto gaps = gaps_at(position);
    for (std::size_t k = 0; k + 1 < gaps.size(); ++k) lens_.surfaces[k].thickness_mm = gaps[k];
    if (position > 0) return;
    for (std::size_t k = 1; k + 1 < gaps.size(); ++k)
      if (gap_mm(rows_[k], positions_[0].thickness, design_.unit_mm) < gaps[k])
        warn(fmt::format("the opening (line {}) stands behind the next surface's vertex; it is moved there",
                         rows_[k].surface.source_line));
  }

  Result<Prescription> finish() {
    // The distance to the first row includes the surfaces in front of it.
    const std::vector<double>& thickness = positions_.front().thickness;
    double object_mm = thickness.front();
    for (std::size_t k = 1; k < rows_.front().of; ++k) object_mm += thickness[k];
    const auto light = light_of(design_, lens_, object_mm * design_.unit_mm);
    if (!light) return tl::unexpected(light.error());
    if (light->stop_is_open)
      warn("nothing tells the stop's size; it lets through what the other surfaces do of a beam along the axis");
    lens_.f_number = light->f_number;
    set_sensor(*light, std::isinf(object_mm));
    if (const auto zoomed = set_zoom(); !zoomed) return tl::unexpected(zoomed.error());
    return completed(std::move(lens_), light->beam);
  }

  void set_sensor(const DesignLight& light, bool distant) {
    double radius_mm = light.image_radius_mm;
    if (radius_mm == 0.0) {
      radius_mm = 0.5 * std::min(kDefaultDiagonal_mm, std::abs(light.focal_length_mm));
      warn(fmt::format("no field off the axis is told; the sensor's diagonal is taken as {:.6g} mm", 2.0 * radius_mm));
    }
    lens_.sensor_width_mm = 2.0 * radius_mm * 3.0 / std::sqrt(13.0);
    lens_.sensor_height_mm = 2.0 * radius_mm * 2.0 / std::sqrt(13.0);
    if (design_.field == FieldKind::ImageHeight && design_.largest_x > 0.0 && design_.largest_y > 0.0) {
      lens_.sensor_width_mm = 2.0 * design_.largest_x * design_.unit_mm;
      lens_.sensor_height_mm = 2.0 * design_.largest_y * design_.unit_mm;
    }
    if (!distant || design_.is_focused) return;
    const double at_mm = image_gap_mm(positions_.front());
    for (const auto& position : positions_)
      if (image_gap_mm(position) != at_mm) return;  // it follows the focus
    const double defocus_mm = std::abs(at_mm - light.focus_mm);
    if (defocus_mm <= kInFocus * std::abs(light.focal_length_mm)) return;
    if (defocus_mm <= kNearFocus * std::abs(light.focal_length_mm) && at_mm > 0.0) {
      lens_.sensor_distance_mm = at_mm;
    } else {
      warn(
          fmt::format("the image surface (line {}) stands {:.6g} mm behind the lens, distant objects are in focus at "
                      "{:.6g} mm; the sensor is put there",
                      design_.surfaces.back().line, at_mm, light.focus_mm));
    }
  }

  // Sorts positions by focal length and merges those of equal focal length.
  Result<void> set_zoom() {
    if (positions_.size() < 2) return {};
    std::vector<Position> sorted;
    for (std::size_t p = 0; p < positions_.size(); ++p) {
      set_gaps(p);
      const auto light = light_of(design_, lens_, std::numeric_limits<double>::infinity());
      if (!light) return tl::unexpected(light.error());
      sorted.push_back({light->focal_length_mm, p});
      lens_.f_number = std::min(lens_.f_number, light->f_number);  // 0 if the stop's opening determines it
    }
    std::stable_sort(sorted.begin(), sorted.end(), [](auto& a, auto& b) { return a.focal_mm < b.focal_mm; });
    const auto same = [](auto& a, auto& b) { return std::abs(b.focal_mm / a.focal_mm - 1.0) < kSameZoomPosition; };
    sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
    set_gaps(sorted.front().index);
    if (sorted.size() < 2) return {};
    for (const Position& position : sorted) lens_.zoom.push_back({position.focal_mm, {}, 0});
    name_positions(sorted);
    for (std::size_t k = 0; k + 1 < rows_.size(); ++k) {
      std::vector<double> gaps;
      for (const Position& position : sorted) gaps.push_back(gaps_at(position.index)[k]);
      if (std::all_of(gaps.begin(), gaps.end(), [&](double gap) { return gap == gaps.front(); })) continue;
      for (std::size_t p = 0; p < sorted.size(); ++p)
        lens_.zoom[p].thickness_mm.emplace_back(static_cast<int>(k), gaps[p]);
    }
    return {};
  }

  // Names positions by the focal lengths that the file states, if these nearly agree with the computed ones.
  void name_positions(const std::vector<Position>& sorted) {
    std::vector<double> names;
    for (const Position& position : sorted) {
      const double nominal_mm = positions_[position.index].nominal_focal_mm;
      if (std::abs(nominal_mm / position.focal_mm - 1.0) > kNearNominal) return;
      if (!names.empty() && nominal_mm <= names.back()) return;
      names.push_back(nominal_mm);
    }
    for (std::size_t p = 0; p < names.size(); ++p) lens_.zoom[p].focal_length_mm = names[p];
  }

  const SequentialDesign& design_;
  Prescription lens_;
  std::vector<DesignRow> rows_;
  std::vector<DesignPosition> positions_;
};

}  // namespace

SequentialDesign design_from(std::string program, const std::string& file) {
  SequentialDesign design;
  design.source = fmt::format("a {} file that does not say it", program);
  design.program = std::move(program);
  design.file = file;
  return design;
}

Result<Prescription> prescription_of(const SequentialDesign& design) { return Builder(design).build(); }

}  // namespace contrejour::inline internal
