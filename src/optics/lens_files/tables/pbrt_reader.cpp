// SPDX-License-Identifier: Apache-2.0
// Lenses of PBRT's realistic camera (docs/formats/pbrt.md): a line a surface, front first: radius, gap, index,
// diameter; a radius of 0 is the stop.
#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "contrejour/lens.h"
#include "optics/lens_files/complete.h"
#include "optics/lens_files/missing_stop.h"
#include "optics/lens_files/plain_number.h"
#include "optics/lens_files/read_lens.h"

namespace contrejour::inline internal {
namespace {

constexpr std::string_view kPbrtSpace = " \t\r\"";

// Exactly four numbers between spaces.
std::optional<std::array<double, 4>> four_numbers(std::string_view line) {
  std::array<double, 4> numbers{};
  for (double& number : numbers) {
    line = trimmed(line, kPbrtSpace);
    const std::size_t end = std::min(line.find_first_of(kPbrtSpace), line.size());
    const auto cell = plain_number(line.substr(0, end));
    if (!cell) return std::nullopt;
    number = *cell;
    line.remove_prefix(end);
  }
  return trimmed(line, kPbrtSpace).empty() ? std::optional(numbers) : std::nullopt;
}

// body(number, line without its comment, comment) for each line, until it returns false.
template <class Body>
void for_each_line(std::string_view text, const Body& body) {
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t hash = line.find('#');
    const std::string_view comment = hash == std::string_view::npos ? std::string_view() : line.substr(hash + 1);
    if (!body(number, trimmed(line.substr(0, hash), kPbrtSpace), trimmed(comment, kPbrtSpace))) return;
  }
}

Surface surface_of(const std::array<double, 4>& row, const Glass& medium, int line) {
  const auto [radius_mm, gap_mm, n, diameter_mm] = row;
  Surface surface;
  surface.source_line = line;
  surface.thickness_mm = gap_mm;
  surface.semi_diameter_mm = 0.5 * diameter_mm;
  surface.glass_after = medium;
  if (radius_mm == 0.0) {
    surface.kind = SurfaceKind::Stop;
  } else {
    surface.curvature_per_mm = curvature_of_radius(radius_mm);
    surface.glass_after = n == 1.0 ? air() : Glass{"", ConstantIndex{n}};
  }
  return surface;
}

}  // namespace

// The first line that is no comment is four numbers.
bool looks_like_pbrt(std::string_view text) {
  bool is = false;
  for_each_line(text, [&](int, std::string_view line, std::string_view) {
    if (line.empty()) return true;
    is = four_numbers(line).has_value();
    return false;
  });
  return is;
}

Result<Prescription> read_pbrt(const LensText& in) {
  Prescription lens;
  lens.file = {in.file, 0, 0};
  std::optional<Error> error;
  Glass medium = air();
  for_each_line(in.text, [&](int number, std::string_view line, std::string_view comment) {
    if (line.empty()) {  // headings: the lens, then its source
      std::string& to = lens.name.empty() ? lens.name : lens.source;
      const bool heading = lens.surfaces.empty() && !comment.empty() && !comment.starts_with("radius");
      if (heading) to += (to.empty() ? "" : "; ") + std::string(comment);
      return true;
    }
    const auto row = four_numbers(line);
    if (!row) {
      error = Error{ErrorCode::Parse,
                    fmt::format("'{}' is not a surface; give radius, gap, index and diameter", shortened(line)),
                    {in.file, number, 0}};
      return false;
    }
    lens.surfaces.push_back(surface_of(*row, medium, number));
    medium = lens.surfaces.back().glass_after;
    return true;
  });
  if (error) return tl::unexpected(*error);
  if (lens.name.empty()) lens.name = "lens of PBRT";
  if (lens.source.empty()) lens.source = "a PBRT file that does not say it";
  if (const auto placed = place_missing_stop(lens); !placed) return tl::unexpected(placed.error());
  return completed(std::move(lens));  // the file does not state the f-number
}

}  // namespace contrejour::inline internal
