// SPDX-License-Identifier: Apache-2.0
// Glasses of refractiveindex.info's database: one YAML file each, blocks of n(lambda) and k(lambda) under DATA.
// docs/formats/glass.md.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/decode_text.h"
#include "base/near_name.h"
#include "base/yaml_tree.h"
#include "contrejour/expert/glass_catalogue.h"
#include "optics/glass/formulas.h"
#include "optics/glass/glass_limits.h"

namespace contrejour {
namespace {

constexpr double kZeroCelsius_k = 273.15;
constexpr double kRoomRounding_k = 0.2;  // the database rounds 293.15 K to 293
constexpr std::size_t kMaxTableNumbers = 200000;

struct Numbers {
  std::vector<double> values;
  int bad_line = 0;  // 0: all are numbers
};

// Reads numbers separated by spaces and line ends; `line` is the first one's line.
Numbers numbers_of(std::string_view text, int line) {
  Numbers numbers;
  constexpr std::string_view kSpace = " \t\n,";
  std::size_t at = 0;
  while (at < text.size()) {
    if (kSpace.find(text[at]) != std::string_view::npos) {
      line += text[at] == '\n' ? 1 : 0;
      ++at;
      continue;
    }
    if (text[at] == '+') ++at;
    double value = 0.0;
    const auto [end, code] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    const std::size_t next = static_cast<std::size_t>(end - text.data());
    const bool whole =
        code == std::errc{} && (next == text.size() || kSpace.find(text[next]) != std::string_view::npos);
    if (!whole || !std::isfinite(value) || numbers.values.size() == kMaxTableNumbers) {
      numbers.bad_line = line;
      return numbers;
    }
    numbers.values.push_back(value);
    at = next;
  }
  return numbers;
}

class RiiReader {
 public:
  RiiReader(const std::string& file, const YamlNode& root) : file_(file), root_(root) {}

  Result<GlassData> read();

 private:
  Result<void> read_block(const YamlNode& block);
  Result<void> read_formula(const YamlNode& block, DispersionFormula formula);
  Result<void> read_table(const YamlNode& block, bool has_n, bool has_k);
  Result<std::vector<double>> numbers(const YamlNode& block, std::string_view key);
  void read_conditions();
  void read_thermal();
  void set_absorption();
  [[nodiscard]] tl::unexpected<Error> fail(int line, std::string message, ErrorCode code = ErrorCode::Parse) const {
    return failure(code, std::move(message), {file_, line, 0});
  }

  const std::string& file_;
  const YamlNode& root_;
  GlassData data_;
  bool has_n_ = false;
  std::vector<std::pair<double, double>> k_;  // nm, k
};

Result<std::vector<double>> RiiReader::numbers(const YamlNode& block, std::string_view key) {
  const YamlNode* node = block.find(key);
  if (node == nullptr || node->kind != YamlNode::Kind::Scalar)
    return fail(block.line, fmt::format("{} is missing; it holds the numbers", key));
  Numbers found = numbers_of(node->scalar, node->line);
  if (found.bad_line != 0) return fail(found.bad_line, fmt::format("{} has something that is not a number", key));
  return std::move(found.values);
}

Result<void> RiiReader::read_formula(const YamlNode& block, DispersionFormula formula) {
  if (has_n_) return fail(block.line, "a second formula or table of n; one is read");
  auto coefficients = numbers(block, "coefficients");
  if (!coefficients) return tl::unexpected(coefficients.error());
  const std::string_view key = block.find("wavelength_range") != nullptr ? "wavelength_range" : "range";
  const auto range = numbers(block, key);
  if (!range) return tl::unexpected(range.error());
  if (range->size() != 2) return fail(block.line, "wavelength_range must be two wavelengths, in um");
  data_.formula = formula;
  data_.coefficients = std::move(*coefficients);
  data_.range_nm = WavelengthRange{(*range)[0] * 1e3, (*range)[1] * 1e3};
  has_n_ = true;
  return {};
}

// Rows of wavelength (um) and n, k or both. The database has falling rows, and a few wavelengths twice: rows are
// sorted, and the first of each wavelength is kept.
Result<void> RiiReader::read_table(const YamlNode& block, bool has_n, bool has_k) {
  if (has_n && has_n_) return fail(block.line, "a second formula or table of n; one is read");
  const auto values = numbers(block, "data");
  if (!values) return tl::unexpected(values.error());
  const std::size_t columns = 1 + (has_n ? 1 : 0) + (has_k ? 1 : 0);
  if (values->empty() || values->size() % columns != 0)
    return fail(block.line, fmt::format("data must have rows of {} numbers", columns));
  struct Row {
    double um, n, k;
  };
  std::vector<Row> rows;
  for (std::size_t at = 0; at < values->size(); at += columns) {
    rows.push_back({(*values)[at], has_n ? (*values)[at + 1] : 0.0, has_k ? (*values)[at + columns - 1] : 0.0});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.um < b.um; });
  rows.erase(std::unique(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.um == b.um; }),
             rows.end());
  for (const Row& row : rows) {
    if (has_n) data_.coefficients.insert(data_.coefficients.end(), {row.um, row.n});
    if (has_k) k_.emplace_back(row.um * 1e3, row.k);
  }
  if (has_n) data_.formula = DispersionFormula::Table;
  has_n_ = has_n_ || has_n;
  return {};
}

Result<void> RiiReader::read_block(const YamlNode& block) {
  const YamlNode* type = block.find("type");
  if (type == nullptr) return fail(block.line, "a block of DATA has no type");
  const std::string& name = type->scalar;
  if (name == "tabulated n") return read_table(block, true, false);
  if (name == "tabulated k") return read_table(block, false, true);
  if (name == "tabulated nk") return read_table(block, true, true);
  if (name == "tabulated n2" || name == "formula A") return {};  // other properties than n and k
  if (name.size() == 9 && name.starts_with("formula ") && name[8] >= '1' && name[8] <= '9') {
    return read_formula(block,
                        static_cast<DispersionFormula>(static_cast<int>(DispersionFormula::Rii1) + name[8] - '1'));
  }
  return fail(type->line,
              fmt::format("'{}' is not a type that is known: formula 1 to 9, tabulated n, k or nk", shortened(name)),
              ErrorCode::Unsupported);
}

// Reads the temperature in K, and whether index and wavelength are against vacuum, which older files state under SPECS.
// The default is air, as in catalogues.
void RiiReader::read_conditions() {
  const auto truth = [](const YamlNode* node) {
    return node != nullptr && (node->scalar == "true" || node->scalar == "yes");
  };
  for (const std::string_view group : {"CONDITIONS", "SPECS", "PROPERTIES"}) {
    const YamlNode* node = root_.find(group);
    if (node == nullptr) continue;
    data_.index_in_vacuum |= truth(node->find("n_is_absolute")) || truth(node->find("n_absolute"));
    data_.wavelength_in_vacuum |= truth(node->find("wavelength_is_vacuum")) || truth(node->find("wavelength_vacuum"));
    const YamlNode* temperature = node->find("temperature");
    if (temperature == nullptr) continue;
    const bool celsius = temperature->scalar.find('C') != std::string::npos;  // "20.0 °C" of older files
    const Numbers value = numbers_of(std::string_view(temperature->scalar).substr(0, temperature->scalar.find(' ')), 0);
    if (value.bad_line != 0 || value.values.size() != 1) continue;
    const double c = celsius ? value.values[0] : value.values[0] - kZeroCelsius_k;
    data_.reference_temperature_c = std::abs(c - std::round(c)) < kRoomRounding_k ? std::round(c) : c;
  }
}

void RiiReader::read_thermal() {
  for (const std::string_view group : {"PROPERTIES", "SPECS"}) {
    const YamlNode* properties = root_.find(group);
    const YamlNode* thermal = properties == nullptr ? nullptr : properties->find("thermal_dispersion");
    if (thermal == nullptr || thermal->list.empty()) continue;
    const YamlNode* type = thermal->list.front().find("type");
    const YamlNode* coefficients = thermal->list.front().find("coefficients");
    if (type == nullptr || coefficients == nullptr || type->scalar != "formula A") continue;
    const Numbers t = numbers_of(coefficients->scalar, 0);
    if (t.bad_line != 0 || t.values.size() != 6) continue;
    data_.thermal = ThermalDispersion{t.values[0], t.values[1], t.values[2], t.values[3], t.values[4], t.values[5]};
  }
}

// k -> absorption coefficient: 4 pi k / lambda.
void RiiReader::set_absorption() {
  std::sort(k_.begin(), k_.end());
  for (const auto& [nm, k] : k_) {
    const bool again = !data_.absorption.empty() && data_.absorption.back().lambda_nm == nm;
    if (!again) data_.absorption.push_back({nm, 4.0 * std::numbers::pi * std::max(k, 0.0) / (nm * 1e-6)});
  }
}

Result<GlassData> RiiReader::read() {
  const YamlNode* blocks = root_.find("DATA");
  if (blocks == nullptr || blocks->kind != YamlNode::Kind::List) {
    return fail(root_.line, "no DATA: this is not a page of optical constants; name another file",
                ErrorCode::Unsupported);
  }
  for (const YamlNode& block : blocks->list)
    if (const auto read = read_block(block); !read) return tl::unexpected(read.error());
  if (!has_n_) {
    return fail(blocks->line, "no formula and no table of n: the file does not tell the refractive index",
                ErrorCode::Unsupported);
  }
  read_conditions();
  read_thermal();
  set_absorption();
  return std::move(data_);
}

GlassStatus status_of(const YamlNode& root) {
  const YamlNode* properties = root.find("PROPERTIES");
  const YamlNode* node = properties == nullptr ? nullptr : properties->find("glass_status");
  if (node == nullptr) return GlassStatus::Standard;
  for (const GlassStatus status : {GlassStatus::Preferred, GlassStatus::Obsolete, GlassStatus::Special})
    if (node->scalar == status_name(status)) return status;
  return GlassStatus::Standard;
}

// Reads the summary that the file states, as far as it does.
GlassSummary summary_of(const YamlNode& root, const std::string& name, const std::string& maker) {
  GlassSummary summary{name, maker, {}, status_of(root)};
  const YamlNode* properties = root.find("PROPERTIES");
  if (properties == nullptr) return summary;
  if (const YamlNode* code = properties->find("glass_code"); code != nullptr && glass_of_code(code->scalar))
    summary.code = code->scalar;
  const auto number = [&](std::string_view key) {
    const YamlNode* node = properties->find(key);
    const Numbers value = node == nullptr ? Numbers{} : numbers_of(node->scalar, 0);
    return value.values.size() == 1 ? value.values[0] : 0.0;
  };
  summary.n_d = number("nd");
  summary.v_d = number("Vd");
  return summary;
}

}  // namespace

Result<GlassFile> read_glass_yaml(std::string_view bytes, const std::string& file, const std::string& maker,
                                  const std::string& name) {
  if (bytes.size() > kYamlMaxBytes) {
    return failure(ErrorCode::Parse, fmt::format("{} bytes; a glass has at most {}", bytes.size(), kYamlMaxBytes),
                   {file, 0, 0});
  }
  const auto root = parse_yaml(decode_text(bytes), file);
  if (!root) return tl::unexpected(root.error());
  auto data = RiiReader(file, *root).read();
  if (!data) return tl::unexpected(data.error());
  auto glass = make_glass(name, std::move(*data));
  if (!glass) return failure(ErrorCode::Parse, glass.error().message, {file, 0, 0});
  GlassFile found;
  found.glasses.push_back({summary_of(*root, name, maker), std::move(*glass), file});
  fill_stated(found.glasses.back());
  return found;
}

}  // namespace contrejour
