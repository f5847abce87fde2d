// SPDX-License-Identifier: Apache-2.0
// Our CSV files of tracks and of points: a line of titles, then rows of a name and numbers.
// Thread-safety: pure functions.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::inline internal {

struct CsvRow {
  std::string_view name;
  std::vector<double> numbers;  // of the wanted columns but the first, in their order; `frame` is whole
  int line = 0;
};

struct CsvTable {
  bool has_frames = false;
  std::vector<CsvRow> rows;
};

// columns: the titles besides `name` and `frame`. Titles may be in any order, others are not allowed. The numbers of
// each row are those of the columns, and then the frame, if there is one. Errors: Parse with the line.
[[nodiscard]] Result<CsvTable> read_csv_table(std::string_view text, const std::string& file,
                                              const std::vector<std::string_view>& columns);

}  // namespace contrejour::inline internal
