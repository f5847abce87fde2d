// SPDX-License-Identifier: Apache-2.0
#include "sequence/track_files/csv_table.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/near_name.h"
#include "sequence/track_files/track_lines.h"

namespace contrejour::inline internal {
namespace {

// The index in a row of each wanted column.
using Places = std::vector<std::size_t>;

Result<Places> places_of(const TrackLine& line, const std::string& file, const std::vector<std::string_view>& wanted,
                         bool& has_frames) {
  const auto titles = all_fields(line.text, ',');
  Places places;
  for (const std::string_view title : wanted) {
    const auto at = std::ranges::find(titles, title);
    if (at == titles.end() && title == "frame") continue;
    if (at == titles.end())
      return wrong_line(file, line.number,
                        fmt::format("the first line has no column {}; give {}", title, fmt::join(wanted, ",")));
    places.push_back(static_cast<std::size_t>(at - titles.begin()));
  }
  has_frames = std::ranges::find(titles, "frame") != titles.end();
  if (titles.size() != places.size())
    return wrong_line(file, line.number, fmt::format("the columns are {}", fmt::join(wanted, ",")));
  return places;
}

Result<CsvRow> csv_row_of(const TrackLine& line, const std::string& file, const Places& places, bool has_frames) {
  const auto fields = all_fields(line.text, ',');
  if (fields.size() != places.size())
    return wrong_line(file, line.number, fmt::format("the line has {} values, not {}", fields.size(), places.size()));
  CsvRow row{fields[places[0]], {}, line.number};
  for (std::size_t k = 1; k < places.size(); ++k) {
    const bool is_frame = has_frames && k + 1 == places.size();
    const auto number = track_number(fields[places[k]]);
    if (!number || (is_frame && !track_frame(fields[places[k]])))
      return wrong_line(file, line.number,
                        fmt::format("\"{}\" is not {}", shortened(fields[places[k]]),
                                    is_frame ? "the number of a frame" : "a number"));
    row.numbers.push_back(*number);
  }
  return row;
}

}  // namespace

Result<CsvTable> read_csv_table(std::string_view text, const std::string& file,
                                const std::vector<std::string_view>& columns) {
  const auto lines = track_lines(text, "#");
  if (lines.empty()) return failure(ErrorCode::Parse, "the file is empty", {file, 0, 0});
  std::vector<std::string_view> wanted{"name"};
  wanted.insert(wanted.end(), columns.begin(), columns.end());
  wanted.push_back("frame");
  CsvTable table;
  const auto places = places_of(lines.front(), file, wanted, table.has_frames);
  if (!places) return tl::unexpected(places.error());
  for (std::size_t k = 1; k < lines.size(); ++k) {
    auto row = csv_row_of(lines[k], file, *places, table.has_frames);
    if (!row) return tl::unexpected(row.error());
    table.rows.push_back(std::move(*row));
  }
  return table;
}

}  // namespace contrejour::inline internal
