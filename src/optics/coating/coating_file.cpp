// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/coating_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "base/decode_text.h"
#include "base/near_name.h"
#include "base/text_file.h"
#include "base/trimmed.h"

namespace contrejour {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxMeasuredValues = 1000;  // wavelengths, or angles
constexpr double kShortest_nm = 100.0, kLongest_nm = 20000.0;

std::vector<std::string_view> cells_of(std::string_view line) {
  constexpr std::string_view kBetween = ",; \t";
  std::vector<std::string_view> cells;
  while (cells.size() <= kMaxMeasuredValues + 1) {
    line = trimmed(line, kBetween);
    if (line.empty()) break;
    const std::size_t end = std::min(line.find_first_of(kBetween), line.size());
    cells.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return cells;
}

// Reads a number from low to high that exceeds its predecessor; nothing for any other text.
std::optional<double> next_in(const std::vector<double>& before, std::string_view cell, double low, double high) {
  double value = 0.0;
  const auto [end, status] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = status == std::errc{} && end == cell.data() + cell.size();
  if (!whole || !(value >= low && value <= high) || (!before.empty() && !(value > before.back()))) return std::nullopt;
  return value;
}

// A table while it is read.
class Table {
 public:
  explicit Table(const std::string& file) : file_(file) {}

  Result<void> add(int line, const std::vector<std::string_view>& cells) {
    return measured_.angle_deg.empty() ? add_headings(line, cells) : add_row(line, cells);
  }
  [[nodiscard]] Result<MeasuredCoating> take() {
    if (measured_.lambda_nm.empty()) return wrong(0, "no wavelength; give a line of angles and lines of reflectances");
    return std::move(measured_);
  }

  [[nodiscard]] tl::unexpected<Error> wrong(int line, std::string why) const {
    return failure(ErrorCode::Parse, std::move(why), {file_, line, 0});
  }

 private:
  Result<void> add_headings(int line, const std::vector<std::string_view>& cells) {
    const bool is_word = cells.front().find_first_of("0123456789.+-") != 0;
    if (!is_word || cells.size() < 2 || cells.size() > kMaxMeasuredValues + 1)
      return wrong(line, fmt::format("the first line must be a word and 1 to {} angles in degrees, as in nm,0,30,60",
                                     kMaxMeasuredValues));
    for (std::size_t k = 1; k < cells.size(); ++k) {
      const auto angle_deg = next_in(measured_.angle_deg, cells[k], 0.0, 90.0);
      if (!angle_deg)
        return wrong(line, fmt::format("'{}' is no angle; let them rise from 0 to 90 degrees", shortened(cells[k])));
      measured_.angle_deg.push_back(*angle_deg);
    }
    return {};
  }

  Result<void> add_row(int line, const std::vector<std::string_view>& cells) {
    const std::size_t angles = measured_.angle_deg.size();
    if (cells.size() != angles + 1)
      return wrong(line, fmt::format("{} numbers; give a wavelength and a reflectance for each of {} angles",
                                     cells.size(), angles));
    const auto lambda_nm = next_in(measured_.lambda_nm, cells.front(), kShortest_nm, kLongest_nm);
    if (!lambda_nm || measured_.lambda_nm.size() == kMaxMeasuredValues)
      return wrong(line, fmt::format("'{}' is no wavelength; let up to {} of them rise from {} to {} nm",
                                     shortened(cells.front()), kMaxMeasuredValues, kShortest_nm, kLongest_nm));
    measured_.lambda_nm.push_back(*lambda_nm);
    for (std::size_t k = 1; k < cells.size(); ++k) {
      const auto reflectance = next_in({}, cells[k], 0.0, 1.0);
      if (!reflectance)
        return wrong(line, fmt::format("'{}' is no reflectance; give fractions from 0 to 1 (1 per cent is 0.01)",
                                       shortened(cells[k])));
      measured_.reflectance.push_back(*reflectance);
    }
    return {};
  }

  const std::string& file_;
  MeasuredCoating measured_;
};

}  // namespace

Result<MeasuredCoating> read_measured_coating(std::string_view text, const std::string& file) {
  Table table(file);
  if (text.size() > kMaxBytes) return table.wrong(0, fmt::format("larger than {} bytes; no coating is", kMaxBytes));
  const std::string decoded = decode_text(text);
  std::string_view rest = decoded;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const auto cells = cells_of(trimmed(rest.substr(0, std::min(end, rest.find('#')))));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (cells.empty()) continue;
    if (const auto added = table.add(number, cells); !added) return tl::unexpected(added.error());
  }
  return table.take();
}

Result<MeasuredCoating> read_measured_coating(const std::filesystem::path& file) {
  const auto text = read_text_file(file, kMaxBytes, "name a coating, or a table of reflectances");
  if (!text) return tl::unexpected(text.error());
  return read_measured_coating(*text, file.string());
}

}  // namespace contrejour
