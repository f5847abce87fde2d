// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/design_text.h"

#include <algorithm>
#include <filesystem>

#include "base/trimmed.h"
#include "optics/lens_files/plain_number.h"

namespace contrejour::inline internal {

std::vector<std::string_view> words_of(std::string_view line, std::size_t max_size) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  while (words.size() < max_size) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

std::string stem_of(const std::string& file) {
  const std::string stem = std::filesystem::path(file).stem().string();
  return stem.empty() ? "lens" : stem;
}

double nominal_focal_mm(std::string_view title) {
  title = trimmed(title, " \"'");
  if (title.starts_with("f=") || title.starts_with("F=")) title.remove_prefix(2);
  if (title.ends_with("mm") || title.ends_with("MM")) title.remove_suffix(2);
  const double value = plain_number(trimmed(title)).value_or(0.0);
  return value > 0.0 ? value : 0.0;
}

std::string cut_text(std::string text, std::size_t max_size) {
  if (text.size() <= max_size) return text;
  std::size_t end = text.rfind(' ', max_size);
  if (end == std::string::npos || end == 0) {
    end = max_size;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  }
  return text.substr(0, end) + " ...";
}

}  // namespace contrejour::inline internal
