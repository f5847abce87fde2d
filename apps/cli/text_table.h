// SPDX-License-Identifier: Apache-2.0
// A table of text with aligned columns: words to the left, numbers to the right.
#pragma once

#include <string>
#include <vector>

namespace contrejour::cli {

class TextTable {
 public:
  // A heading that starts with '<' aligns its column to the left.
  explicit TextTable(std::vector<std::string> headings);

  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<bool> left_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace contrejour::cli
