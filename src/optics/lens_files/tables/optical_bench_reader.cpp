// SPDX-License-Identifier: Apache-2.0
// Optical Bench files of photonstophotos.net (docs/formats/optical-bench.md): sections in brackets, cells between tabs.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "contrejour/lens.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/missing_stop.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/tables/heights.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMaxCells = 64, kMaxRows = 2000;

struct Row {
  int line = 0;
  std::vector<std::string_view> cells;
  [[nodiscard]] std::string_view cell(std::size_t k) const { return k < cells.size() ? cells[k] : std::string_view(); }
};

// Sections by the name within the brackets.
using Sections = std::map<std::string, std::vector<Row>, std::less<>>;

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (cells.size() < kMaxCells) {
    const std::size_t tab = line.find('\t');
    cells.push_back(trimmed(line.substr(0, tab), " "));
    if (tab == std::string_view::npos) break;
    line.remove_prefix(tab + 1);
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  return cells;
}

// A number, or infinity by name with any sign; none for "undefined" and other text.
std::optional<double> number_of(std::string_view cell) {
  if (cell == "Infinity" || cell == "-Infinity") return kInfinity;
  return plain_number(cell);
}

class OpticalBenchReader {
 public:
  OpticalBenchReader(std::string_view text, const std::string& file) : file_(file) {
    lens_.file = {file, 0, 0};
    split(text);
  }

  [[nodiscard]] Result<Prescription> read() {
    read_title();
    choose_positions();
    read_surfaces();
    read_aspheres();
    place_openings(lens_);
    state_figures();
    if (error_) return tl::unexpected(*error_);
    if (const auto placed = place_missing_stop(lens_); !placed) return tl::unexpected(placed.error());
    return completed(std::move(lens_));
  }

 private:
  void fail(int line, std::string message, ErrorCode code = ErrorCode::Parse) {
    if (!error_) error_ = Error{code, std::move(message), {file_, line, 0}};
  }

  void split(std::string_view text) {
    std::vector<Row>* section = nullptr;
    std::size_t rows = 0;
    for (int line = 1; !text.empty() && !error_; ++line) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const auto cells = cells_of(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
      if (cells.empty()) continue;
      const std::string_view first = cells.front();
      if (first.starts_with('#')) continue;
      if (first.size() > 2 && first.front() == '[' && first.back() == ']') {
        section = &sections_[std::string(first.substr(1, first.size() - 2))];
      } else if (section != nullptr) {
        section->push_back({line, cells});
        if (++rows > kMaxRows) fail(line, fmt::format("more than {} lines; no lens has so many", kMaxRows));
      }
    }
  }

  [[nodiscard]] const std::vector<Row>& rows_of(std::string_view section) const {
    static const std::vector<Row> none;
    const auto found = sections_.find(section);
    return found == sections_.end() ? none : found->second;
  }

  // "US 4,123,144 Example 8 (Leica Summicron R 50mm f/2)": the source, and the lens in brackets.
  void read_title() {
    for (const char* section : {"report data", "descriptive data"})
      for (const Row& row : rows_of(section))
        if (row.cell(0) == "lens name") lens_.name = row.cell(1);
    for (const Row& row : rows_of("descriptive data")) {
      if (row.cell(0) != "title") continue;
      const std::string title(row.cell(1));
      const std::size_t open = title.find('('), close = title.rfind(')');
      const bool named = open != std::string::npos && close != std::string::npos && close > open + 1;
      lens_.name = named ? title.substr(open + 1, close - open - 1) : title;
      lens_.source = std::string(trimmed(named ? std::string_view(title).substr(0, open) : title));
    }
    if (lens_.name.empty()) lens_.name = "lens of Optical Bench";
    if (lens_.source.empty()) lens_.source = "an Optical Bench file that does not say it";
  }

  // A variable's value in a column; none where it has none.
  [[nodiscard]] std::optional<double> variable(std::string_view name, std::size_t column) const {
    for (const Row& row : rows_of("variable distances"))
      if (row.cell(0) == name) return number_of(row.cell(column));
    return std::nullopt;
  }

  // Columns are zoom positions for distant and for near objects; those for distant objects are read, since focusing
  // here moves the sensor.
  void choose_positions() {
    const auto& rows = rows_of("variable distances");
    std::size_t columns = 0;
    for (const Row& row : rows) columns = std::max(columns, row.cells.size());
    for (std::size_t k = 1; k < columns; ++k) {
      const auto focal_mm = variable("Focal Length", k);
      const bool near =
          !std::isinf(variable("d0", k).value_or(kInfinity)) || variable("Magnification", k).value_or(0.0) != 0.0;
      if (focal_mm && std::isfinite(*focal_mm) && !near) positions_.push_back(k);
    }
    const auto focal = [&](std::size_t k) { return *variable("Focal Length", k); };
    std::stable_sort(positions_.begin(), positions_.end(), [&](auto a, auto b) { return focal(a) < focal(b); });
    positions_.erase(
        std::unique(positions_.begin(), positions_.end(), [&](auto a, auto b) { return focal(a) == focal(b); }),
        positions_.end());
    if (positions_.empty())
      fail(rows.empty() ? 0 : rows.front().line,
           "no column of [variable distances] has a focal length for distant objects; give Focal Length and d0 = "
           "Infinity");
  }

  // Reads the gap behind the last row; a name refers to a variable.
  void read_gap(const Row& row, Surface& surface, bool last) {
    const std::string_view cell = row.cell(2);
    if (last) {
      ends_at_sensor_ = cell == "Bf";
      return;
    }
    if (const auto gap_mm = number_of(cell)) {
      surface.thickness_mm = *gap_mm;
      return;
    }
    ZoomGap gap{static_cast<int>(lens_.surfaces.size()), {}};
    for (const std::size_t k : positions_) {
      const auto value = variable(cell, k);
      if (!value)
        return fail(row.line,
                    fmt::format("the gap '{}' is neither a number nor in [variable distances]", shortened(cell)));
      gap.by_position_mm.push_back(*value);
    }
    surface.thickness_mm = gap.by_position_mm.front();
    if (positions_.size() > 1) zoom_gaps_.push_back(std::move(gap));
  }

  void read_surfaces() {
    const auto& rows = rows_of("lens data");
    if (rows.empty()) fail(0, "no surfaces under [lens data]");
    Glass medium = air();
    for (std::size_t k = 0; k < rows.size() && !error_; ++k) {
      const Row& row = rows[k];
      const std::string_view radius = row.cell(1);
      Surface surface;
      surface.source_line = row.line;
      surface.glass_after = medium;
      const bool opening = radius == "AS" || radius == "FS";
      if (radius == "AS") surface.kind = SurfaceKind::Stop;
      if (!opening) {
        const auto radius_mm = radius == "CG" ? std::optional(kInfinity) : number_of(radius);
        if (!radius_mm || *radius_mm == 0.0)
          return fail(row.line,
                      fmt::format("'{}' is no radius; a number, Infinity, AS, FS or CG is known", shortened(radius)));
        surface.curvature_per_mm = curvature_of_radius(*radius_mm);
        const auto glass = glass_of(row);
        if (!glass)
          return fail(row.line, fmt::format("'{}' and '{}' are no n_d and V_d; leave both out for air",
                                            shortened(row.cell(3)), shortened(row.cell(5))));
        surface.glass_after = *glass;
      }
      const auto diameter_mm = number_of(row.cell(4));
      if (!diameter_mm) return fail(row.line, "the fifth cell is no number; give the surface's diameter");
      surface.semi_diameter_mm = 0.5 * *diameter_mm;
      read_gap(row, surface, k + 1 == rows.size());
      medium = surface.glass_after;
      by_label_[std::string(row.cell(0))] = lens_.surfaces.size();
      lens_.surfaces.push_back(std::move(surface));
    }
  }

  // None for cells that are neither empty nor numbers.
  [[nodiscard]] static std::optional<Glass> glass_of(const Row& row) {
    const auto n_d = number_of(row.cell(3)), v_d = number_of(row.cell(5));
    if ((!n_d && !row.cell(3).empty()) || (!v_d && !row.cell(5).empty())) return std::nullopt;
    if (!n_d || *n_d == 1.0) return air();
    if (!v_d) return Glass{"", ConstantIndex{*n_d}};
    return Glass{"", AbbeGlass{*n_d, *v_d}};
  }

  // Determines the powers in the columns of aspheres: A4, A6, ...; from A2 with AsphericalA2; with AsphericalOddCount n
  // from A3, with n odd powers, each before its even one, then even ones alone.
  void read_constants() {
    for (const Row& row : rows_of("constants")) {
      if (row.cell(0) == "AsphericalA2") first_power_ = 2;
      if (row.cell(0) != "AsphericalOddCount") continue;
      const auto count = plain_number(row.cell(1));
      if (!count || !(*count >= 0.0 && *count <= 10.0) || *count != std::floor(*count))
        return fail(row.line, fmt::format("'{}' is no count of odd coefficients", shortened(row.cell(1))));
      odd_powers_ = static_cast<std::size_t>(*count);
    }
  }

  [[nodiscard]] std::size_t power_of(std::size_t column) const {
    if (odd_powers_ == 0) return first_power_ + 2 * column;
    return column < 2 * odd_powers_ ? 3 + column : 4 + 2 * (column - odd_powers_);
  }

  // "5  27.197  -1.81201  5.0791E-06 ...": a surface, its radius, its conic constant, A4, A6 and so on.
  void read_aspheres() {
    read_constants();
    for (const Row& row : rows_of("aspherical data")) {
      if (error_) return;
      const auto at = by_label_.find(std::string(row.cell(0)));
      const auto radius_mm = number_of(row.cell(1));
      const auto conic = number_of(row.cell(2));
      if (at == by_label_.end())
        return fail(row.line, fmt::format("no surface is called '{}'", shortened(row.cell(0))));
      Surface& surface = lens_.surfaces[at->second];
      if (!radius_mm || !conic) return fail(row.line, "give the surface's radius and conic constant, then A4, A6, ...");
      if (std::abs(surface.curvature_per_mm * *radius_mm - 1.0) > 1e-3)
        return fail(row.line,
                    fmt::format("surface {} has a radius of {:g} here and {:g} under [lens data]; which is right?",
                                row.cell(0), *radius_mm, 1.0 / surface.curvature_per_mm));
      surface.shape.conic = *conic;
      for (std::size_t k = 3; k < row.cells.size(); ++k) {
        const auto value = number_of(row.cells[k]);
        const std::size_t power = power_of(k - 3);
        if (!value || power > static_cast<std::size_t>(SurfaceShape::kHighestPower))
          return fail(row.line, fmt::format("'{}' is no coefficient; those up to A{} are read", shortened(row.cells[k]),
                                            SurfaceShape::kHighestPower));
        surface.shape.powers.resize(power, 0.0);
        surface.shape.powers.back() = *value;
      }
    }
  }

  void state_figures() {
    if (error_) return;
    const std::size_t first = positions_.front();
    double widest = kInfinity;
    for (const std::size_t k : positions_) widest = std::min(widest, variable("F-Number", k).value_or(kInfinity));
    if (!(widest > 0.0) || std::isinf(widest)) return fail(0, "no F-Number under [variable distances]");
    lens_.f_number = widest;
    if (const auto diagonal_mm = variable("Image Height", first); diagonal_mm && *diagonal_mm > 0.0) {
      lens_.sensor_width_mm = *diagonal_mm * 3.0 / std::sqrt(13.0);
      lens_.sensor_height_mm = *diagonal_mm * 2.0 / std::sqrt(13.0);
    }
    lens_.stated.focal_length_mm = variable("Focal Length", first);
    if (ends_at_sensor_) lens_.stated.back_focal_distance_mm = variable("Bf", first);
    if (positions_.size() == 1) return;
    for (std::size_t p = 0; p < positions_.size(); ++p) {
      ZoomPosition position{*variable("Focal Length", positions_[p]), {}, 0};
      for (const ZoomGap& gap : zoom_gaps_) position.thickness_mm.emplace_back(gap.surface, gap.by_position_mm[p]);
      lens_.zoom.push_back(std::move(position));
    }
  }

  struct ZoomGap {
    int surface = 0;
    std::vector<double> by_position_mm;
  };

  const std::string& file_;
  Sections sections_;
  Prescription lens_;
  std::vector<std::size_t> positions_;  // columns
  std::vector<ZoomGap> zoom_gaps_;
  std::map<std::string, std::size_t> by_label_;
  std::size_t first_power_ = 4, odd_powers_ = 0;  // of aspheres
  bool ends_at_sensor_ = false;
  std::optional<Error> error_;
};

}  // namespace

bool looks_like_optical_bench(std::string_view text) { return text.find("[lens data]") != std::string_view::npos; }

Result<Prescription> read_optical_bench(const LensText& in) { return OpticalBenchReader(in.text, in.file).read(); }

}  // namespace contrejour::inline internal
