// SPDX-License-Identifier: Apache-2.0
#include "optics/glass/glass_line.h"

#include <charconv>
#include <cmath>

namespace contrejour::inline internal {
namespace {

// Removes the part up to the next ';' from the line and returns it without surrounding blanks.
std::string_view next_part(std::string_view& line) {
  const std::size_t end = std::min(line.find(';'), line.size());
  std::string_view part = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  while (part.starts_with(' ')) part.remove_prefix(1);
  while (part.ends_with(' ')) part.remove_suffix(1);
  return part;
}

std::string_view next_word(std::string_view& part) {
  const std::size_t end = std::min(part.find(' '), part.size());
  const std::string_view word = part.substr(0, end);
  part.remove_prefix(std::min(end + 1, part.size()));
  return word;
}

double figure_of(std::string_view word) {
  double value = std::nan("");
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

std::vector<double> numbers_of(std::string_view part) {
  std::vector<double> values;
  while (!part.empty()) values.push_back(figure_of(next_word(part)));
  return values;
}

GlassStatus status_of(std::string_view word) {
  for (const GlassStatus status :
       {GlassStatus::Preferred, GlassStatus::Obsolete, GlassStatus::Special, GlassStatus::Melt})
    if (word == status_name(status)) return status;
  return GlassStatus::Standard;
}

GlassSummary read_summary(std::string_view& line, const std::string& maker) {
  GlassSummary summary;
  summary.name = next_part(line);
  summary.maker = maker;
  summary.status = status_of(next_part(line));
  summary.code = next_part(line);
  std::string_view figures = next_part(line);
  summary.n_d = figure_of(next_word(figures));
  summary.v_d = figure_of(next_word(figures));
  return summary;
}

}  // namespace

GlassSummary summary_of_line(std::string_view line, const std::string& maker) { return read_summary(line, maker); }

CatalogueEntry entry_of_line(std::string_view line, const std::string& maker) {
  CatalogueEntry entry;
  entry.summary = read_summary(line, maker);
  entry.source = "bundled";
  GlassData data;
  std::string_view formula = next_part(line);
  data.formula = formula_of_name(next_word(formula)).value_or(DispersionFormula::Schott);
  data.coefficients = numbers_of(formula);
  const std::vector<double> range = numbers_of(next_part(line));
  if (range.size() == 2) data.range_nm = WavelengthRange{range[0], range[1]};
  const std::vector<double> t = numbers_of(next_part(line));
  if (!t.empty()) data.reference_temperature_c = t[0];
  if (t.size() == 7) data.thermal = ThermalDispersion{t[1], t[2], t[3], t[4], t[5], t[6]};
  const std::vector<double> absorption = numbers_of(next_part(line));
  for (std::size_t k = 0; k + 1 < absorption.size(); k += 2)
    data.absorption.push_back({absorption[k], absorption[k + 1] / 1000.0});
  entry.glass = {entry.summary.name, CatalogueGlass(std::move(data))};
  return entry;
}

}  // namespace contrejour::inline internal
